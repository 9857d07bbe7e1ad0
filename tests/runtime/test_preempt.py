"""Preemption of state machines: rules P1 to P6, and no request lost or doubled."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import pytest

from smachac.runtime import smach


class Worker(smach.State):
    """Answers a request with `preempted`; else does something and ends with `done`."""

    def __init__(self, do: Callable[[], object] = lambda: None, answers: bool = True) -> None:
        super().__init__(["done", "preempted"])
        self.do, self.answers = do, answers
        self.requests = 0

    def request_preempt(self) -> None:
        self.requests += 1
        super().request_preempt()

    def execute(self, ud: Any, /) -> str:
        self.do()
        if self.answers and self.preempt_requested():
            self.service_preempt()
            return "preempted"
        return "done"


def chain(*workers: Worker) -> smach.StateMachine:
    """A machine in which `done` leads on and `preempted` leads out."""
    machine = smach.StateMachine(["done", "preempted"])
    with machine:
        for n, worker in enumerate(workers):
            target = str(n + 1) if n + 1 < len(workers) else "done"
            smach.StateMachine.add(str(n), worker, {"done": target})
    return machine


def test_a_request_reaches_the_running_child_through_all_levels() -> None:
    worker = Worker(lambda: outer.request_preempt())
    inner = chain(worker)
    outer = smach.StateMachine(["done", "preempted"])
    with outer:
        smach.StateMachine.add("IN", inner)
    assert outer.execute() == "preempted"
    assert worker.requests == 1
    assert not any(s.preempt_requested() for s in (worker, inner, outer))


def test_a_request_before_the_run_reaches_the_first_child() -> None:
    first, second = Worker(), Worker()
    machine = chain(first, second)
    machine.request_preempt()
    assert first.requests == 0
    assert machine.execute() == "preempted"
    assert machine.execute() == "done"
    assert (first.requests, second.requests) == (1, 0)


def test_a_request_that_a_child_ignores_goes_on_to_the_next() -> None:
    first = Worker(lambda: machine.request_preempt(), answers=False)
    second = Worker()
    machine = chain(first, second)
    assert machine.execute() == "preempted"
    assert not first.preempt_requested()
    assert second.requests == 1


def test_a_second_request_after_the_first_was_answered_is_passed_on() -> None:
    def work() -> None:
        machine.request_preempt()
        machine.request_preempt()
        assert worker.requests == 1
        worker.service_preempt()
        machine.request_preempt()
        assert worker.requests == 2

    worker = Worker(work)
    machine = chain(worker, Worker())
    assert machine.execute() == "preempted"


@pytest.mark.parametrize("depth", [1, 2, 3, 4])
def test_a_second_request_reaches_what_runs_at_every_depth(depth: int) -> None:
    """The first state answers and leads to the next one; the machines around have not ended."""
    first = Worker(lambda: machine.request_preempt())
    second = Worker(lambda: machine.request_preempt())
    machine = smach.StateMachine(["done", "preempted"])
    with machine:
        smach.StateMachine.add("0", first, {"preempted": "1"})
        smach.StateMachine.add("1", second)
    for _ in range(depth):
        inner, machine = machine, smach.StateMachine(["done", "preempted"])
        with machine:
            smach.StateMachine.add("IN", inner)
    assert machine.execute() == "preempted"
    assert (first.requests, second.requests) == (1, 1)


@pytest.mark.parametrize("register", ["register_start_cb", "register_transition_cb"])
def test_callbacks_may_request_a_preempt(register: str) -> None:
    first, second = Worker(), Worker()
    machine = chain(first, second)
    getattr(machine, register)(lambda *args: machine.request_preempt())
    assert machine.execute() == "preempted"
    assert first.requests + second.requests == 1


def test_a_request_between_two_children_is_not_taken_for_the_answered_one() -> None:
    first, second = Worker(lambda: machine.request_preempt()), Worker()
    machine = smach.StateMachine(["done", "preempted"])
    with machine:
        smach.StateMachine.add("A", first, {"preempted": "B", "done": "done"})
        smach.StateMachine.add("B", second)
    machine.register_transition_cb(lambda *args: machine.request_preempt())
    assert machine.execute() == "preempted"
    assert (first.requests, second.requests) == (1, 1)


def test_a_termination_callback_may_request_a_preempt_of_the_next_run() -> None:
    machine = chain(Worker())
    machine.register_termination_cb(lambda *args: machine.request_preempt())
    assert machine.execute() == "done"
    assert machine.execute() == "preempted"


def test_an_idle_machine_keeps_the_request_to_itself() -> None:
    def fail() -> None:
        raise ValueError

    worker = Worker(fail)
    machine = chain(worker)
    with pytest.raises(smach.InvalidUserCodeError):
        machine.execute()
    machine.request_preempt()
    assert machine.preempt_requested()
    assert not worker.preempt_requested()


def test_a_request_that_raises_in_the_child_is_logged_only() -> None:
    class Broken(Worker):
        def request_preempt(self) -> None:
            raise RuntimeError

    machine = chain(Broken(lambda: machine.request_preempt()))
    assert machine.execute() == "done"


def test_a_request_from_another_thread_is_never_lost() -> None:
    for _ in range(100):
        started, budget = threading.Event(), iter(range(10**6))

        def work(budget: Any = budget, started: threading.Event = started) -> None:
            started.set()
            next(budget)

        ping, pong = Worker(work), Worker()
        inner = chain(ping, pong)
        outer = smach.StateMachine(["preempted"])
        with outer:
            smach.StateMachine.add("IN", inner, {"done": "IN"})

        def request(started: threading.Event = started, outer: Any = outer) -> None:
            started.wait(10)
            outer.request_preempt()

        thread = threading.Thread(target=request)
        thread.start()
        assert outer.execute() == "preempted"
        thread.join(10)
        assert not outer.preempt_requested()
