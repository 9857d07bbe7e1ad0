# Made by smachac 0.1.0 from main.yml (sha256 0eed65aba39ca33b).
"""The state machine `fetch`."""

from smachac.runtime import signals
from smachac.runtime.additions import (
    SleepState,
    error_as_outcome,
    pass_on_stop_requests,
    with_retries,
)

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
    """Build the state machine `fetch`."""
    fetch = smach.StateMachine(outcomes=["succeeded", "aborted"])  # main.yml:2
    fetch.userdata.n = 0
    fetch.userdata.parts = [1, 2]
    with fetch:
        smach.StateMachine.add(  # main.yml:7
            "FIND",
            error_as_outcome(ScriptedState(outcomes=["found", "nothing"]), "error"),
            transitions={"found": "PICK", "nothing": "aborted", "error": "aborted"},
        )

        sm_pick = smach.StateMachine(  # main.yml:11
            outcomes=["succeeded", "error"], input_keys=["n"], output_keys=["width"]
        )
        with sm_pick:
            smach.StateMachine.add(  # main.yml:18
                "DIVIDE",
                CallbacksState(
                    callbacks={"width": lambda ud: 1 / ud.n},
                    input_keys=["n"],
                    output_keys=["width"],
                ),
                transitions={"succeeded": "succeeded"},
            )

        smach.StateMachine.add(
            "PICK",
            error_as_outcome(sm_pick, "error"),
            transitions={"succeeded": "OWN", "error": "LET_GO"},
        )

        smach.StateMachine.add(  # main.yml:24
            "OWN",
            error_as_outcome(ScriptedState(outcomes=["succeeded", "error"]), "caught_error"),
            transitions={"succeeded": "CARRY", "error": "aborted", "caught_error": "LET_GO"},
        )

        smach.StateMachine.add(  # main.yml:28
            "CARRY",
            error_as_outcome(
                with_retries(
                    error_as_outcome(
                        CallbacksState(
                            callbacks={"width": lambda ud: 1 / ud.n},
                            input_keys=["n"],
                            output_keys=["width"],
                        ),
                        "error",
                    ),
                    3,
                    on=["error"],
                    label="CARRY",
                ),
                "error",
            ),
            transitions={
                "succeeded": "BOTH",
                "exhausted": "BOTH",
                "preempted": "aborted",
                "error": "LET_GO",
            },
        )

        sm_both = smach.Concurrence(  # main.yml:35
            outcomes=["succeeded", "failed", "error"],
            default_outcome="succeeded",
            input_keys=["n"],
            outcome_map={"failed": {"LEFT": "error"}},
        )
        with sm_both:
            smach.Concurrence.add(  # main.yml:43
                "LEFT",
                error_as_outcome(
                    ConditionalOutcomeState(
                        outcomes=["big", "small"],
                        default_outcome="small",
                        callbacks={"big": lambda ud: 1 / ud.n > 2},
                        input_keys=["n"],
                    ),
                    "error",
                ),
            )

            smach.Concurrence.add("RIGHT", SleepState(time=0.01))  # main.yml:49

        smach.StateMachine.add(
            "BOTH",
            error_as_outcome(sm_both, "error"),
            transitions={"succeeded": "EACH", "failed": "aborted", "error": "LET_GO"},
        )

        sm_each = smach.Iterator(  # main.yml:50
            outcomes=["succeeded", "error"],
            it=lambda: sm_each.userdata["parts"],
            it_label="part",
            exhausted_outcome="succeeded",
            input_keys=["parts"],
            output_keys=[],
        )
        with sm_each:
            smach.Iterator.set_contained_state(  # main.yml:60
                "HALVE",
                error_as_outcome(
                    CallbacksState(
                        callbacks={"half": lambda ud: ud.part / (ud.part - 1)},
                        input_keys=["part"],
                        output_keys=["half"],
                    ),
                    "error",
                ),
                loop_outcomes=["succeeded", "error"],
            )

        smach.StateMachine.add(
            "EACH",
            error_as_outcome(sm_each, "error"),
            transitions={"succeeded": "succeeded", "error": "LET_GO"},
        )

        smach.StateMachine.add(  # main.yml:65
            "LET_GO",
            CallbacksState(callbacks={"n": lambda ud: 1}, output_keys=["n"]),
            transitions={"succeeded": "OWN"},
        )
    pass_on_stop_requests(fetch)
    return fetch


def main():
    """Run the state machine once and return its outcome."""
    fetch = build()
    if __name__ == "__main__":
        signals.stop_at_signals(fetch)
    return fetch.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(signals.exit_code(outcome is None))
