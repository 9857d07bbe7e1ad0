# Made by smachac 0.1.0 from main.yml (sha256 81866c077464b068).
"""Pick a part, carry it away, and never keep it."""

from smachac.runtime import signals
from smachac.runtime.additions import (
    error_as_outcome,
    pass_on_stop_requests,
    with_retries,
    with_timeout,
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


def build():
    """Build the state machine `properties`."""
    properties = smach.StateMachine(outcomes=["succeeded", "aborted"])  # main.yml:2
    with properties:
        sm_pick = smach.StateMachine(outcomes=["succeeded", "aborted", "error"])  # main.yml:16
        with sm_pick:
            smach.StateMachine.add(  # main.yml:20
                "CLOSE",
                with_retries(
                    ScriptedState(outcomes=["succeeded", "aborted", "preempted"]),
                    3,
                    on=["aborted"],
                    label="CLOSE",
                ),
                transitions={
                    "exhausted": "aborted",
                    "preempted": "aborted",
                    "succeeded": "succeeded",
                },
            )

        smach.StateMachine.add(
            "PICK",
            error_as_outcome(sm_pick, "error"),
            transitions={"succeeded": "CARRY", "aborted": "LET_GO", "error": "LET_GO"},
        )

        smach.StateMachine.add(  # main.yml:27
            "CARRY",
            error_as_outcome(
                with_timeout(ScriptedState(outcomes=["succeeded", "preempted"]), 5.0, "CARRY"),
                "error",
            ),
            transitions={
                "succeeded": "PLACE",
                "timeout": "LET_GO",
                "preempted": "LET_GO",
                "error": "LET_GO",
            },
        )

        smach.StateMachine.add(  # main.yml:33
            "PLACE",
            error_as_outcome(ScriptedState(outcomes=["succeeded"]), "error"),
            transitions={"succeeded": "REST", "error": "LET_GO"},
        )

        smach.StateMachine.add(  # main.yml:38
            "LET_GO", ScriptedState(outcomes=["succeeded"]), transitions={"succeeded": "aborted"}
        )

        smach.StateMachine.add(  # main.yml:43
            "REST",
            error_as_outcome(ScriptedState(outcomes=["succeeded"]), "error"),
            transitions={"error": "LET_GO", "succeeded": "succeeded"},
        )
    pass_on_stop_requests(properties)
    return properties


def main():
    """Run the state machine once and return its outcome."""
    properties = build()
    if __name__ == "__main__":
        signals.stop_at_signals(properties)
    return properties.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(signals.exit_code(outcome is None))
