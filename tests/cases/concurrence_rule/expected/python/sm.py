# Made by smachac 0.1.0 from main.yml (sha256 13af6b4e7cdbc902).
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
    sm = smach.StateMachine(outcomes=["held", "lost", "stopped"])  # main.yml:2
    with sm:
        sm_grasp = smach.Concurrence(  # main.yml:6
            outcomes=["held", "lost", "stopped"],
            default_outcome="stopped",
            outcome_cb=lambda ended: "lost" if ended["CLOSE"] == "slipped" else "held" if ended["CLOSE"] == "done" and ended["LIFT"] == "done" else "lost" if ended["LIFT"] == "slipped" else None,
            child_termination_cb=lambda outcomes: (outcomes.get("CLOSE") == "slipped") or (outcomes.get("CLOSE") == "done" and outcomes.get("LIFT") == "done") or (outcomes.get("LIFT") == "slipped"),
        )
        with sm_grasp:
            smach.Concurrence.add(  # main.yml:15
                "CLOSE", ScriptedState(outcomes=["done", "slipped", "preempted"])
            )

            smach.Concurrence.add(  # main.yml:16
                "LIFT", ScriptedState(outcomes=["done", "slipped", "preempted"])
            )

        smach.StateMachine.add(
            "GRASP", sm_grasp, transitions={"held": "held", "lost": "lost", "stopped": "stopped"}
        )
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
