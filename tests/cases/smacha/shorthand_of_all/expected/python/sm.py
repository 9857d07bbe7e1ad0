# Made by smachac 0.1.0 from main.yml (sha256 583ef0632d9effb6).
"""The state machine `sm`."""

try:
    import smach
except ImportError:  # no ROS on this machine: the same names without it
    from smachac.runtime import smach


class CallbacksState(smach.State):
    """Calls functions of the userdata, keeps what each returns under its own name."""

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
            else:  # it writes its keys itself
                inputs = function.get_registered_input_keys()
                outputs = function.get_registered_output_keys()
                function(smach.Remapper(userdata, inputs, outputs, {}))
        return "succeeded"


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
    sm = smach.StateMachine(outcomes=["succeeded", "failed"])
    sm.userdata.start = 1
    with sm:
        # main.yml:10
        sm_split = smach.Concurrence(
            outcomes=["succeeded", "failed"],
            default_outcome="failed",
            input_keys=["start"],
            output_keys=["sum"],
            outcome_map={"succeeded": {"COUNT": "succeeded", "CALL": "done"}},
        )
        with sm_split:
            # main.yml:19
            smach.Concurrence.add(
                "COUNT",
                CallbacksState(
                    callbacks={"sum": lambda ud: ud.start + 1},
                    input_keys=["start"],
                    output_keys=["sum"],
                ),
            )

            # main.yml:20
            smach.Concurrence.add(
                "CALL",
                ScriptedState(outcomes=["done"], input_keys=["part"]),
                remapping={"part": "start"},
            )

        smach.StateMachine.add(
            "SPLIT",
            sm_split,
            transitions={"succeeded": "succeeded", "failed": "failed"},
        )
    return sm


def main():
    """Run the state machine once and return its outcome."""
    return build().execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(outcome is None)
