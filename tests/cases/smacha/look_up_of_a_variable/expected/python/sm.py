# Made by smachac 0.1.0 from main.yml (sha256 6c66e6c51f42abbd).
"""The state machine `sm`."""

import os
import signal
import socket
import threading

try:
    import smach
except ImportError:  # without SMACH: smachac.runtime has the same names
    from smachac.runtime import smach


class Drive(smach.State):
    """Drives on."""

    def __init__(self, speed, input_keys=()):
        super().__init__(outcomes=["done"], input_keys=list(input_keys))
        self.speed = speed

    def execute(self, userdata):
        return "done"


def build():
    """Build the state machine `sm`."""
    # main.yml:2
    sm = smach.StateMachine(outcomes=["succeeded"])
    sm.userdata.speed = 3
    with sm:
        # main.yml:7
        smach.StateMachine.add(
            "FOO",
            Drive(speed="fast", input_keys=["speed"]),
            transitions={"done": "succeeded"},
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
