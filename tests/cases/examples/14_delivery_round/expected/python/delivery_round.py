# Made by smachac 0.1.0 from main.yml (sha256 205e7c6b3d0fea7c).
"""The state machine `delivery_round`."""

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


class PrintUserdataState(smach.State):
    """Prints the input keys and their values, one key per line."""

    def __init__(self, input_keys=()):
        super().__init__(outcomes=["succeeded"], input_keys=list(input_keys))
        self.printed_keys = sorted(input_keys)

    def execute(self, userdata):
        for key in self.printed_keys:
            print(f"{key}: {userdata[key]}")
        return "succeeded"


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


def build():
    """Build the state machine `delivery_round`."""
    # main.yml:2
    delivery_round = stoppable_again(
        smach.StateMachine(outcomes=["done", "aborted", "preempted"]),
    )
    delivery_round.userdata.rooms = [12, 14, 17]
    delivery_round.userdata.failed_rooms = 0
    with delivery_round:
        # main.yml:10
        sm_check_robot = stoppable(
            smach.Concurrence(
                outcomes=["ready", "not_ready"],
                default_outcome="not_ready",
                outcome_map={
                    "ready": {
                        "CHECK_BATTERY": "charged",
                        "CHECK_LASER": "succeeded",
                        "CHECK_DRAWERS": "locked",
                    },
                },
            ),
        )
        with sm_check_robot:
            # main.yml:18
            smach.Concurrence.add(
                "CHECK_BATTERY",
                ScriptedState(outcomes=["charged", "low"]),
            )

            # main.yml:19
            smach.Concurrence.add("CHECK_LASER", SleepState(time=0.01))

            # main.yml:20
            smach.Concurrence.add(
                "CHECK_DRAWERS",
                ScriptedState(outcomes=["locked", "open"]),
            )

        smach.StateMachine.add(
            "CHECK_ROBOT",
            sm_check_robot,
            transitions={"ready": "FETCH", "not_ready": "CALL_OPERATOR"},
        )

        # main.yml:22
        smach.StateMachine.add(
            "FETCH",
            build_hand_over(time=7200.0),
            transitions={
                "done": "VISIT_ROOMS",
                "nobody": "CALL_OPERATOR",
                "preempted": "preempted",
            },
        )

        # main.yml:27
        sm_visit_rooms = stoppable(
            smach.Iterator(
                outcomes=["visited", "stuck", "preempted"],
                it=lambda: sm_visit_rooms.userdata["rooms"],
                it_label="room",
                exhausted_outcome="exhausted",
                input_keys=["failed_rooms", "rooms"],
                output_keys=["failed_rooms"],
            ),
        )
        with sm_visit_rooms:
            # main.yml:27
            sm_visit_rooms_2 = stoppable_again(
                smach.StateMachine(
                    outcomes=["visited", "stuck", "preempted"],
                    input_keys=["room", "failed_rooms"],
                    output_keys=["failed_rooms"],
                ),
            )
            with sm_visit_rooms_2:
                # main.yml:35
                smach.StateMachine.add(
                    "PLAN_PATH",
                    PrintUserdataState(input_keys=["room"]),
                    transitions={"succeeded": "DRIVE"},
                )

                # main.yml:39
                smach.StateMachine.add(
                    "DRIVE",
                    ends_preempted(build_drive()),
                    transitions={
                        "arrived": "KNOCK",
                        "exhausted": "STEP_BACK",
                        "preempted": "preempted",
                    },
                )

                # main.yml:45
                smach.StateMachine.add(
                    "KNOCK",
                    SleepState(time=0.01),
                    transitions={"succeeded": "HAND_OVER", "preempted": "preempted"},
                )

                # main.yml:49
                smach.StateMachine.add(
                    "HAND_OVER",
                    build_hand_over(time=90.0),
                    transitions={
                        "done": "visited",
                        "nobody": "NOTE_ABSENCE",
                        "preempted": "preempted",
                    },
                )

                # main.yml:53
                smach.StateMachine.add(
                    "NOTE_ABSENCE",
                    CallbacksState(
                        callbacks={"failed_rooms": lambda ud: ud.failed_rooms + 1},
                        input_keys=["failed_rooms"],
                        output_keys=["failed_rooms"],
                    ),
                    transitions={"succeeded": "visited"},
                )

                # main.yml:59
                smach.StateMachine.add(
                    "STEP_BACK",
                    ScriptedState(outcomes=["free", "jammed"]),
                    transitions={"free": "NOTE_ABSENCE", "jammed": "stuck"},
                )

            smach.Iterator.set_contained_state(
                "VISIT_ROOMS",
                sm_visit_rooms_2,
                loop_outcomes=["visited"],
                final_outcome_map={"exhausted": "visited", "visited": "preempted"},
            )

        smach.StateMachine.add(
            "VISIT_ROOMS",
            ends_preempted(sm_visit_rooms),
            transitions={
                "visited": "GO_HOME",
                "stuck": "CALL_OPERATOR",
                "preempted": "preempted",
                "exhausted": "GO_HOME",
            },
        )

        # main.yml:64
        sm_go_home = stoppable(
            smach.Iterator(
                outcomes=["arrived", "timeout", "preempted", "exhausted"],
                it=[1, 2, 3],
                it_label="attempt",
                exhausted_outcome="exhausted",
                input_keys=[],
                output_keys=[],
            ),
        )
        with sm_go_home:
            # main.yml:64
            sm_go_home_timed = stoppable(
                smach.Concurrence(
                    outcomes=["arrived", "blocked", "timeout", "preempted"],
                    default_outcome="timeout",
                    outcome_map={
                        "arrived": {"GO_HOME": "arrived", "TIMER": "preempted"},
                        "blocked": {"GO_HOME": "blocked", "TIMER": "preempted"},
                    },
                    child_termination_cb=lambda outcomes: True,
                ),
            )
            with sm_go_home_timed:
                # main.yml:64
                smach.Concurrence.add(
                    "GO_HOME",
                    ScriptedState(outcomes=["arrived", "blocked"]),
                )

                # main.yml:64
                smach.Concurrence.add("TIMER", SleepState(time=300.0))

            smach.Iterator.set_contained_state(
                "TIMED",
                ends_preempted(sm_go_home_timed),
                loop_outcomes=["blocked"],
                final_outcome_map={"blocked": "preempted"},
            )

        smach.StateMachine.add(
            "GO_HOME",
            ends_preempted(sm_go_home),
            transitions={
                "arrived": "DOCK",
                "timeout": "CALL_OPERATOR",
                "exhausted": "CALL_OPERATOR",
                "preempted": "preempted",
            },
        )

        # main.yml:71
        sm_dock = stoppable(
            smach.Iterator(
                outcomes=["docked", "exhausted", "preempted"],
                it=[0.0, 0.01, 0.01, 0.01, 0.01],
                it_label="pause",
                exhausted_outcome="exhausted",
                input_keys=[],
                output_keys=[],
            ),
        )
        with sm_dock:
            # main.yml:71
            sm_dock_try = smach.StateMachine(
                outcomes=["docked", "missed"],
                input_keys=["pause"],
            )
            with sm_dock_try:
                # main.yml:71
                smach.StateMachine.add(
                    "PAUSE",
                    SleepState(time=lambda ud: ud.pause, input_keys=["pause"]),
                    transitions={"succeeded": "DOCK", "preempted": "missed"},
                )

                # main.yml:71
                smach.StateMachine.add(
                    "DOCK",
                    ScriptedState(outcomes=["docked", "missed"]),
                    transitions={"docked": "docked", "missed": "missed"},
                )

            smach.Iterator.set_contained_state(
                "TRY",
                sm_dock_try,
                loop_outcomes=["missed"],
                final_outcome_map={"missed": "preempted"},
            )

        smach.StateMachine.add(
            "DOCK",
            ends_preempted(sm_dock),
            transitions={
                "docked": "CHARGE",
                "exhausted": "CALL_OPERATOR",
                "preempted": "preempted",
            },
        )

        # main.yml:76
        sm_charge = stoppable(
            smach.Concurrence(
                outcomes=["full", "no_current", "timeout", "preempted"],
                default_outcome="timeout",
                outcome_map={
                    "full": {"CHARGE": "full", "TIMER": "preempted"},
                    "no_current": {"CHARGE": "no_current", "TIMER": "preempted"},
                },
                child_termination_cb=lambda outcomes: True,
            ),
        )
        with sm_charge:
            # main.yml:76
            smach.Concurrence.add(
                "CHARGE",
                ScriptedState(outcomes=["full", "no_current"]),
            )

            # main.yml:76
            smach.Concurrence.add("TIMER", SleepState(time=7200.0))

        smach.StateMachine.add(
            "CHARGE",
            ends_preempted(sm_charge),
            transitions={
                "full": "done",
                "no_current": "DOCK_AGAIN",
                "timeout": "CALL_OPERATOR",
                "preempted": "preempted",
            },
        )

        # main.yml:82
        smach.StateMachine.add(
            "DOCK_AGAIN",
            ScriptedState(outcomes=["docked", "missed"]),
            transitions={"docked": "done", "missed": "CALL_OPERATOR"},
        )

        # main.yml:86
        smach.StateMachine.add(
            "CALL_OPERATOR",
            PrintUserdataState(input_keys=["failed_rooms"]),
            transitions={"succeeded": "aborted"},
        )
    return delivery_round


