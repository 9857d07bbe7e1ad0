# Made by smachac 0.1.0 from main.yml (sha256 c4726401d5de566f).
"""The state machine `sm`."""

from smachac.runtime import signals
from smachac.runtime.additions import SleepState

try:
    import smach
except ImportError:  # without SMACH: smachac.runtime has the same names
    from smachac.runtime import smach


def build():
    """Build the state machine `sm`."""
    sm = smach.StateMachine(outcomes=["succeeded"])  # main.yml:2
    with sm:
        smach.StateMachine.add(  # main.yml:6
            "SHORT",
            SleepState(time=0.5),
            transitions={"succeeded": "LONG", "preempted": "succeeded"},
        )

        smach.StateMachine.add(  # main.yml:7
            "LONG",
            SleepState(time=5),
            transitions={"succeeded": "succeeded", "preempted": "succeeded"},
        )
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
