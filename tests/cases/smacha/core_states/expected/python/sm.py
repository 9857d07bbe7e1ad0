# Made by smachac 0.1.0 from main.yml (sha256 055d40ab4ec652a9).
"""The state machine `sm`."""

import random

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


class ConditionalOutcomeState(smach.State):
    """Ends with the first of its outcomes whose condition holds, else the default."""

    def __init__(
        self, outcomes, callbacks, default_outcome, input_keys=(), output_keys=()
    ):
        super().__init__(
            outcomes=outcomes,
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.tells = "outcome" in output_keys
        self.conditions = [
            (name, callbacks[name]) for name in outcomes if name in callbacks
        ]
        self.default_outcome = default_outcome

    def execute(self, userdata):
        holding = (name for name, holds in self.conditions if holds(userdata))
        outcome = next(holding, self.default_outcome)
        if self.tells:
            userdata["outcome"] = outcome
        return outcome


class RandomOutcomeState(smach.State):
    """Ends with one of its outcomes by chance; with a seed, in the same order in each run."""

    def __init__(self, outcomes, seed=None, input_keys=(), output_keys=()):
        super().__init__(
            outcomes=outcomes,
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.tells = "outcome" in output_keys
        self.choices = list(outcomes)
        # Without a seed each state has random numbers of its own, which `random.seed` repeats.
        self.random = random.Random(random.getrandbits(64) if seed is None else seed)

    def execute(self, userdata):
        outcome = self.random.choice(self.choices)
        if self.tells:
            userdata["outcome"] = outcome
        return outcome


class PrintUserdataState(smach.State):
    """Prints its input keys, one a line."""

    def __init__(self, input_keys=()):
        super().__init__(outcomes=["succeeded"], input_keys=list(input_keys))
        self.printed_keys = sorted(input_keys)

    def execute(self, userdata):
        for key in self.printed_keys:
            print(f"{key}: {userdata[key]}")
        return "succeeded"


def build():
    """Build the state machine `sm`."""
    # main.yml:2
    sm = smach.StateMachine(outcomes=["succeeded", "failed"])
    sm.userdata.n = 1
    with sm:
        # main.yml:7
        smach.StateMachine.add(
            "ADD",
            CallbacksState(
                callbacks={"n": lambda ud: ud.n + 1},
                input_keys=["n"],
                output_keys=["n"],
            ),
            transitions={"succeeded": "JUDGE"},
        )

        # main.yml:13
        smach.StateMachine.add(
            "JUDGE",
            ConditionalOutcomeState(
                outcomes=["large", "small"],
                callbacks={"large": lambda ud: ud.n > 5},
                default_outcome="small",
                input_keys=["n"],
            ),
            transitions={"large": "SHOW", "small": "CHANCE"},
        )

        # main.yml:20
        smach.StateMachine.add(
            "CHANCE",
            RandomOutcomeState(outcomes=["heads", "tails"]),
            transitions={"heads": "ADD", "tails": "failed"},
        )

        # main.yml:21
        smach.StateMachine.add(
            "SHOW",
            PrintUserdataState(input_keys=["n"]),
            transitions={"succeeded": "succeeded"},
        )
    return sm


def main():
    """Run the state machine once and return its outcome."""
    return build().execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(outcome is None)
