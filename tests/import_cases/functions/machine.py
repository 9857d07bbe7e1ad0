"""Containers that functions build; the name of a state has a space."""
import smach


class Step(smach.State):
    def __init__(self, can_fail=False):
        smach.State.__init__(self, outcomes=['ok', 'failed'] if can_fail else ['ok'])

    def execute(self, userdata):
        return 'ok'


def fetch():
    inner = smach.StateMachine(outcomes=['fetched', 'dropped'])
    lift = Step(can_fail=True)
    with inner:
        smach.StateMachine.add('GRIP', Step(), transitions={'ok': 'LIFT'})
        smach.StateMachine.add('LIFT', lift, transitions={'ok': 'fetched', 'failed': 'dropped'})
    return inner


def build():
    top = smach.StateMachine(outcomes=['end'])
    with top:
        smach.StateMachine.add('FETCH', fetch(), transitions={'fetched': 'end', 'dropped': 'TURN AROUND'})
        smach.StateMachine.add('TURN AROUND', Step(), transitions={'ok': 'end'})
    return top


if __name__ == '__main__':
    build().execute()
