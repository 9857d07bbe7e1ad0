# Made by smachac 0.1.0 from main.yml (sha256 20f3bf8389600712).
"""The state machine `tour`."""

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


def ends_preempted(container):
    """Let a time limit or loop end as preempted after a request to stop."""
    run, request = container.execute, container.request_preempt
    recall = container.recall_preempt

    def request_preempt():
        container.stopped = True
        request()

    def recall_preempt():
        container.stopped = False
        recall()

    def execute(*userdata):
        container.stopped = container.stopped or container.preempt_requested()
        try:
            outcome = run(*userdata)
            if container.stopped:
                container.service_preempt()
                outcome = "preempted"
            return outcome
        finally:
            container.stopped = False

    container.execute, container.stopped = execute, False
    container.request_preempt = request_preempt
    container.recall_preempt = recall_preempt
    return container


class SleepState(smach.State):
    """Waits for `time` seconds: a number, or a function of the userdata.

    A preempt request ends the wait.
    """

    def __init__(self, time, input_keys=(), outcomes=("succeeded", "preempted")):
        super().__init__(
            outcomes=list(outcomes),
            input_keys=list(input_keys),
        )
        self.time = time
        self.end_of_wait = threading.Event()

    def request_preempt(self):
        super().request_preempt()
        self.end_of_wait.set()

    def execute(self, userdata):
        self.end_of_wait.wait(self.time(userdata) if callable(self.time) else self.time)
        self.end_of_wait.clear()
        if self.preempt_requested() and "preempted" in self.get_registered_outcomes():
            self.service_preempt()
            return "preempted"
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
    """Build the state machine `tour`."""
    # main.yml:1
    tour = stoppable_again(smach.StateMachine(outcomes=["done", "failed", "stopped"]))
    tour.userdata.waypoints = [1, 2, 3]
    tour.userdata.count = 0
    with tour:
        # main.yml:6
        smach.StateMachine.add(
            "LOOK",
            ends_preempted(build_look()),
            transitions={
                "succeeded": "VISIT",
                "exhausted": "failed",
                "preempted": "stopped",
            },
        )

        # main.yml:13
        sm_visit = stoppable(
            smach.Iterator(
                outcomes=["succeeded", "preempted"],
                it=lambda: sm_visit.userdata["waypoints"],
                it_label="goal",
                exhausted_outcome="exhausted",
                input_keys=["total", "waypoints"],
                output_keys=["total"],
            ),
        )
        with sm_visit:
            # main.yml:13
            smach.Iterator.set_contained_state(
                "VISIT",
                CallbacksState(
                    callbacks={"total": lambda ud: ud.total + ud.goal},
                    input_keys=["goal", "total"],
                    output_keys=["total"],
                ),
                loop_outcomes=["succeeded"],
                final_outcome_map={"exhausted": "succeeded", "succeeded": "preempted"},
            )

        smach.StateMachine.add(
            "VISIT",
            ends_preempted(sm_visit),
            transitions={
                "succeeded": "HASTE",
                "preempted": "stopped",
                "exhausted": "HASTE",
            },
            remapping={"total": "count"},
        )

        # main.yml:21
        # It takes longer than it may.
        sm_haste = stoppable(
            smach.Concurrence(
                outcomes=["succeeded", "preempted", "timeout"],
                default_outcome="timeout",
                outcome_map={
                    "succeeded": {"HASTE": "succeeded", "TIMER": "preempted"},
                    "preempted": {"HASTE": "preempted", "TIMER": "preempted"},
                },
                child_termination_cb=lambda outcomes: True,
            ),
        )
        with sm_haste:
            # main.yml:21
            smach.Concurrence.add("HASTE", SleepState(time=60))

            # main.yml:21
            smach.Concurrence.add("TIMER", SleepState(time=0.05))

        smach.StateMachine.add(
            "HASTE",
            ends_preempted(sm_haste),
            transitions={
                "timeout": "TRIES",
                "succeeded": "failed",
                "preempted": "stopped",
            },
        )

        # main.yml:27
        sm_tries = stoppable(
            smach.Iterator(
                outcomes=["good", "exhausted", "preempted"],
                it=[1, 2],
                it_label="attempt",
                exhausted_outcome="exhausted",
                input_keys=[],
                output_keys=[],
            ),
        )
        with sm_tries:
            # main.yml:27
            sm_tries_2 = smach.StateMachine(outcomes=["again", "good"])
            with sm_tries_2:
                # main.yml:32
                smach.StateMachine.add(
                    "HOPE",
                    ScriptedState(outcomes=["again"]),
                    transitions={"again": "again"},
                )

            smach.Iterator.set_contained_state(
                "TRIES",
                sm_tries_2,
                loop_outcomes=["again"],
                final_outcome_map={"again": "preempted"},
            )

        smach.StateMachine.add(
            "TRIES",
            ends_preempted(sm_tries),
            transitions={
                "good": "failed",
                "exhausted": "WITHOUT",
                "preempted": "stopped",
            },
        )

        # main.yml:36
        sm_without = stoppable(
            smach.Iterator(
                outcomes=["succeeded", "preempted"],
                it=[],
                it_label="unused",
                exhausted_outcome="exhausted",
                input_keys=[],
                output_keys=[],
            ),
        )
        with sm_without:
            # main.yml:36
            smach.Iterator.set_contained_state(
                "WITHOUT",
                SleepState(time=0.01),
                loop_outcomes=["succeeded"],
                final_outcome_map={"exhausted": "succeeded", "succeeded": "preempted"},
            )

        smach.StateMachine.add(
            "WITHOUT",
            ends_preempted(sm_without),
            transitions={
                "succeeded": "EACH",
                "preempted": "stopped",
                "exhausted": "EACH",
            },
        )

        # main.yml:41
        sm_each = stoppable(
            smach.Iterator(
                outcomes=["found", "preempted", "exhausted"],
                it=["a", "b"],
                it_label="unused",
                exhausted_outcome="exhausted_2",
                input_keys=[],
                output_keys=[],
            ),
        )
        with sm_each:
            # main.yml:41
            sm_each_tries = stoppable(
                smach.Iterator(
                    outcomes=["found", "preempted", "exhausted"],
                    it=[1, 2],
                    it_label="attempt",
                    exhausted_outcome="exhausted",
                    input_keys=[],
                    output_keys=[],
                ),
            )
            with sm_each_tries:
                # main.yml:41
                smach.Iterator.set_contained_state(
                    "EACH",
                    ScriptedState(
                        outcomes=["found", "lost", "preempted"],
                        steps=[
                            {"outcome": "lost"},
                            {"outcome": "lost"},
                            {"outcome": "found"},
                        ],
                    ),
                    loop_outcomes=["lost"],
                    final_outcome_map={"lost": "preempted"},
                )

            smach.Iterator.set_contained_state(
                "TRIES",
                ends_preempted(sm_each_tries),
                loop_outcomes=["exhausted"],
                final_outcome_map={
                    "exhausted_2": "exhausted",
                    "exhausted": "preempted",
                },
            )

        smach.StateMachine.add(
            "EACH",
            ends_preempted(sm_each),
            transitions={
                "found": "SHOW",
                "exhausted": "failed",
                "preempted": "stopped",
                "exhausted_2": "failed",
            },
        )

        # main.yml:48
        smach.StateMachine.add(
            "SHOW",
            PrintUserdataState(input_keys=["count"]),
            transitions={"succeeded": "done"},
        )
    return tour


