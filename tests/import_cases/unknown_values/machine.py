"""Values that are not known: passed through functions, constructors and attributes; made in a loop."""
import rospy
import smach
from robot_of_vendor import Goal, Robot


class Say(smach.State):
    def __init__(self, robot, text, goal=None):
        smach.State.__init__(self, outcomes=['said'])

    def execute(self, userdata):
        return 'said'


class Visit(smach.StateMachine):
    def __init__(self, robot, place):
        smach.StateMachine.__init__(self, outcomes=['left'])
        self.robot = robot
        self.goal = Goal()
        self.fill(place)

    def fill(self, place):
        with self:
            self.add('GREET', Say(self.robot, place), {'said': 'GO'})
            self.add('GO', Say(self.robot, 'bye', self.goal), {'said': 'left'})


def spoken(speaker, text):
    return Say(speaker, text)


def main():
    robot = Robot()
    sm = smach.StateMachine(outcomes=['over'])
    with sm:
        for number in range(2):
            goal = Goal(number)
            sm.add('TURN_%d' % number, Say(robot, 'turn', goal),
                   {'said': 'TURN_1' if number == 0 else 'KITCHEN'})
        sm.add('KITCHEN', Visit(robot, 'kitchen'), {'left': 'HALL'})
        sm.add('HALL', Visit(robot, 'hall'), {'left': 'THANKS'})
        sm.add('THANKS', spoken(robot, 'thank you'), {'said': 'ANSWER'})
        sm.add('ANSWER', spoken(Robot(2), rospy.get_param('answer')), {'said': 'over'})
    sm.execute()


if __name__ == '__main__':
    main()
