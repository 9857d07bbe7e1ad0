# Made by smachac 0.1.0 from main.yml (sha256 4fc28c8251492587).
"""The state machine `code_in_both`."""

import os
import signal
import socket
import sys
import threading

try:
    from arm_skills.carry import Carry
except ModuleNotFoundError as error:
    modules = ["arm_skills", "arm_skills.carry"]
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


def build():
    """Build the state machine `code_in_both`."""
    # main.yml:2
    code_in_both = smach.StateMachine(outcomes=["done", "lost"])
    code_in_both.userdata.shelf = [[0.5, 0.0, 0.1], [0.0, 0.0, 0.0, 1.0]]
    code_in_both.userdata.table = [[0.5, 0.3, 0.0], [0.0, 0.0, 0.0, 1.0]]
    with code_in_both:
        # main.yml:10
        smach.StateMachine.add(
            "CARRY",
            Carry(speed=0.5),
            transitions={"done": "done", "not-found": "lost", "preempted": "lost"},
            remapping={"from": "shelf", "into": "table"},
        )
    return code_in_both


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
    code_in_both = build()
    if __name__ == "__main__":
        stop_at_signals(code_in_both.request_preempt)
    return code_in_both.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(128 + stop_signals[0] if stop_signals else outcome is None)
