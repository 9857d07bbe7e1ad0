# Made by smachac 0.1.0 from main.yml (sha256 36f306daa806a188).
"""Fetches each ordered part from its shelf."""

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
    """Build the state machine `orders`."""
    orders = smach.StateMachine(outcomes=["done", "failed"])  # main.yml:2
    orders.userdata.parts = [
        {"name": "bolt", "shelf": "left", "at": [0.5, 0.1, 0.2]},
        {"name": "nut", "shelf": "right"},
    ]
    orders.userdata.size = {"long side": 0.2, "count": 3}
    with orders:
        sm_each = smach.Iterator(  # main.yml:15
            outcomes=["done"],
            it=lambda: sm_each.userdata["parts"],
            it_label="part",
            exhausted_outcome="done",
            input_keys=["parts"],
            output_keys=[],
        )
        with sm_each:
            smach.Iterator.set_contained_state(  # main.yml:24
                "SHELF",
                CallbacksState(
                    callbacks={
                        "shelf": lambda ud: ud.part["shelf"],
                        "label": lambda ud: ud.part["name"] + "_" + ud.part["shelf"],
                    },
                    input_keys=["part"],
                    output_keys=["shelf", "label"],
                ),
                loop_outcomes=["succeeded"],
            )

        smach.StateMachine.add("EACH", sm_each, transitions={"done": "MEASURE"})

        smach.StateMachine.add(  # main.yml:32
            "MEASURE",
            ScriptedState(
                outcomes=["ok", "none"],
                steps=[{"outcome": "ok", "set": {"seen": {"name": "bolt", "count": 2}}}],
                input_keys=["size"],
                output_keys=["seen"],
            ),
            transitions={"ok": "SHOW", "none": "failed"},
        )

        smach.StateMachine.add(  # main.yml:39
            "SHOW", PrintUserdataState(input_keys=["seen"]), transitions={"succeeded": "done"}
        )
    pass_on_stop_requests(orders)
    return orders


def main():
    """Run the state machine once and return its outcome."""
    orders = build()
    if __name__ == "__main__":
        signals.stop_at_signals(orders)
    return orders.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(signals.exit_code(outcome is None))
