# Made by smachac 0.1.0 from main.yml (sha256 fcea3669ca97f79b).
"""The state machine `sm`."""

import math
import os
import signal
import socket
import threading

try:
    import smach
except ImportError:  # without SMACH: smachac.runtime has the same names
    from smachac.runtime import smach


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


def build():
    """Build the state machine `sm`."""
    # main.yml:3
    sm = smach.StateMachine(outcomes=["succeeded"])
    sm.userdata.file = "block.urdf"
    sm.userdata.Word = "hi (x)"
    sm.userdata.endless = "inf"
    sm.userdata.apostrophe = "it's"
    sm.userdata.nothing = None
    sm.userdata.tau = math.tau
    sm.userdata.sum = "2 * math.pi"
    sm.userdata.number = "12"
    sm.userdata.truth = True
    with sm:
        # main.yml:8
        smach.StateMachine.add(
            "FOO",
            ScriptedState(
                outcomes=["done"],
                input_keys=[
                    "file",
                    "Word",
                    "endless",
                    "apostrophe",
                    "nothing",
                    "tau",
                    "sum",
                    "number",
                    "truth",
                ],
            ),
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