def build_hand_over(time):
    """Build the state machine of `hand_over.yml`."""
    sm_hand_over = stoppable_again(
        smach.StateMachine(outcomes=["done", "nobody", "preempted"]),
    )
    with sm_hand_over:
        # hand_over.yml:6
        sm_open_drawer = stoppable(
            smach.Iterator(
                outcomes=["open", "exhausted", "preempted"],
                it=[1, 2],
                it_label="attempt",
                exhausted_outcome="exhausted",
                input_keys=[],
                output_keys=[],
            ),
        )
        with sm_open_drawer:
            # hand_over.yml:6
            smach.Iterator.set_contained_state(
                "OPEN_DRAWER",
                ScriptedState(outcomes=["open", "jammed"]),
                loop_outcomes=["jammed"],
                final_outcome_map={"jammed": "preempted"},
            )

        smach.StateMachine.add(
            "OPEN_DRAWER",
            ends_preempted(sm_open_drawer),
            transitions={
                "open": "WAIT_FOR_PERSON",
                "exhausted": "nobody",
                "preempted": "preempted",
            },
        )

        # hand_over.yml:11
        sm_wait_for_person = stoppable(
            smach.Concurrence(
                outcomes=["pressed", "timeout", "preempted"],
                default_outcome="timeout",
                outcome_map={
                    "pressed": {"WAIT_FOR_PERSON": "pressed", "TIMER": "preempted"},
                },
                child_termination_cb=lambda outcomes: True,
            ),
        )
        with sm_wait_for_person:
            # hand_over.yml:11
            smach.Concurrence.add(
                "WAIT_FOR_PERSON",
                ScriptedState(outcomes=["pressed"]),
            )

            # hand_over.yml:11
            smach.Concurrence.add("TIMER", SleepState(time=time))

        smach.StateMachine.add(
            "WAIT_FOR_PERSON",
            ends_preempted(sm_wait_for_person),
            transitions={
                "pressed": "CLOSE_DRAWER",
                "timeout": "GIVE_UP",
                "preempted": "preempted",
            },
        )

        # hand_over.yml:16
        smach.StateMachine.add(
            "CLOSE_DRAWER",
            ScriptedState(outcomes=["closed"]),
            transitions={"closed": "done"},
        )

        # hand_over.yml:20
        smach.StateMachine.add(
            "GIVE_UP",
            ScriptedState(outcomes=["closed"]),
            transitions={"closed": "nobody"},
        )
    return sm_hand_over


