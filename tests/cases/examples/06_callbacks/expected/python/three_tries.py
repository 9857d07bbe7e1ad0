# Made by smachac 0.1.0 from main.yml (sha256 b628bda36d0008e8).
"""The state machine `three_tries`."""

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


def build():
    """Build the state machine `three_tries`."""
    # main.yml:2
    three_tries = smach.StateMachine(outcomes=["succeeded", "aborted"])
    three_tries.userdata.tries = 0
    with three_tries:
        # main.yml:8
        smach.StateMachine.add(
            "TRY",
            ScriptedState(
                outcomes=["succeeded", "aborted"],
                steps=[
                    {"outcome": "aborted"},
                    {"outcome": "aborted"},
                    {"outcome": "succeeded"},
                ],
            ),
            transitions={"succeeded": "succeeded", "aborted": "COUNT"},
        )

        # main.yml:14
        smach.StateMachine.add(
            "COUNT",
            CallbacksState(
                callbacks={"tries": lambda ud: ud.tries + 1},
                input_keys=["tries"],
                output_keys=["tries"],
            ),
            transitions={"succeeded": "DECIDE"},
        )

        # main.yml:21
        smach.StateMachine.add(
            "DECIDE",
            ConditionalOutcomeState(
                outcomes=["again", "enough"],
                callbacks={"again": lambda ud: ud.tries < 3},
                default_outcome="enough",
                input_keys=["tries"],
            ),
            transitions={"again": "TRY", "enough": "aborted"},
        )
    return three_tries


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
    three_tries = build()
    if __name__ == "__main__":
        stop_at_signals(three_tries.request_preempt)
    return three_tries.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(128 + stop_signals[0] if stop_signals else outcome is None)
