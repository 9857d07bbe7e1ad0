# Made by smachac 0.1.0 from main.yml (sha256 75a72e037e51c72b).
"""The state machine `sm`."""

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


def build():
    """Build the state machine `sm`."""
    sm = smach.StateMachine(outcomes=["succeeded", "aborted"])  # main.yml:2
    with sm:
        smach.StateMachine.add(  # main.yml:7
            "PLAIN",
            build_sub(tool="nobody_gripper"),
            transitions={"done": "OTHER", "aborted": "aborted"},
        )

        smach.StateMachine.add(  # main.yml:10
            "OTHER",
            build_sub_2(),
            transitions={"done": "THROUGH", "aborted": "aborted", "extra": "aborted"},
        )

        smach.StateMachine.add(  # main.yml:16
            "THROUGH",
            build_sub(tool="through_gripper"),
            transitions={"done": "succeeded", "aborted": "aborted"},
        )
    return sm


def build_sub(tool):
    """Build the state machine of `sub.yml`."""
    sm_sub = smach.StateMachine(outcomes=["done", "aborted"])
    sm_sub.userdata.a = 1
    sm_sub.userdata.b = 2
    sm_sub.userdata.tool = tool
    with sm_sub:
        smach.StateMachine.add(  # sub.yml:7
            "A",
            ScriptedState(outcomes=["done", "aborted", "extra"]),
            transitions={"extra": "done", "done": "done", "aborted": "aborted"},
        )
    return sm_sub


def build_sub_2():
    """Build the state machine of `sub.yml`."""
    sm_other = smach.StateMachine(outcomes=["done", "aborted", "extra"])
    sm_other.userdata.a = 1
    sm_other.userdata.b = 20
    sm_other.userdata.tool = "right_gripper"
    sm_other.userdata.c = 30
    with sm_other:
        smach.StateMachine.add(  # sub.yml:7
            "A",
            ScriptedState(outcomes=["done", "aborted", "extra"]),
            transitions={"extra": "done", "done": "done", "aborted": "aborted"},
        )
    return sm_other


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
