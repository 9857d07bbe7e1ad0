# Made by smachac 0.1.0 from main.yml (sha256 b8f8a767cb97a2e5).
"""The state machine `bad_presets`."""

import os
import signal
import socket
import threading

try:
    import smach
except ImportError:  # without SMACH: smachac.runtime has the same names
    from smachac.runtime import smach


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
    """Build the state machine `bad_presets`."""
    # main.yml:2
    bad_presets = smach.StateMachine(outcomes=["done"])
    bad_presets.userdata.height = 0.4
    bad_presets.userdata.limit = 3
    bad_presets.userdata.speed = 1.0
    with bad_presets:
        # main.yml:8
        smach.StateMachine.add(
            "NEAR",
            PrintUserdataState(input_keys=["speed", "height", "limit"]),
            transitions={"succeeded": "FAR"},
        )

        # main.yml:14
        smach.StateMachine.add(
            "FAR",
            PrintUserdataState(input_keys=["speed", "height", "limit"]),
            transitions={"succeeded": "LAST"},
        )

        # main.yml:20
        smach.StateMachine.add(
            "LAST",
            PrintUserdataState(input_keys=["height"]),
            transitions={"succeeded": "done"},
        )
    return bad_presets


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
    bad_presets = build()
    if __name__ == "__main__":
        stop_at_signals(bad_presets.request_preempt)
    return bad_presets.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(128 + stop_signals[0] if stop_signals else outcome is None)
