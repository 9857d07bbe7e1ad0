"""The threads of concurrences: rules N4, N13, N15, P8, P10, and none left behind."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import pytest

from smachac.runtime import smach


class Branch(smach.State):
    """Does something, waits for a preempt request if it is to, and answers it if it is to."""

    def __init__(
        self,
        do: Callable[[], object] = lambda: None,
        waits: bool = False,
        answers: bool = True,
    ) -> None:
        super().__init__(["done", "preempted"])
        self.do, self.waits, self.answers = do, waits, answers
        self.told = threading.Semaphore(0)
        self.flags: list[bool] = []
        self.requests = 0

    def request_preempt(self) -> None:
        super().request_preempt()
        self.requests += 1
        self.told.release()

    def execute(self, ud: Any, /) -> str:
        self.flags.append(self.preempt_requested())
        self.do()
        if self.waits:
            assert self.told.acquire(timeout=10), "no preempt request came"
        if self.answers and self.preempt_requested():
            self.service_preempt()
            return "preempted"
        return "done"


def branches_alive() -> list[threading.Thread]:
    """The threads of concurrences that exist now."""
    return [thread for thread in threading.enumerate() if thread.name.startswith("branch ")]


def concurrence(*branches: smach.State, **policy: Any) -> smach.Concurrence:
    """A concurrence that ends with `preempted` when all its branches did, else with `mixed`."""
    labels = [f"B{n}" for n in range(len(branches))]
    rule = {"preempted": dict.fromkeys(labels, "preempted")}
    container = smach.Concurrence(["preempted", "mixed"], "mixed", outcome_map=rule, **policy)
    with container:
        for label, branch in zip(labels, branches, strict=True):
            smach.Concurrence.add(label, branch)
    return container


def test_a_request_reaches_all_that_run() -> None:
    asking = Branch(lambda: container.request_preempt(), waits=True)
    other = Branch(waits=True)
    container = concurrence(asking, other)
    assert container.execute() == "preempted"
    assert (asking.requests, other.requests) == (1, 1)
    assert not container.preempt_requested()


@pytest.mark.parametrize("nested", [False, True])
def test_a_request_before_the_run_reaches_all(nested: bool) -> None:
    branches = [Branch(waits=True), Branch(waits=True)]
    container: Any = concurrence(*branches)
    if nested:
        inner, container = container, smach.StateMachine(["preempted", "mixed"])
        with container:
            smach.StateMachine.add("C", inner)
    container.request_preempt()
    assert container.execute() == "preempted"
    assert [branch.flags for branch in branches] == [[True], [True]]
    assert not container.preempt_requested()


def test_a_request_from_the_start_callback_is_not_lost() -> None:
    container = concurrence(Branch(waits=True))
    container.register_start_cb(lambda *args: container.request_preempt())
    assert container.execute() == "preempted"


def test_an_ignored_request_stays_with_the_container_only() -> None:
    branch = Branch(waits=True, answers=False)
    container = concurrence(branch)
    container.request_preempt()
    assert container.execute() == "mixed"
    assert container.preempt_requested()
    assert not branch.preempt_requested()


def test_a_second_request_after_an_answer_is_passed_on() -> None:
    def ask_twice() -> None:
        container.request_preempt()
        assert branch.told.acquire(timeout=10)
        branch.service_preempt()
        container.request_preempt()

    branch = Branch(ask_twice, waits=True)
    container = concurrence(branch)
    assert container.execute() == "preempted"
    assert branch.requests == 2


def test_the_first_true_callback_ends_all_others_once() -> None:
    quick, slow = Branch(), Branch(waits=True)
    container = concurrence(quick, slow, child_termination_cb=lambda outcomes: True)
    assert container.execute() == "mixed"
    assert (quick.requests, slow.requests) == (0, 1)


def test_an_early_end_leaves_no_request_behind() -> None:
    leaf = Branch(waits=True, answers=False)
    deep = smach.StateMachine(["done", "preempted"])
    with deep:
        smach.StateMachine.add("LEAF", leaf)
    container = concurrence(Branch(), deep, child_termination_cb=lambda outcomes: True)
    container.execute()
    assert leaf.requests == 1
    assert not leaf.preempt_requested()
    assert not deep.preempt_requested()


def test_a_child_whose_request_raises_does_not_keep_the_others_from_hearing() -> None:
    class Deaf(Branch):
        def request_preempt(self) -> None:
            raise RuntimeError

    asking = Branch(lambda: container.request_preempt())
    container = concurrence(Deaf(), Branch(waits=True), asking)
    assert container.execute() == "mixed"


def test_shutdown_ends_the_children_and_waits_for_them(monkeypatch: pytest.MonkeyPatch) -> None:
    down = threading.Event()
    monkeypatch.setattr(smach, "is_shutdown", down.is_set)
    slow = Branch(waits=True)
    stopped = smach.StateMachine(["preempted"])
    with stopped:
        smach.StateMachine.add("A", Branch(down.set), {"done": "A"})
    container = concurrence(slow, stopped)
    assert container.execute() == "mixed"
    assert slow.requests == 1
    assert not branches_alive()


def test_an_interrupt_of_the_container_ends_the_children(monkeypatch: pytest.MonkeyPatch) -> None:
    slow = Branch(waits=True)
    container = concurrence(slow)

    def interrupted() -> bool:
        raise KeyboardInterrupt

    monkeypatch.setattr(smach, "is_shutdown", interrupted)
    with pytest.raises(KeyboardInterrupt):
        container.execute()
    assert slow.requests == 1
    assert not branches_alive()
    assert not container.is_running()


def test_a_thread_that_cannot_start_leaves_none_behind(monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[threading.Thread] = []
    start = threading.Thread.start

    def limited(thread: threading.Thread) -> None:
        if len(started) == 2:
            raise RuntimeError("can't start new thread")
        started.append(thread)
        start(thread)

    monkeypatch.setattr(threading.Thread, "start", limited)
    branches = [Branch(), Branch(), Branch()]
    with pytest.raises(RuntimeError):
        concurrence(*branches).execute()
    assert len(started) == 2
    assert not any(thread.is_alive() for thread in started)
    assert all(branch.flags == [] and branch.requests == 0 for branch in branches)