def build_look():
    """Build the iterator `LOOK`."""
    sm_look = stoppable(
        smach.Iterator(
            outcomes=["succeeded", "preempted", "exhausted"],
            it=[0.0, 0.1, 0.1],
            it_label="pause",
            exhausted_outcome="exhausted",
            input_keys=[],
            output_keys=[],
        ),
    )
    with sm_look:
        # main.yml:6
        sm_look_try = stoppable_again(
            smach.StateMachine(
                outcomes=["succeeded", "aborted", "preempted", "timeout"],
                input_keys=["pause"],
            ),
        )
        with sm_look_try:
            # main.yml:6
            smach.StateMachine.add(
                "PAUSE",
                SleepState(time=lambda ud: ud.pause, input_keys=["pause"]),
                transitions={"succeeded": "TIMED", "preempted": "preempted"},
            )

            # main.yml:6
            sm_look_timed = stoppable(
                smach.Concurrence(
                    outcomes=["succeeded", "aborted", "preempted", "timeout"],
                    default_outcome="timeout",
                    outcome_map={
                        "succeeded": {"LOOK": "succeeded", "TIMER": "preempted"},
                        "aborted": {"LOOK": "aborted", "TIMER": "preempted"},
                        "preempted": {"LOOK": "preempted", "TIMER": "preempted"},
                    },
                    child_termination_cb=lambda outcomes: True,
                ),
            )
            with sm_look_timed:
                # main.yml:6
                smach.Concurrence.add(
                    "LOOK",
                    ScriptedState(
                        outcomes=["succeeded", "aborted", "preempted"],
                        steps=[{"outcome": "aborted"}, {"outcome": "succeeded"}],
                    ),
                )

                # main.yml:6
                smach.Concurrence.add("TIMER", SleepState(time=20.0))

            smach.StateMachine.add(
                "TIMED",
                ends_preempted(sm_look_timed),
                transitions={
                    "succeeded": "succeeded",
                    "aborted": "aborted",
                    "preempted": "preempted",
                    "timeout": "timeout",
                },
            )

        smach.Iterator.set_contained_state(
            "TRY",
            sm_look_try,
            loop_outcomes=["aborted", "timeout"],
            final_outcome_map={"aborted": "preempted", "timeout": "preempted"},
        )
    return sm_look


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
    tour = build()
    if __name__ == "__main__":
        stop_at_signals(tour.request_preempt)
    return tour.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(128 + stop_signals[0] if stop_signals else outcome is None)
