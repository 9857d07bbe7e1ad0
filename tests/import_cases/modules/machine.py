"""States of another module, and one of a package that is not installed."""
import smach
import gripper_states as gs
from gripper_states import *
from voice_of_vendor import Speak


def main():
    sm = smach.StateMachine(outcomes=['held', 'lost'])
    with sm:
        smach.StateMachine.add('SPEAK', Speak('which part?'), transitions={'said': 'GRIP'})
        smach.StateMachine.add('GRIP', gs.Grip(), transitions={GRIPPED: 'held', SLIPPED: 'GRIP_HARD'})
        smach.StateMachine.add('GRIP_HARD', GripHard(),
                               transitions={GRIPPED: 'held', SLIPPED: 'lost', 'crushed': 'lost'})
    sm.execute()


if __name__ == '__main__':
    main()
