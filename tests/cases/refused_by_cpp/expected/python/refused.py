# Made by smachac 0.1.0 from main.yml (sha256 e10e50a0fefe25e0).
"""The state machine `refused`."""

import operator
import statistics
import sys

from smachac.runtime import signals

try:
    from scales import Weigh
except ModuleNotFoundError as error:
    modules = ["scales"]
    if __name__ != "__main__" or error.name not in modules:
        raise
    searched = "\n  ".join(sys.path)
    raise SystemExit(
        f"{error}; it was searched in these folders:\n  {searched}\n"
        "Add the folder that contains it to PYTHONPATH."
    ) from None

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


def build():
    """Build the state machine `refused`."""
    refused = smach.StateMachine(outcomes=["done"], output_keys=["n", "label"])  # main.yml:2
    refused.userdata.n = 3
    refused.userdata.label = "block"
    with refused:
        smach.StateMachine.add(  # main.yml:9
            "MEASURE",
            CallbacksState(
                callbacks={
                    "n": lambda ud: statistics.fmean(ud.n),
                    "label": lambda ud: [each for each in ud.label],
                },
                input_keys=["n", "label"],
                output_keys=["n", "label"],
            ),
            transitions={"succeeded": "NAME"},
        )

        smach.StateMachine.add(  # main.yml:17
            "NAME",
            CallbacksState(
                callbacks={"n": operator.index, "label": lambda ud: ud.label + ud.n},
                input_keys=["n", "label"],
                output_keys=["n", "label"],
            ),
            transitions={"succeeded": "WEIGH"},
        )

        smach.StateMachine.add("WEIGH", Weigh(), transitions={"weighed": "done"})  # main.yml:23
    return refused


def main():
    """Run the state machine once and return its outcome."""
    refused = build()
    if __name__ == "__main__":
        signals.stop_at_signals(refused)
    return refused.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(signals.exit_code(outcome is None))
