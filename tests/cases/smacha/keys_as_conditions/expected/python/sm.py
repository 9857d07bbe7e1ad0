# Made by smachac 0.1.0 from main.yml (sha256 382dcb24619d4446).
"""The state machine `sm`."""

from smachac.runtime import signals

try:
    import smach
except ImportError:  # without SMACH: smachac.runtime has the same names
    from smachac.runtime import smach


class ConditionalOutcomeState(smach.State):
    """Ends with the first outcome whose condition is true, otherwise the default."""

    def __init__(self, outcomes, callbacks, default_outcome, input_keys=(), output_keys=()):
        super().__init__(
            outcomes=outcomes,
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.writes_outcome = "outcome" in output_keys
        self.conditions = [(name, callbacks[name]) for name in outcomes if name in callbacks]
        self.default_outcome = default_outcome

    def execute(self, userdata):
        names = (name for name, condition in self.conditions if condition(userdata))
        outcome = next(names, self.default_outcome)
        if self.writes_outcome:
            userdata["outcome"] = outcome
        return outcome


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


def build():
    """Build the state machine `sm`."""
    sm = smach.StateMachine(outcomes=["stopped", "going"])  # main.yml:2
    sm.userdata.stop = False
    sm.userdata.level = 3
    with sm:
        smach.StateMachine.add(  # main.yml:7
            "JUDGE",
            ConditionalOutcomeState(
                outcomes=["low", "stop", "default"],
                callbacks={"low": lambda ud: ud.level < 1, "stop": lambda ud: ud.stop},
                default_outcome="default",
                input_keys=["stop", "level"],
            ),
            transitions={"low": "going", "stop": "stopped", "default": "TELL"},
        )

        smach.StateMachine.add(  # main.yml:13
            "TELL",
            CallbacksState(callbacks={"stop": lambda ud: True}, output_keys=["stop"]),
            transitions={"succeeded": "AGAIN"},
        )

        smach.StateMachine.add(  # main.yml:18
            "AGAIN",
            ConditionalOutcomeState(
                outcomes=["stop", "default"],
                callbacks={"stop": lambda ud: ud.stop},
                default_outcome="default",
                input_keys=["stop"],
            ),
            transitions={"stop": "stopped", "default": "going"},
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
