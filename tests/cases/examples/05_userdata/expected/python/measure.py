# Made by smachac 0.1.0 from main.yml (sha256 151be300629b9acd).
"""The state machine `measure`."""

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
    """Build the state machine `measure`."""
    # main.yml:2
    measure = smach.StateMachine(outcomes=["succeeded"])
    measure.userdata.limit = 0.08
    with measure:
        # main.yml:9
        smach.StateMachine.add(
            "MEASURE_WIDTH",
            ScriptedState(
                outcomes=["measured"],
                steps=[{"outcome": "measured", "set": {"width": 0.05}}],
                output_keys=["width"],
            ),
            transitions={"measured": "JUDGE"},
            remapping={"width": "part_width"},
        )

        # main.yml:17
        sm_judge = smach.StateMachine(
            outcomes=["fits", "too_wide"],
            input_keys=["width", "limit"],
        )
        with sm_judge:
            # main.yml:24
            smach.StateMachine.add(
                "COMPARE",
                ConditionalOutcomeState(
                    outcomes=["fits", "too_wide"],
                    callbacks={"fits": lambda ud: ud.width <= ud.limit},
                    default_outcome="too_wide",
                    input_keys=["width", "limit"],
                ),
                transitions={"fits": "fits", "too_wide": "too_wide"},
            )

        smach.StateMachine.add(
            "JUDGE",
            sm_judge,
            transitions={"fits": "TELL", "too_wide": "TELL"},
            remapping={"width": "part_width"},
        )

        # main.yml:32
        smach.StateMachine.add(
            "TELL",
            PrintUserdataState(input_keys=["part_width", "limit"]),
            transitions={"succeeded": "succeeded"},
        )
    return measure


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
    measure = build()
    if __name__ == "__main__":
        stop_at_signals(measure.request_preempt)
    return measure.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(128 + stop_signals[0] if stop_signals else outcome is None)
