# Made by smachac 0.1.0 from main.yml (sha256 e10e50a0fefe25e0).
"""The state machine `refused`."""

import operator
import os
import signal
import socket
import statistics
import sys
import threading

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
    # main.yml:2
    refused = smach.StateMachine(outcomes=["done"], output_keys=["n", "label"])
    refused.userdata.n = 3
    refused.userdata.label = "block"
    with refused:
        # main.yml:9
        smach.StateMachine.add(
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

        # main.yml:17
        smach.StateMachine.add(
            "NAME",
            CallbacksState(
                callbacks={"n": operator.index, "label": lambda ud: ud.label + ud.n},
                input_keys=["n", "label"],
                output_keys=["n", "label"],
            ),
            transitions={"succeeded": "WEIGH"},
        )

        # main.yml:23
        smach.StateMachine.add("WEIGH", Weigh(), transitions={"weighed": "done"})
    return refused


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
    refused = build()
    if __name__ == "__main__":
        stop_at_signals(refused.request_preempt)
    return refused.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(128 + stop_signals[0] if stop_signals else outcome is None)
