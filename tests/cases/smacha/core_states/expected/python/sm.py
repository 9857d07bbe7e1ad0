# Made by smachac 0.1.0 from main.yml (sha256 055d40ab4ec652a9).
"""The state machine `sm`."""

import os
import random
import signal
import socket
import threading

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

    def __init__(
        self, outcomes, callbacks, default_outcome, input_keys=(), output_keys=()
    ):
        super().__init__(
            outcomes=outcomes,
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.writes_outcome = "outcome" in output_keys
        self.conditions = [
            (name, callbacks[name]) for name in outcomes if name in callbacks
        ]
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


stop_signals: list[int] = []


def stop_at_signals(stop):
    """Call `stop` at the first SIGINT, SIGTERM or SIGHUP; the second one ends the program.

    A thread reads the signals from a socket: Python runs no signal handler while the main
    thread is blocked.
    """
    read, write = socket.socketpair()
    write.setblocking(False)
    signal.set_wakeup_fd(write.detach())
    known = {signal.SIGINT, signal.SIGTERM, getattr(signal, "SIGHUP", signal.SIGTERM)}
    handled = [number for number in known if signal.getsignal(number) != signal.SIG_IGN]
    for number in handled:
        signal.signal(number, lambda number, frame: stop_signals.append(number))

    terminals = [stream for stream in range(3) if os.isatty(stream)]

    def wait():
        is_stopping = False
        while True:
            number = read.recv(1)[0]
            if number in handled and is_stopping:
                os._exit(128 + number)
            if number in handled:
                is_stopping = True
                for stream in terminals:
                    if not os.isatty(stream):  # it was closed: output to it is an error
                        os.dup2(os.open(os.devnull, os.O_RDWR), stream)
                threading.Thread(target=stop, daemon=False).start()

    threading.Thread(target=wait, daemon=True).start()


def main():
    """Run the state machine once and return its outcome."""
    sm = build()
    if __name__ == "__main__":
        stop_at_signals(sm.request_preempt)
    return sm.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(128 + stop_signals[0] if stop_signals else outcome is None)
