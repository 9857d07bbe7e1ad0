# Made by smachac 0.1.0 from main.yml (sha256 b628bda36d0008e8).
"""The state machine `three_tries`."""

from smachac.runtime import signals

try:
    import smach
except ImportError:  # without SMACH: smachac.runtime has the same names
    from smachac.runtime import smach


class ScriptedState(smach.State):
    """Ends with scripted outcomes: visit n performs step n; the last step repeats.

    After a preempt request, the outcome is `preempted` if the state has that outcome.
    """

    def __init__(self, outcomes, steps=(), input_keys=(), output_keys=()):
        super().__init__(
            outcomes=outcomes,
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.steps = list(steps) or [{"outcome": outcomes[0]}]
        self.visits = 0

    def execute(self, userdata):
        step = self.steps[min(self.visits, len(self.steps) - 1)]
        self.visits += 1
        if self.preempt_requested() and "preempted" in self.get_registered_outcomes():
            self.service_preempt()
            return "preempted"
        for key, value in step.get("set", {}).items():
            userdata[key] = value
        return step["outcome"]


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


def build():
    """Build the state machine `three_tries`."""
    three_tries = smach.StateMachine(outcomes=["succeeded", "aborted"])  # main.yml:2
    three_tries.userdata.tries = 0
    with three_tries:
        smach.StateMachine.add(  # main.yml:8
            "TRY",
            ScriptedState(
                outcomes=["succeeded", "aborted"],
                steps=[{"outcome": "aborted"}, {"outcome": "aborted"}, {"outcome": "succeeded"}],
            ),
            transitions={"succeeded": "succeeded", "aborted": "COUNT"},
        )

        smach.StateMachine.add(  # main.yml:14
            "COUNT",
            CallbacksState(
                callbacks={"tries": lambda ud: ud.tries + 1},
                input_keys=["tries"],
                output_keys=["tries"],
            ),
            transitions={"succeeded": "DECIDE"},
        )

        smach.StateMachine.add(  # main.yml:21
            "DECIDE",
            ConditionalOutcomeState(
                outcomes=["again", "enough"],
                callbacks={"again": lambda ud: ud.tries < 3},
                default_outcome="enough",
                input_keys=["tries"],
            ),
            transitions={"again": "TRY", "enough": "aborted"},
        )
    return three_tries


def main():
    """Run the state machine once and return its outcome."""
    three_tries = build()
    if __name__ == "__main__":
        signals.stop_at_signals(three_tries)
    return three_tries.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(signals.exit_code(outcome is None))
