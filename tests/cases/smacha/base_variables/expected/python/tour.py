# Made by smachac 0.1.0 from main.yml (sha256 0edf566321a46b52).
"""The state machine `tour`."""

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
    """Build the state machine `tour`."""
    tour = smach.StateMachine(  # main.yml:2
        outcomes=["succeeded"], input_keys=["part"], output_keys=["part"]
    )
    tour.userdata.part = "bolt"
    with tour:
        smach.StateMachine.add(  # main.yml:11
            "FIRST", ScriptedState(outcomes=["done"]), transitions={"done": "SECOND"}
        )

        smach.StateMachine.add(  # main.yml:12
            "SECOND", ScriptedState(outcomes=["done"]), transitions={"done": "succeeded"}
        )
    return tour


def start():
    """Run the state machine once and return its outcome."""
    tour = build()
    if __name__ == "__main__":
        signals.stop_at_signals(tour)
    return tour.execute()


if __name__ == "__main__":
    outcome = start()
    print(f"outcome: {outcome}")
    raise SystemExit(signals.exit_code(outcome is None))
