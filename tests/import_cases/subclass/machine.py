"""A container class with parameters, used twice by another one whose `robot` is not known."""
import smach


class Drive(smach.State):
    def __init__(self, robot, place):
        smach.State.__init__(self, outcomes=['arrived', 'blocked'])
        self.robot = robot
        self.place = place

    def execute(self, userdata):
        return 'arrived' if self.robot.base.go(self.place) else 'blocked'


class Wait(smach.State):
    def __init__(self, seconds=5):
        smach.State.__init__(self, outcomes=['over'])
        self.seconds = seconds

    def execute(self, userdata):
        return 'over'


class Visit(smach.StateMachine):
    def __init__(self, robot, place, rest=False):
        smach.StateMachine.__init__(self, outcomes=['visited', 'skipped'])
        with self:
            self.add('DRIVE', Drive(robot, place),
                     transitions={'arrived': 'REST' if rest else 'visited', 'blocked': 'skipped'})
            self.add('REST', Wait(2), transitions={'over': 'visited'})


class Tour(smach.StateMachine):
    def __init__(self, robot):
        super(Tour, self).__init__(outcomes=['home'])
        with self:
            smach.StateMachine.add('KITCHEN', Visit(robot, 'kitchen', rest=True),
                                   {'visited': 'HALL', 'skipped': 'HALL'})
            smach.StateMachine.add('HALL', Visit(robot, 'hall'), {'visited': 'home', 'skipped': 'home'})
