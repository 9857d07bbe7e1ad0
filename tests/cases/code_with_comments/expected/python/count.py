# Made by smachac 0.1.0 from main.yml (sha256 365a40ec96868634).
"""A comment in code must not swallow what is printed behind it."""

from smachac.runtime import signals

try:
    import smach
except ImportError:  # without SMACH: smachac.runtime has the same names
    from smachac.runtime import smach


class CallbacksState(smach.State):
    """Calls functions of the userdata and writes each result to an output key."""

    def __init__(self, callbacks=(), input_keys=(), output_keys=()):
        super().__init__(
            outcomes=["succeeded"],
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.callbacks = callbacks

    def execute(self, userdata):
        for key in sorted(self.callbacks):
            function = self.callbacks[key]
            if not smach.has_smach_interface(function):
                userdata[key] = function(userdata)
            else:  # the function writes its output keys
                inputs = function.get_registered_input_keys()
                outputs = function.get_registered_output_keys()
                function(smach.Remapper(userdata, inputs, outputs, {}))
        return "succeeded"


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
    """Build the state machine `count`."""
    count = smach.StateMachine(outcomes=["succeeded"])  # main.yml:1
    count.userdata.n = 0
    with count:
        smach.StateMachine.add(  # main.yml:7
            "COUNT",
            CallbacksState(
                callbacks={"n": lambda ud: ud.n + len('#') + (lambda a, b: a + b)(1, 2)},
                input_keys=["n"],
                output_keys=["n"],
            ),
            transitions={"succeeded": "SHOW"},
        )

        smach.StateMachine.add(  # main.yml:14
            "SHOW", PrintUserdataState(input_keys=["n"]), transitions={"succeeded": "succeeded"}
        )
    return count


def main():
    """Run the state machine once and return its outcome."""
    count = build()
    if __name__ == "__main__":
        signals.stop_at_signals(count)
    return count.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(signals.exit_code(outcome is None))
