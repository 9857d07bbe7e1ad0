"""Two states; every name is a literal; the machine is built in `main`."""
import rospy
import smach


class Dock(smach.State):
    """Drives to the dock.

    It tries three times.
    """

    def __init__(self):
        smach.State.__init__(self, outcomes=['docked', 'missed'])
        self.tries = 0

    def execute(self, userdata):
        self.tries += 1
        if self.tries < 3:
            return 'missed'
        return 'docked'


class Charge(smach.State):
    def __init__(self):
        super().__init__(outcomes=['full'])

    def execute(self, userdata):
        rospy.sleep(1.0)
        return 'full'


def main():
    rospy.init_node('dock_and_charge')
    sm = smach.StateMachine(outcomes=['charged', 'lost'])
    with sm:
        smach.StateMachine.add('DOCK', Dock(), transitions={'docked': 'CHARGE', 'missed': 'lost'})
        smach.StateMachine.add('CHARGE', Charge(), transitions={'full': 'charged'})
    sm.execute()


if __name__ == '__main__':
    main()
