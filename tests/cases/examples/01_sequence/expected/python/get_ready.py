# Made by smachac 0.1.0 from main.yml (sha256 4c3ccd6f4eda27d8).
"""The state machine `get_ready`."""

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
    """Build the state machine `get_ready`."""
    get_ready = smach.StateMachine(outcomes=["succeeded", "aborted"])  # main.yml:2
    with get_ready:
        smach.StateMachine.add(  # main.yml:7
            "CHECK_BATTERY",
            ScriptedState(outcomes=["full", "low"]),
            transitions={"full": "RELEASE_BRAKES", "low": "aborted"},
        )

        smach.StateMachine.add(  # main.yml:12
            "RELEASE_BRAKES",
            ScriptedState(outcomes=["succeeded", "aborted"]),
            transitions={"succeeded": "GO_HOME", "aborted": "aborted"},
        )

        smach.StateMachine.add(  # main.yml:17
            "GO_HOME",
            ScriptedState(outcomes=["succeeded", "aborted"]),
            transitions={"succeeded": "succeeded", "aborted": "aborted"},
        )
    return get_ready


def main():
    """Run the state machine once and return its outcome."""
    get_ready = build()
    if __name__ == "__main__":
        signals.stop_at_signals(get_ready)
    return get_ready.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(signals.exit_code(outcome is None))
