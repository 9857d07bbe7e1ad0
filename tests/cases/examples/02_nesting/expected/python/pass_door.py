# Made by smachac 0.1.0 from main.yml (sha256 05e3a17974dfb005).
"""The state machine `pass_door`."""

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
    """Build the state machine `pass_door`."""
    pass_door = smach.StateMachine(outcomes=["succeeded", "aborted"])  # main.yml:2
    with pass_door:
        smach.StateMachine.add(  # main.yml:7
            "DRIVE_TO_DOOR",
            ScriptedState(outcomes=["there", "lost"]),
            transitions={"there": "OPEN_DOOR", "lost": "aborted"},
        )

        sm_open_door = smach.StateMachine(outcomes=["open", "stuck"])  # main.yml:12
        with sm_open_door:
            smach.StateMachine.add(  # main.yml:17
                "GRASP_HANDLE",
                ScriptedState(outcomes=["held", "missed"]),
                transitions={"held": "TURN_HANDLE", "missed": "stuck"},
            )

            smach.StateMachine.add(  # main.yml:21
                "TURN_HANDLE",
                ScriptedState(outcomes=["turned", "blocked"]),
                transitions={"turned": "PULL", "blocked": "stuck"},
            )

            smach.StateMachine.add(  # main.yml:25
                "PULL",
                ScriptedState(outcomes=["open", "stuck"]),
                transitions={"open": "open", "stuck": "stuck"},
            )

        smach.StateMachine.add(
            "OPEN_DOOR",
            sm_open_door,
            transitions={"open": "DRIVE_THROUGH", "stuck": "CALL_FOR_HELP"},
        )

        smach.StateMachine.add(  # main.yml:30
            "DRIVE_THROUGH",
            ScriptedState(outcomes=["succeeded", "aborted"]),
            transitions={"succeeded": "succeeded", "aborted": "aborted"},
        )

        smach.StateMachine.add(  # main.yml:35
            "CALL_FOR_HELP", ScriptedState(outcomes=["called"]), transitions={"called": "aborted"}
        )
    return pass_door


def main():
    """Run the state machine once and return its outcome."""
    pass_door = build()
    if __name__ == "__main__":
        signals.stop_at_signals(pass_door)
    return pass_door.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(signals.exit_code(outcome is None))
