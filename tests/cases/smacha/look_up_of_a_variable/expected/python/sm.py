# Made by smachac 0.1.0 from main.yml (sha256 6c66e6c51f42abbd).
"""The state machine `sm`."""

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
    # main.yml:2
    sm = smach.StateMachine(outcomes=["succeeded"])
    sm.userdata.speed = 3
    with sm:
        # main.yml:7
        smach.StateMachine.add(
            "FOO",
            Drive(speed="fast", input_keys=["speed"]),
            transitions={"done": "succeeded"},
        )
    return sm


def main():
    """Run the state machine once and return its outcome."""
    return build().execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(outcome is None)
