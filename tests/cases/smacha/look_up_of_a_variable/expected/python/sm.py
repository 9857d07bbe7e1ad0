# Made by smachac 0.1.0 from main.yml (sha256 6c66e6c51f42abbd).
"""The state machine `sm`."""

from smachac.runtime import signals

try:
    import smach
except ImportError:  # without SMACH: smachac.runtime has the same names
    from smachac.runtime import smach


class Drive(smach.State):
    """Drives on."""

    def __init__(self, speed, input_keys=()):
        super().__init__(outcomes=["done"], input_keys=list(input_keys))
        self.speed = speed

    def execute(self, userdata):
        return "done"


def build():
    """Build the state machine `sm`."""
    sm = smach.StateMachine(outcomes=["succeeded"])  # main.yml:2
    sm.userdata.speed = 3
    with sm:
        smach.StateMachine.add(  # main.yml:7
            "FOO", Drive(speed="fast", input_keys=["speed"]), transitions={"done": "succeeded"}
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
