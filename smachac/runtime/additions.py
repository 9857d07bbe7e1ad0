"""What generated programs use beside SMACH itself: time limits, retries, and requests to stop that
reach every state.

The functions work on SMACH, if it is installed, and on the bundled runtime. A program that is built
with `--option standalone=true` contains the text of those that it uses, so that each of them uses
only names of this module, of `smach` and of the standard library.
"""

from __future__ import annotations

import threading
import traceback
from typing import Any

from smachac.runtime.installed import smach


class SleepState(smach.State):
    """Waits for `time` seconds: a number, or a function of the userdata.

    A preempt request ends the wait.
    """

    def __init__(
        self, time: Any, input_keys: Any = (), outcomes: Any = ("succeeded", "preempted")
    ) -> None:
        super().__init__(outcomes=list(outcomes), input_keys=list(input_keys))
        self.time = time
        self.end_of_wait = threading.Event()

    def request_preempt(self) -> None:
        super().request_preempt()
        self.end_of_wait.set()

    def execute(self, userdata: Any) -> str:
        seconds: Any = self.time(userdata) if callable(self.time) else self.time
        self.end_of_wait.wait(seconds)
        self.end_of_wait.clear()
        if self.preempt_requested() and "preempted" in self.get_registered_outcomes():
            self.service_preempt()
            return "preempted"
        return "succeeded"


def native_state(state: Any, outcomes: Any, input_keys: Any = (), output_keys: Any = ()) -> Any:
    """Put a state of YASMIN or FlexBE into a machine of SMACH, which cannot run it: the containers
    of that framework do. Its outcomes and keys are those of the script."""
    made = smach.State(list(outcomes), list(input_keys), list(output_keys))
    made.native = state
    return made


def with_timeout(state: Any, seconds: Any, label: str = "STATE") -> Any:
    """Give a state a time limit: it ends with `timeout` if it is not done after so many seconds.

    The result is a concurrence of the state, which has the label there, and a timer.
    """
    outcomes = sorted(state.get_registered_outcomes())
    limited = smach.Concurrence(
        outcomes=sorted({*outcomes, "timeout", "preempted"}),
        default_outcome="timeout",
        input_keys=sorted(state.get_registered_input_keys()),
        output_keys=sorted(state.get_registered_output_keys()),
        outcome_map={name: {label: name, "TIMER": "preempted"} for name in outcomes},
        child_termination_cb=lambda outcomes: True,
    )
    with limited:
        smach.Concurrence.add(label, state)
        smach.Concurrence.add("TIMER", SleepState(seconds))
    return ends_preempted(limited)


def with_retries(state: Any, tries: int, on: Any, delay: Any = None, label: str = "STATE") -> Any:
    """Run a state again, at most `tries` times in all, while it ends with an outcome of `on`.

    After the last try it ends with `exhausted`. `delay` is the pause before a new try, in seconds.
    The result is an iterator, in which the state has the label.
    """
    outcomes = sorted(state.get_registered_outcomes())
    inputs = sorted(state.get_registered_input_keys())
    outputs = sorted(state.get_registered_output_keys())
    name, item, items = label, "attempt", list(range(1, tries + 1))
    if delay is not None:
        name, item, items = "TRY", "pause", [0.0] + [delay] * (tries - 1)
    while item in inputs + outputs:  # it would hide a key of the state
        item += "_"
    if delay is not None:
        attempt = smach.StateMachine(
            outcomes=outcomes, input_keys=[*inputs, item], output_keys=outputs
        )
        stopped = next(end for end in ["preempted", *on] if end in outcomes)
        with attempt:
            smach.StateMachine.add(
                "PAUSE",
                SleepState(lambda userdata: userdata[item], input_keys=[item]),
                transitions={"succeeded": label, "preempted": stopped},
            )
            smach.StateMachine.add(label, state, transitions={end: end for end in outcomes})
        state = attempt
    loop = smach.Iterator(
        outcomes=sorted({*outcomes, "exhausted", "preempted"}.difference(on)),
        input_keys=inputs,
        output_keys=outputs,
        it=items,
        it_label=item,
        exhausted_outcome="exhausted",
    )
    with loop:
        smach.Iterator.set_contained_state(
            name,
            state,
            loop_outcomes=list(on),
            final_outcome_map=dict.fromkeys(on, "preempted"),
        )
    return ends_preempted(loop)


