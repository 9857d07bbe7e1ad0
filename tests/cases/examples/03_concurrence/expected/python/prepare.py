# Made by smachac 0.1.0 from main.yml (sha256 599aef45d8faa625).
"""The state machine `prepare`."""

from smachac.runtime import signals
from smachac.runtime.additions import SleepState, pass_on_stop_requests

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
    """Build the state machine `prepare`."""
    prepare = smach.StateMachine(outcomes=["succeeded", "aborted"])  # main.yml:2
    with prepare:
        sm_find_and_warm_up = smach.Concurrence(  # main.yml:7
            outcomes=["ready", "not_ready"],
            default_outcome="not_ready",
            outcome_map={"ready": {"FIND_PART": "found", "WARM_UP": "succeeded"}},
        )
        with sm_find_and_warm_up:
            smach.Concurrence.add(  # main.yml:15
                "FIND_PART", ScriptedState(outcomes=["found", "nothing"])
            )

            smach.Concurrence.add("WARM_UP", SleepState(time=0.05))  # main.yml:18

        smach.StateMachine.add(
            "FIND_AND_WARM_UP",
            sm_find_and_warm_up,
            transitions={"ready": "PICK", "not_ready": "aborted"},
        )

        smach.StateMachine.add(  # main.yml:22
            "PICK",
            ScriptedState(outcomes=["succeeded", "aborted"]),
            transitions={"succeeded": "succeeded", "aborted": "aborted"},
        )
    pass_on_stop_requests(prepare)
    return prepare


def main():
    """Run the state machine once and return its outcome."""
    prepare = build()
    if __name__ == "__main__":
        signals.stop_at_signals(prepare)
    return prepare.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(signals.exit_code(outcome is None))
