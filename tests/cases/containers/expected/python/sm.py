# Made by smachac 0.1.0 from main.yml (sha256 35b3e424b6eae106).
"""The state machine `sm`."""

from smachac.runtime import signals
from smachac.runtime.additions import pass_on_stop_requests

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
    """Build the state machine `sm`."""
    sm = smach.StateMachine(outcomes=["succeeded", "aborted"])  # main.yml:2
    with sm:
        sm_line = smach.Sequence(  # main.yml:7
            outcomes=["succeeded", "aborted"], connector_outcome="succeeded"
        )
        with sm_line:
            smach.Sequence.add("ONE", ScriptedState(outcomes=["succeeded"]))  # main.yml:13

            smach.Sequence.add(  # main.yml:14
                "TWO",
                ScriptedState(outcomes=["succeeded", "failed"]),
                transitions={"failed": "aborted"},
            )

            smach.Sequence.add(  # main.yml:15
                "THREE",
                ScriptedState(outcomes=["succeeded", "aborted"]),
                transitions={"succeeded": "succeeded", "aborted": "aborted"},
            )

        smach.StateMachine.add(
            "LINE", sm_line, transitions={"succeeded": "succeeded", "aborted": "aborted"}
        )

        sm_round = smach.Iterator(  # main.yml:16
            outcomes=["finished", "aborted"],
            it=[1, 2, 3],
            it_label="number",
            exhausted_outcome="finished",
            input_keys=[],
            output_keys=[],
        )
        with sm_round:
            smach.Iterator.set_contained_state(  # main.yml:26
                "STEP",
                ScriptedState(outcomes=["go", "stop"], input_keys=["number"]),
                loop_outcomes=["go"],
                final_outcome_map={"stop": "aborted"},
            )

        smach.StateMachine.add(
            "ROUND", sm_round, transitions={"finished": "BOTH", "aborted": "aborted"}
        )

        sm_both = smach.Concurrence(  # main.yml:27
            outcomes=["both", "one", "none"],
            default_outcome="none",
            outcome_map={"one": {"A": "done"}, "both": {"A": "done", "B": "done"}},
        )
        with sm_both:
            smach.Concurrence.add("A", ScriptedState(outcomes=["done", "failed"]))  # main.yml:36

            smach.Concurrence.add("B", ScriptedState(outcomes=["done", "failed"]))  # main.yml:37

        smach.StateMachine.add(
            "BOTH", sm_both, transitions={"both": "LINE", "one": "LINE", "none": "aborted"}
        )
    sm.set_initial_state(["ROUND"])
    pass_on_stop_requests(sm)
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
