# Made by smachac 0.1.0 from main.yml (sha256 35b3e424b6eae106).
"""The state machine `sm`."""

try:
    import smach
except ImportError:  # no ROS on this machine: the same names without it
    from smachac.runtime import smach


class ScriptedState(smach.State):
    """Ends as it is told: visit n does step n, the last step is repeated.

    Asked to stop, it ends as `preempted` where it has that outcome.
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
    # main.yml:2
    sm = smach.StateMachine(outcomes=["succeeded", "aborted"])
    with sm:
        # main.yml:7
        sm_line = smach.Sequence(
            outcomes=["succeeded", "aborted"],
            connector_outcome="succeeded",
        )
        with sm_line:
            # main.yml:13
            smach.Sequence.add("ONE", ScriptedState(outcomes=["succeeded"]))

            # main.yml:14
            smach.Sequence.add(
                "TWO",
                ScriptedState(outcomes=["succeeded", "failed"]),
                transitions={"failed": "aborted"},
            )

            # main.yml:15
            smach.Sequence.add(
                "THREE",
                ScriptedState(outcomes=["succeeded", "aborted"]),
                transitions={"succeeded": "succeeded", "aborted": "aborted"},
            )

        smach.StateMachine.add(
            "LINE",
            sm_line,
            transitions={"succeeded": "succeeded", "aborted": "aborted"},
        )

        # main.yml:16
        sm_round = smach.Iterator(
            outcomes=["finished", "aborted"],
            it=[1, 2, 3],
            it_label="number",
            exhausted_outcome="finished",
        )
        with sm_round:
            # main.yml:26
            smach.Iterator.set_contained_state(
                "STEP",
                ScriptedState(outcomes=["go", "stop"], input_keys=["number"]),
                loop_outcomes=["go"],
                final_outcome_map={"stop": "aborted"},
            )

        smach.StateMachine.add(
            "ROUND",
            sm_round,
            transitions={"finished": "BOTH", "aborted": "aborted"},
        )

        # main.yml:27
        sm_both = smach.Concurrence(
            outcomes=["both", "one", "none"],
            default_outcome="none",
            outcome_map={"one": {"A": "done"}, "both": {"A": "done", "B": "done"}},
        )
        with sm_both:
            # main.yml:36
            smach.Concurrence.add("A", ScriptedState(outcomes=["done", "failed"]))

            # main.yml:37
            smach.Concurrence.add("B", ScriptedState(outcomes=["done", "failed"]))

        smach.StateMachine.add(
            "BOTH",
            sm_both,
            transitions={"both": "LINE", "one": "LINE", "none": "aborted"},
        )
    sm.set_initial_state(["ROUND"])
    return sm


def main():
    """Run the state machine once and return its outcome."""
    return build().execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(outcome is None)