def build_drive():
    """Build the iterator `DRIVE`."""
    sm_drive = stoppable(
        smach.Iterator(
            outcomes=["arrived", "preempted", "exhausted"],
            it=[0.0, 0.01, 0.01],
            it_label="pause",
            exhausted_outcome="exhausted",
            input_keys=[],
            output_keys=[],
        ),
    )
    with sm_drive:
        # main.yml:39
        sm_drive_try = stoppable_again(
            smach.StateMachine(
                outcomes=["arrived", "blocked", "timeout", "preempted"],
                input_keys=["pause"],
            ),
        )
        with sm_drive_try:
            # main.yml:39
            smach.StateMachine.add(
                "PAUSE",
                SleepState(time=lambda ud: ud.pause, input_keys=["pause"]),
                transitions={"succeeded": "TIMED", "preempted": "preempted"},
            )

            # main.yml:39
            sm_drive_timed = stoppable(
                smach.Concurrence(
                    outcomes=["arrived", "blocked", "timeout", "preempted"],
                    default_outcome="timeout",
                    outcome_map={
                        "arrived": {"DRIVE": "arrived", "TIMER": "preempted"},
                        "blocked": {"DRIVE": "blocked", "TIMER": "preempted"},
                    },
                    child_termination_cb=lambda outcomes: True,
                ),
            )
            with sm_drive_timed:
                # main.yml:39
                smach.Concurrence.add(
                    "DRIVE",
                    ScriptedState(outcomes=["arrived", "blocked"]),
                )

                # main.yml:39
                smach.Concurrence.add("TIMER", SleepState(time=300.0))

            smach.StateMachine.add(
                "TIMED",
                ends_preempted(sm_drive_timed),
                transitions={
                    "arrived": "arrived",
                    "blocked": "blocked",
                    "timeout": "timeout",
                    "preempted": "preempted",
                },
            )

        smach.Iterator.set_contained_state(
            "TRY",
            sm_drive_try,
            loop_outcomes=["blocked", "timeout"],
            final_outcome_map={"blocked": "preempted", "timeout": "preempted"},
        )
    return sm_drive


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
    delivery_round = build()
    if __name__ == "__main__":
        stop_at_signals(delivery_round.request_preempt)
    return delivery_round.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(128 + stop_signals[0] if stop_signals else outcome is None)
