# Made by smachac 0.1.0 from main.yml (sha256 055d40ab4ec652a9).
"""The state machine `sm`."""

import random

from smachac.runtime import signals

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


class RandomOutcomeState(smach.State):
    """Ends with a random outcome; a seed makes the sequence the same in each run."""

    def __init__(self, outcomes, seed=None, input_keys=(), output_keys=()):
        super().__init__(
            outcomes=outcomes,
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.writes_outcome = "outcome" in output_keys
        self.choices = list(outcomes)
        # Without a seed, each state has its own generator with a seed from `random`.
        self.random = random.Random(random.getrandbits(64) if seed is None else seed)

    def execute(self, userdata):
        outcome = self.random.choice(self.choices)
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
    """Build the state machine `sm`."""
    sm = smach.StateMachine(outcomes=["succeeded", "failed"])  # main.yml:2
    sm.userdata.n = 1
    with sm:
        smach.StateMachine.add(  # main.yml:7
            "ADD",
            CallbacksState(
                callbacks={"n": lambda ud: ud.n + 1}, input_keys=["n"], output_keys=["n"]
            ),
            transitions={"succeeded": "JUDGE"},
        )

        smach.StateMachine.add(  # main.yml:13
            "JUDGE",
            ConditionalOutcomeState(
                outcomes=["large", "small"],
                callbacks={"large": lambda ud: ud.n > 5},
                default_outcome="small",
                input_keys=["n"],
            ),
            transitions={"large": "SHOW", "small": "CHANCE"},
        )

        smach.StateMachine.add(  # main.yml:20
            "CHANCE",
            RandomOutcomeState(outcomes=["heads", "tails"]),
            transitions={"heads": "ADD", "tails": "failed"},
        )

        smach.StateMachine.add(  # main.yml:21
            "SHOW", PrintUserdataState(input_keys=["n"]), transitions={"succeeded": "succeeded"}
        )
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
