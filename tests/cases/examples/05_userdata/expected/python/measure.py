# Made by smachac 0.1.0 from main.yml (sha256 151be300629b9acd).
"""The state machine `measure`."""

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


class PrintUserdataState(smach.State):
    """Prints the input keys and their values, one key per line."""

    def __init__(self, input_keys=()):
        super().__init__(outcomes=["succeeded"], input_keys=list(input_keys))
        self.printed_keys = sorted(input_keys)

    def execute(self, userdata):
        for key in self.printed_keys:
            print(f"{key}: {userdata[key]}")
        return "succeeded"


def build():
    """Build the state machine `measure`."""
    measure = smach.StateMachine(outcomes=["succeeded"])  # main.yml:2
    measure.userdata.limit = 0.08
    with measure:
        smach.StateMachine.add(  # main.yml:9
            "MEASURE_WIDTH",
            ScriptedState(
                outcomes=["measured"],
                steps=[{"outcome": "measured", "set": {"width": 0.05}}],
                output_keys=["width"],
            ),
            transitions={"measured": "JUDGE"},
            remapping={"width": "part_width"},
        )

        sm_judge = smach.StateMachine(  # main.yml:17
            outcomes=["fits", "too_wide"], input_keys=["width", "limit"]
        )
        with sm_judge:
            smach.StateMachine.add(  # main.yml:24
                "COMPARE",
                ConditionalOutcomeState(
                    outcomes=["fits", "too_wide"],
                    callbacks={"fits": lambda ud: ud.width <= ud.limit},
                    default_outcome="too_wide",
                    input_keys=["width", "limit"],
                ),
                transitions={"fits": "fits", "too_wide": "too_wide"},
            )

        smach.StateMachine.add(
            "JUDGE",
            sm_judge,
            transitions={"fits": "TELL", "too_wide": "TELL"},
            remapping={"width": "part_width"},
        )

        smach.StateMachine.add(  # main.yml:32
            "TELL",
            PrintUserdataState(input_keys=["part_width", "limit"]),
            transitions={"succeeded": "succeeded"},
        )
    return measure


def main():
    """Run the state machine once and return its outcome."""
    measure = build()
    if __name__ == "__main__":
        signals.stop_at_signals(measure)
    return measure.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(signals.exit_code(outcome is None))
