# Made by smachac 0.1.0 from main.yml (sha256 0dd05b96da246a18).
"""The state machine `sm`."""

import sys

from smachac.runtime import signals

try:
    import smach
except ImportError:  # without SMACH: smachac.runtime has the same names
    from smachac.runtime import smach


class Greet(smach.State):
    def __init__(self, greeting):
        smach.State.__init__(self, outcomes=['succeeded', 'aborted'], input_keys=['who'])
        self.greeting = greeting

    def execute(self, userdata):
        sys.stdout.write(self.greeting + ' ' + userdata.who + '\n')
        return 'succeeded'


def build():
    """Build the state machine `sm`."""
    sm = smach.StateMachine(outcomes=["succeeded", "aborted"])  # main.yml:2
    sm.userdata.who = "world"
    with sm:
        # main.yml:6
        smach.StateMachine.add('GREET', Greet('HELLO'),
                               transitions={'succeeded': 'AGAIN'})

        # main.yml:11
        smach.StateMachine.add('AGAIN', Greet('AGAIN_YOU'),
                               transitions={'succeeded': 'succeeded', 'aborted': 'aborted'})
    return sm


def main():
    """Run the state machine once and return its outcome."""
    sm = build()
    if __name__ == "__main__":
        signals.stop_at_signals(sm)
    return sm.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(signals.exit_code(outcome is None))
