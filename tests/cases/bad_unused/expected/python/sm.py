# Made by smachac 0.1.0 from main.yml (sha256 36ce5025c9f6b2d3).
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


def build():
    """Build the state machine `sm`."""
    sm = smach.StateMachine(outcomes=["done", "failed"])  # main.yml:2
    sm.userdata.both = [1.0, 2.0]
    sm.userdata.way = "/left"
    with sm:
        smach.StateMachine.add("CALL", build_sub(), transitions={"done": "JUDGE"})  # main.yml:10

        smach.StateMachine.add(  # main.yml:14
            "JUDGE",
            ConditionalOutcomeState(
                outcomes=["large", "small", "tiny"],
                callbacks={"large": lambda ud: ud.both[0] > 1 and ud.way != ""},
                default_outcome="small",
                input_keys=["both", "way"],
            ),
            transitions={"large": "done", "small": "failed", "tiny": "failed"},
        )
    return sm


def build_sub():
    """Build the state machine of `sub.yml`."""
    sm_call = smach.StateMachine(outcomes=["done"])
    with sm_call:
        # at2
        smach.StateMachine.add(  # sub.yml:6
            "SAY",
            ScriptedState(outcomes=["done"], steps=[{"outcome": "done"}]),
            transitions={"done": "done"},
        )
    return sm_call


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