def ends_preempted(container: Any) -> Any:
    """Let a time limit or loop end as preempted after a request to stop."""
    pass_on_stop_requests(container)
    run, request = container.execute, container.request_preempt
    recall = container.recall_preempt

    def request_preempt() -> None:
        container.stopped = True
        request()

    def recall_preempt() -> None:
        container.stopped = False
        recall()

    def execute(*userdata: Any) -> Any:
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


def pass_on_stop_requests(machine: Any) -> None:
    """Let a container, and those in it, pass on every request to stop: SMACH loses one that comes
    before a loop or concurrence runs, and a second one."""
    if not getattr(smach, "compat", True):  # the bundled runtime passes them on
        return
    machines = (smach.StateMachine, smach.Sequence)
    waiting = [machine]
    while waiting:
        container = waiting.pop()
        if type(container) not in (*machines, smach.Concurrence, smach.Iterator):
            continue  # a state, or a container of a class of the user
        waiting += container.get_children().values()
        if hasattr(container, "passes_on"):
            continue
        container.passes_on = True
        if type(container) in machines:
            pass_on_second_request(container)
        else:
            pass_on_each_request(container)


def pass_on_each_request(container: Any) -> None:
    """Let a concurrence or iterator pass on each request, also one that comes before it runs."""
    run, request = container.execute, container.request_preempt
    children = container.get_children
    concurrent = isinstance(container, smach.Concurrence)
    container.busy = container.asked = False

    def pass_on() -> None:
        for label in container.get_active_states() or list(children()):
            child = children().get(label)
            again = hasattr(child, "get_children")
            if child and (again or not child.preempt_requested()):
                child.request_preempt()

    def request_preempt() -> None:
        if not container.busy:
            request()
            return
        container.asked = True
        if not concurrent:
            smach.State.request_preempt(container)
        pass_on()

    def execute(*userdata: Any) -> Any:
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

        def ends_others(outcomes: Any) -> Any:
            return not container.asked and ends(outcomes)

        container._child_termination_cb = ends_others
    container.execute, container.request_preempt = execute, request_preempt


def pass_on_second_request(machine: Any) -> None:
    """Let a machine pass on a second request while the same container in it runs."""
    request, children = machine.request_preempt, machine.get_children

    def request_preempt() -> None:
        again = machine.preempt_requested() and getattr(smach, "compat", True)
        request()
        for label in machine.get_active_states() if again else ():
            if hasattr(children().get(label), "get_children"):
                children()[label].request_preempt()

    machine.request_preempt = request_preempt


def withdraw(state: Any) -> None:
    """Take back the unanswered requests to stop of a state and of the states inside."""
    if state.preempt_requested():
        state.recall_preempt()
        for child in getattr(state, "get_children", dict)().values():
            withdraw(child)


def error_as_outcome(state: Any, outcome: str) -> Any:
    """Let a state end with an outcome where it would raise an exception, which is logged."""
    pass_on_stop_requests(state)

    def attempt(*userdata: Any) -> Any:
        try:
            return state.attempted(*userdata)
        except Exception as error:
            smach.logerr(traceback.format_exc(chain=False))
            state.caught = error
            return outcome

    state.attempted, state.execute = state.execute, attempt
    state.caught = None
    state.register_outcomes([outcome])
    return state


def with_callbacks(state: Any, callbacks: Any) -> Any:
    """Let a state first call functions of its userdata, each for the key of its name."""

    def call_and_execute(userdata: Any) -> Any:
        for key in sorted(callbacks):
            function = callbacks[key]
            if not smach.has_smach_interface(function):
                userdata[key] = function(userdata)
            else:  # it writes its keys itself
                inputs = function.get_registered_input_keys()
                outputs = function.get_registered_output_keys()
                function(smach.Remapper(userdata, inputs, outputs, {}))
        return execute(userdata)

    execute, state.execute = state.execute, call_and_execute
    return state
