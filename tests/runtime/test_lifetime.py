"""What is left after a run: no thread, no memory, and no container that says that it runs."""

from __future__ import annotations

import _thread
import gc
import sys
import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from smachac.runtime import smach

Act = Callable[[Any], str]

KINDS = ("machine", "sequence", "concurrence", "iterator")


pytestmark = pytest.mark.usefixtures("silent_smach")


@pytest.fixture(autouse=True)
def _no_thread_is_left() -> Iterator[None]:
    before = set(threading.enumerate())
    yield
    assert set(threading.enumerate()) <= before


class Leaf(smach.State):
    """Acts; ends with `preempted` when asked to."""

    def __init__(self, act: Act = lambda leaf: "done") -> None:
        super().__init__(["done", "preempted"])
        self.act = act
        self.asked = threading.Event()

    def request_preempt(self) -> None:
        super().request_preempt()
        self.asked.set()

    def execute(self, ud: Any, /) -> str:
        return self.act(self)


def until_asked(leaf: Leaf) -> str:
    """Wait for a request and answer it."""
    assert leaf.asked.wait(10), "no preempt request came"
    leaf.service_preempt()
    return "preempted"


def held_by(kind: str, state: smach.State, *others: smach.State) -> Any:
    """A container of a kind around a state, in a concurrence beside others."""
    container: Any
    ends = ["done", "preempted"]
    if kind == "machine":
        with (container := smach.StateMachine(ends)):
            smach.StateMachine.add("A", state)
    elif kind == "sequence":
        with (container := smach.Sequence(ends, "done")):
            smach.Sequence.add("A", state)
    elif kind == "iterator":
        with (container := smach.Iterator(ends, [], [], it=[1], exhausted_outcome="done")):
            smach.Iterator.set_contained_state("A", state)
    else:
        rule = {"preempted": {"A": "preempted"}}
        with (container := smach.Concurrence(ends, "done", outcome_map=rule)):
            smach.Concurrence.add("A", state)
            for label, other in zip("BCD", others):  # noqa: B905 (the labels are more)
                smach.Concurrence.add(label, other)
    return container


@pytest.mark.parametrize("kind", KINDS)
def test_a_container_runs_from_its_start_to_its_outcome(kind: str) -> None:
    seen: list[bool] = []

    def act(leaf: Leaf) -> str:
        seen.append(container.is_running())
        return "done"

    container = held_by(kind, Leaf(act))
    container.register_start_cb(lambda *given: seen.append(container.is_running()))
    assert not container.is_running()
    assert container.execute() == "done"
    assert seen == [True, True]
    assert not container.is_running()


def failing(error: BaseException) -> Act:
    def act(leaf: Leaf) -> str:
        raise error

    return act


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("error", [ValueError(), KeyboardInterrupt(), SystemExit()])
def test_a_container_whose_child_raised_runs_no_more(kind: str, error: BaseException) -> None:
    leaf, beside = Leaf(failing(error)), Leaf(until_asked)
    container = held_by(kind, leaf, beside)
    usual = smach.InvalidStateError if kind == "concurrence" else smach.InvalidUserCodeError
    with pytest.raises(usual if isinstance(error, Exception) else type(error)):
        container.execute()
    assert not container.is_running()
    leaf.act = beside.act = lambda leaf: "done"
    assert container.execute() == "done"


@pytest.mark.parametrize("outer", KINDS)
@pytest.mark.parametrize("inner", KINDS)
def test_an_error_inside_ends_all_containers_around_it(outer: str, inner: str) -> None:
    held = held_by(inner, Leaf(failing(ValueError())), Leaf(until_asked))
    container = held_by(outer, held, Leaf(until_asked))
    with pytest.raises(smach.exceptions.SmachError):
        container.execute()
    assert not container.is_running()
    assert not held.is_running()


@pytest.mark.parametrize("kind", KINDS)
def test_a_preempted_container_runs_no_more(kind: str) -> None:
    started = threading.Event()

    def act(leaf: Leaf) -> str:
        started.set()
        return until_asked(leaf)

    container = held_by(kind, Leaf(act))
    ended: list[Any] = []
    thread = threading.Thread(target=lambda: ended.append(container.execute()))
    thread.start()
    assert started.wait(10)
    assert container.is_running()
    container.request_preempt()
    thread.join(10)
    assert ended == ["preempted"]
    assert not container.is_running()


@pytest.mark.parametrize("kind", KINDS)
def test_executing_a_container_from_its_own_child_is_an_error(kind: str) -> None:
    refused: list[bool] = []

    def act(leaf: Leaf) -> str:
        with pytest.raises(smach.InvalidStateError):
            container.execute()
        refused.append(container.is_running())
        return "done"

    container = held_by(kind, Leaf(act))
    assert container.execute() == "done"
    assert refused == [True]
    assert not container.is_running()


@pytest.mark.parametrize("kind", KINDS)
def test_a_container_whose_building_failed_can_be_built_on(kind: str) -> None:
    container = held_by(kind, Leaf())
    with pytest.raises(RuntimeError), container:  # noqa: PT012 (the block is what is tested)
        held_by("machine", Leaf())
        raise RuntimeError
    assert not container.is_running()
    assert not container.is_opened()
    assert container.execute() == "done"


@pytest.mark.parametrize("kind", KINDS)
def test_an_interrupt_from_the_keyboard_ends_everything(kind: str) -> None:
    """As Ctrl-C without a handler: the main thread is in the container, or waits for branches."""

    def act(leaf: Leaf) -> str:
        _thread.interrupt_main()
        return until_asked(leaf) if kind == "concurrence" else "done"

    inner = held_by(kind, Leaf(act), Leaf(until_asked))
    container = held_by("machine", inner)
    with pytest.raises(KeyboardInterrupt):
        container.execute()
    assert not container.is_running()
    assert not inner.is_running()


def one_of_eight(ends: str) -> None:
    """Build a concurrence of eight, and run it to an end of this kind."""
    others = [Leaf() if ends == "all" else Leaf(until_asked) for _ in range(7)]
    first = Leaf(failing(ValueError()) if ends == "raises" else lambda leaf: "done")
    any_ends: Any = (lambda ended: True) if ends == "any" else None
    container = smach.Concurrence(["done"], "done", child_termination_cb=any_ends)
    with container:
        for number, leaf in enumerate([first, *others]):
            smach.Concurrence.add(str(number), leaf)
    if ends == "preempted":
        container.request_preempt()
    if ends == "raises":
        with pytest.raises(smach.InvalidStateError):
            container.execute()
    else:
        assert container.execute() == "done"
    assert not container.is_running()


MANY = {"all": 1000, "any": 300, "raises": 300, "preempted": 300}
ROUNDS = [
    *((ends, 20) for ends in MANY),
    *(pytest.param(*row, marks=pytest.mark.slow) for row in MANY.items()),
]


@pytest.mark.parametrize(("ends", "rounds"), ROUNDS)
def test_many_concurrences_leave_nothing(ends: str, rounds: int) -> None:
    threads = threading.active_count()
    growths = []
    gc.freeze()  # what other tests left is not collected again and again
    for _ in range(4):
        gc.collect()
        blocks = sys.getallocatedblocks()
        for _ in range(rounds // 4):
            one_of_eight(ends)
        gc.collect()
        growths.append(sys.getallocatedblocks() - blocks)
    # A thread, a concurrence or an exception is tens of blocks, in each quarter; caches of Python
    # itself (the one for tracebacks) take about one in some rounds, up to a limit.
    assert min(growths) < rounds
    assert threading.active_count() <= threads
