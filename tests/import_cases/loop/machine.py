"""States that a loop adds, and a machine with a part that is not known."""
import rospy
import smach

SHELVES = [('A', 1.0), ('B', 2.5), ('C', 4.0)]


class Go(smach.State):
    def __init__(self, x):
        smach.State.__init__(self, outcomes=['there', 'failed'])
        self.x = x

    def execute(self, userdata):
        return 'there' if self.x < 9 else 'failed'


class Look(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=['seen'])

    def execute(self, userdata):
        return 'seen'


def ring():
    sm = smach.StateMachine(outcomes=['failed'])
    with sm:
        for i, (name, x) in enumerate(SHELVES):
            after = SHELVES[(i + 1) % len(SHELVES)][0]
            smach.StateMachine.add('GO_%s' % name, Go(x), {'there': 'LOOK_{}'.format(name), 'failed': 'failed'})
            smach.StateMachine.add('LOOK_' + name, Look(), {'seen': f'GO_{after}'})
    return sm


def from_parameters():
    sm = smach.StateMachine(outcomes=['end', 'failed'])
    with sm:
        for name in rospy.get_param('~rooms'):
            smach.StateMachine.add('GO_' + name, Go(1.0), {'there': 'END', 'failed': 'failed'})
        smach.StateMachine.add('END', Look(), {'seen': 'end'})
    return sm
