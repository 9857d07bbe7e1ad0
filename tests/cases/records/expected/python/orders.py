# Made by smachac 0.1.0 from main.yml (sha256 36f306daa806a188).
"""Fetches each ordered part from its shelf."""

import os
import signal
import socket
import threading

try:
    import smach
except ImportError:  # without SMACH: smachac.runtime has the same names
    from smachac.runtime import smach


def withdraw(state):
    """Take back the unanswered stop requests of a state and of the states inside."""
    if state.preempt_requested():
        state.recall_preempt()
        for child in getattr(state, "get_children", dict)().values():
            withdraw(child)


def stoppable(container):
    """Let a container pass on every stop request, also an early one and a second one."""
    if not getattr(smach, "compat", True):  # the bundled runtime does so itself
        return container
    run, request = container.execute, container.request_preempt
    children = container.get_children
    concurrent = isinstance(container, smach.Concurrence)
    container.busy = container.asked = False

    def pass_on():
        for label in container.get_active_states() or list(children()):
            child = children().get(label)
            again = hasattr(child, "get_children")
            if child and (again or not child.preempt_requested()):
                child.request_preempt()

    def request_preempt():
        if not container.busy:
            return request()
        container.asked = True
        if not concurrent:
            smach.State.request_preempt(container)
        pass_on()

    def execute(*userdata):
        container.busy, container.asked = True, container.preempt_requested()
        if container.asked:
            pass_on()
        if concurrent:  # with its own request, SMACH for ROS 1 ends as preempted
            container.service_preempt()
        unanswered = True
        try:
            outcome = run(*userdata)
            unanswered = any(child.preempt_requested() for child in children().values())
            return outcome
        finally:
            container.busy = False
            for child in children().values():
                withdraw(child)
            if concurrent and container.asked and unanswered:
                request()

    if concurrent and container._child_termination_cb:
        ends = container._child_termination_cb

        def ends_others(outcomes):
            return not container.asked and ends(outcomes)

        container._child_termination_cb = ends_others
    container.execute, container.request_preempt = execute, request_preempt
    return container


def stoppable_again(machine):
    """Let a machine pass on a second stop request while the same container in it runs."""
    request, children = machine.request_preempt, machine.get_children

    def request_preempt():
        again = machine.preempt_requested() and getattr(smach, "compat", True)
        request()
        for label in machine.get_active_states() if again else ():
            if hasattr(children().get(label), "get_children"):
                children()[label].request_preempt()

    machine.request_preempt = request_preempt
    return machine


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
    """Build the state machine `orders`."""
    # main.yml:2
    orders = stoppable_again(smach.StateMachine(outcomes=["done", "failed"]))
    orders.userdata.parts = [
        {"name": "bolt", "shelf": "left", "at": [0.5, 0.1, 0.2]},
        {"name": "nut", "shelf": "right"},
    ]
    orders.userdata.size = {"long side": 0.2, "count": 3}
    with orders:
        # main.yml:15
        sm_each = stoppable(
            smach.Iterator(
                outcomes=["done"],
                it=lambda: sm_each.userdata["parts"],
                it_label="part",
                exhausted_outcome="done",
                input_keys=["parts"],
                output_keys=[],
            ),
        )
        with sm_each:
            # main.yml:24
            smach.Iterator.set_contained_state(
                "SHELF",
                CallbacksState(
                    callbacks={
                        "shelf": lambda ud: ud.part["shelf"],
                        "label": lambda ud: ud.part["name"] + "_" + ud.part["shelf"],
                    },
                    input_keys=["part"],
                    output_keys=["shelf", "label"],
                ),
                loop_outcomes=["succeeded"],
            )

        smach.StateMachine.add("EACH", sm_each, transitions={"done": "MEASURE"})

        # main.yml:32
        smach.StateMachine.add(
            "MEASURE",
            ScriptedState(
                outcomes=["ok", "none"],
                steps=[
                    {"outcome": "ok", "set": {"seen": {"name": "bolt", "count": 2}}},
                ],
                input_keys=["size"],
                output_keys=["seen"],
            ),
            transitions={"ok": "SHOW", "none": "failed"},
        )

        # main.yml:39
        smach.StateMachine.add(
            "SHOW",
            PrintUserdataState(input_keys=["seen"]),
            transitions={"succeeded": "done"},
        )
    return orders


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
    orders = build()
    if __name__ == "__main__":
        stop_at_signals(orders.request_preempt)
    return orders.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(128 + stop_signals[0] if stop_signals else outcome is None)
