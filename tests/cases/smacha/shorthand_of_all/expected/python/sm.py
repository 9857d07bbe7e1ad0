# Made by smachac 0.1.0 from main.yml (sha256 583ef0632d9effb6).
"""The state machine `sm`."""

from smachac.runtime import signals
from smachac.runtime.additions import pass_on_stop_requests

try:
    import smach
except ImportError:  # without SMACH: smachac.runtime has the same names
    from smachac.runtime import smach


class CallbacksState(smach.State):
    """Calls functions of the userdata and writes each result to an output key."""

    def __init__(self, callbacks=(), input_keys=(), output_keys=()):
        super().__init__(
            outcomes=["succeeded"],
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.callbacks = callbacks

    def execute(self, userdata):
        for key in sorted(self.callbacks):
            function = self.callbacks[key]
            if not smach.has_smach_interface(function):
                userdata[key] = function(userdata)
            else:  # the function writes its output keys
                inputs = function.get_registered_input_keys()
                outputs = function.get_registered_output_keys()
                function(smach.Remapper(userdata, inputs, outputs, {}))
        return "succeeded"


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
    sm = smach.StateMachine(outcomes=["succeeded", "failed"])  # main.yml:2
    sm.userdata.start = 1
    with sm:
        sm_split = smach.Concurrence(  # main.yml:10
            outcomes=["succeeded", "failed"],
            default_outcome="failed",
            input_keys=["start"],
            output_keys=["sum"],
            outcome_map={"succeeded": {"COUNT": "succeeded", "CALL": "done"}},
        )
        with sm_split:
            smach.Concurrence.add(  # main.yml:19
                "COUNT",
                CallbacksState(
                    callbacks={"sum": lambda ud: ud.start + 1},
                    input_keys=["start"],
                    output_keys=["sum"],
                ),
            )

            smach.Concurrence.add(  # main.yml:20
                "CALL",
                ScriptedState(outcomes=["done"], input_keys=["part"]),
                remapping={"part": "start"},
            )

        smach.StateMachine.add(
            "SPLIT", sm_split, transitions={"succeeded": "succeeded", "failed": "failed"}
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
