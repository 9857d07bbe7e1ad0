# Made by smachac 0.1.0 from main.yml (sha256 b8f8a767cb97a2e5).
"""The state machine `bad_presets`."""

from smachac.runtime import signals

try:
    import smach
except ImportError:  # without SMACH: smachac.runtime has the same names
    from smachac.runtime import smach


class PrintUserdataState(smach.State):
    """Prints the input keys and their values, one key per line."""

    def __init__(self, input_keys=()):
        super().__init__(outcomes=["succeeded"], input_keys=list(input_keys))
        self.printed_keys = sorted(input_keys)

    def execute(self, userdata):
        for key in self.printed_keys:
            print(f"{key}: {userdata[key]}")
        return "succeeded"


def build():
    """Build the state machine `bad_presets`."""
    bad_presets = smach.StateMachine(outcomes=["done"])  # main.yml:2
    bad_presets.userdata.height = 0.4
    bad_presets.userdata.limit = 3
    bad_presets.userdata.speed = 1.0
    with bad_presets:
        smach.StateMachine.add(  # main.yml:8
            "NEAR",
            PrintUserdataState(input_keys=["speed", "height", "limit"]),
            transitions={"succeeded": "FAR"},
        )

        smach.StateMachine.add(  # main.yml:14
            "FAR",
            PrintUserdataState(input_keys=["speed", "height", "limit"]),
            transitions={"succeeded": "LAST"},
        )

        smach.StateMachine.add(  # main.yml:20
            "LAST", PrintUserdataState(input_keys=["height"]), transitions={"succeeded": "done"}
        )
    return bad_presets


def main():
    """Run the state machine once and return its outcome."""
    bad_presets = build()
    if __name__ == "__main__":
        signals.stop_at_signals(bad_presets)
    return bad_presets.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(signals.exit_code(outcome is None))
