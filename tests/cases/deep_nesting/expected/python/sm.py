# Made by smachac 0.1.0 from main.yml (sha256 902e49a7a704b304).
"""The state machine `sm`."""

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
    # main.yml:2
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        # main.yml:6
        smach.StateMachine.add("C0", build_c0(), transitions={"done": "done"})
    return sm


def build_c0():
    """Build the state machine `C0`."""
    sm_c0 = smach.StateMachine(outcomes=["done"])
    with sm_c0:
        # main.yml:10
        sm_c1 = smach.StateMachine(outcomes=["done"])
        with sm_c1:
            # main.yml:14
            sm_c2 = smach.StateMachine(outcomes=["done"])
            with sm_c2:
                # main.yml:18
                smach.StateMachine.add("C3", build_c3(), transitions={"done": "done"})

            smach.StateMachine.add("C2", sm_c2, transitions={"done": "done"})

        smach.StateMachine.add("C1", sm_c1, transitions={"done": "done"})
    return sm_c0


def build_c3():
    """Build the state machine `C3`."""
    sm_c3 = smach.StateMachine(outcomes=["done"])
    with sm_c3:
        # main.yml:22
        sm_c4 = smach.StateMachine(outcomes=["done"])
        with sm_c4:
            # main.yml:26
            sm_c5 = smach.StateMachine(outcomes=["done"])
            with sm_c5:
                # main.yml:30
                smach.StateMachine.add("C6", build_c6(), transitions={"done": "done"})

            smach.StateMachine.add("C5", sm_c5, transitions={"done": "done"})

        smach.StateMachine.add("C4", sm_c4, transitions={"done": "done"})
    return sm_c3


def build_c6():
    """Build the state machine `C6`."""
    sm_c6 = smach.StateMachine(outcomes=["done"])
    with sm_c6:
        # main.yml:34
        sm_c7 = smach.StateMachine(outcomes=["done"])
        with sm_c7:
            # main.yml:38
            sm_c8 = smach.StateMachine(outcomes=["done"])
            with sm_c8:
                # main.yml:42
                smach.StateMachine.add("C9", build_c9(), transitions={"done": "done"})

            smach.StateMachine.add("C8", sm_c8, transitions={"done": "done"})

        smach.StateMachine.add("C7", sm_c7, transitions={"done": "done"})
    return sm_c6


def build_c9():
    """Build the state machine `C9`."""
    sm_c9 = smach.StateMachine(outcomes=["done"])
    with sm_c9:
        # main.yml:46
        sm_c10 = smach.StateMachine(outcomes=["done"])
        with sm_c10:
            # main.yml:50
            sm_c11 = smach.StateMachine(outcomes=["done"])
            with sm_c11:
                # main.yml:54
                smach.StateMachine.add("C12", build_c12(), transitions={"done": "done"})

            smach.StateMachine.add("C11", sm_c11, transitions={"done": "done"})

        smach.StateMachine.add("C10", sm_c10, transitions={"done": "done"})
    return sm_c9


def build_c12():
    """Build the state machine `C12`."""
    sm_c12 = smach.StateMachine(outcomes=["done"])
    with sm_c12:
        # main.yml:58
        sm_c13 = smach.StateMachine(outcomes=["done"])
        with sm_c13:
            # main.yml:62
            sm_c14 = smach.StateMachine(outcomes=["done"])
            with sm_c14:
                # main.yml:66
                smach.StateMachine.add("C15", build_c15(), transitions={"done": "done"})

            smach.StateMachine.add("C14", sm_c14, transitions={"done": "done"})

        smach.StateMachine.add("C13", sm_c13, transitions={"done": "done"})
    return sm_c12


def build_c15():
    """Build the state machine `C15`."""
    sm_c15 = smach.StateMachine(outcomes=["done"])
    with sm_c15:
        # main.yml:70
        sm_c16 = smach.StateMachine(outcomes=["done"])
        with sm_c16:
            # main.yml:74
            sm_c17 = smach.StateMachine(outcomes=["done"])
            with sm_c17:
                # main.yml:78
                smach.StateMachine.add("C18", build_c18(), transitions={"done": "done"})

            smach.StateMachine.add("C17", sm_c17, transitions={"done": "done"})

        smach.StateMachine.add("C16", sm_c16, transitions={"done": "done"})
    return sm_c15


def build_c18():
    """Build the state machine `C18`."""
    sm_c18 = smach.StateMachine(outcomes=["done"])
    with sm_c18:
        # main.yml:82
        sm_c19 = smach.StateMachine(outcomes=["done"])
        with sm_c19:
            # main.yml:86
            sm_c20 = smach.StateMachine(outcomes=["done"])
            with sm_c20:
                # main.yml:90
                smach.StateMachine.add("C21", build_c21(), transitions={"done": "done"})

            smach.StateMachine.add("C20", sm_c20, transitions={"done": "done"})

        smach.StateMachine.add("C19", sm_c19, transitions={"done": "done"})
    return sm_c18


def build_c21():
    """Build the state machine `C21`."""
    sm_c21 = smach.StateMachine(outcomes=["done"])
    with sm_c21:
        # main.yml:94
        sm_c22 = smach.StateMachine(outcomes=["done"])
        with sm_c22:
            # main.yml:98
            sm_c23 = smach.StateMachine(outcomes=["done"])
            with sm_c23:
                # main.yml:102
                smach.StateMachine.add("C24", build_c24(), transitions={"done": "done"})

            smach.StateMachine.add("C23", sm_c23, transitions={"done": "done"})

        smach.StateMachine.add("C22", sm_c22, transitions={"done": "done"})
    return sm_c21


def build_c24():
    """Build the state machine `C24`."""
    sm_c24 = smach.StateMachine(outcomes=["done"])
    with sm_c24:
        # main.yml:106
        sm_c25 = smach.StateMachine(outcomes=["done"])
        with sm_c25:
            # main.yml:110
            sm_c26 = smach.StateMachine(outcomes=["done"])
            with sm_c26:
                # main.yml:114
                smach.StateMachine.add("C27", build_c27(), transitions={"done": "done"})

            smach.StateMachine.add("C26", sm_c26, transitions={"done": "done"})

        smach.StateMachine.add("C25", sm_c25, transitions={"done": "done"})
    return sm_c24


def build_c27():
    """Build the state machine `C27`."""
    sm_c27 = smach.StateMachine(outcomes=["done"])
    with sm_c27:
        # main.yml:118
        sm_c28 = smach.StateMachine(outcomes=["done"])
        with sm_c28:
            # main.yml:122
            sm_c29 = smach.StateMachine(outcomes=["done"])
            with sm_c29:
                # main.yml:126
                smach.StateMachine.add(
                    "LEAF",
                    ScriptedState(outcomes=["done"]),
                    transitions={"done": "done"},
                )

            smach.StateMachine.add("C29", sm_c29, transitions={"done": "done"})

        smach.StateMachine.add("C28", sm_c28, transitions={"done": "done"})
    return sm_c27


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
