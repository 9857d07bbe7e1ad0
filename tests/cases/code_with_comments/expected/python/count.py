# Made by smachac 0.1.0 from main.yml (sha256 365a40ec96868634).
"""A comment in code must not swallow what is printed behind it."""

import os
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
    """Build the state machine `count`."""
    # main.yml:1
    count = smach.StateMachine(outcomes=["succeeded"])
    count.userdata.n = 0
    with count:
        # main.yml:7
        smach.StateMachine.add(
            "COUNT",
            CallbacksState(
                callbacks={
                    "n": lambda ud: ud.n + len('#') + (lambda a, b: a + b)(1, 2),
                },
                input_keys=["n"],
                output_keys=["n"],
            ),
            transitions={"succeeded": "SHOW"},
        )

        # main.yml:14
        smach.StateMachine.add(
            "SHOW",
            PrintUserdataState(input_keys=["n"]),
            transitions={"succeeded": "succeeded"},
        )
    return count


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
    count = build()
    if __name__ == "__main__":
        stop_at_signals(count.request_preempt)
    return count.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(128 + stop_signals[0] if stop_signals else outcome is None)
