"""The stepper: time moves when every live branch waits, whatever the threads do."""

from __future__ import annotations

import threading
from collections.abc import Iterator

import pytest

from smachac.sim.clock import Clock, Key, Skill
from smachac.sim.smach_bridge import together


class Counter:
    """A world that is nothing but a step number and a log of (step, who)."""

    def __init__(self, patience: float = 60.0) -> None:
        self.steps = 0
        self.log: list[tuple[int, str]] = []
        self.lost: list[Key] = []
        self.clock = Clock(self.step, patience=patience, left_behind=self.lost.append)

    def step(self) -> None:
        self.steps += 1

    def skill(self, name: str, count: int) -> Skill[str]:
        for _ in range(count):
            self.log.append((self.steps, name))
            yield
        return name

    def run(self, name: str, count: int) -> str:
        return self.clock.run(self.skill(name, count))


@pytest.fixture
def counter() -> Counter:
    return Counter()


def test_a_skill_takes_one_step_for_each_yield(counter: Counter) -> None:
    assert counter.run("a", 5) == "a"
    assert counter.steps == 5


def test_a_skill_without_yield_takes_no_time(counter: Counter) -> None:
    assert counter.run("a", 0) == "a"
    assert counter.steps == 0


def test_an_error_in_a_skill_reaches_its_caller(counter: Counter) -> None:
    def breaks() -> Skill[None]:
        yield
        raise RuntimeError("broken")

    with pytest.raises(RuntimeError, match="broken"):
        counter.clock.run(breaks())
    assert counter.run("a", 1) == "a"


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_branches_share_each_step_in_the_same_order_whoever_is_first(
    counter: Counter, order: tuple[int, int]
) -> None:
    counts = ((2, 1, 3), (4, 4))

    def branch(key: Key) -> None:
        counter.clock.enter(key)
        for count in counts[key[0]]:
            counter.run("ab"[key[0]], count)
        counter.clock.leave(key)

    with counter.clock.fork(2) as keys:
        threads = [threading.Thread(target=branch, args=(keys[k],)) for k in order]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    assert counter.steps == 8
    assert counter.log == sorted(counter.log)
    assert [name for step, name in counter.log if step < 6] == ["a", "b"] * 6


def test_a_raising_branch_does_not_stop_the_others(counter: Counter) -> None:
    def breaks() -> None:
        counter.run("a", 1)
        raise RuntimeError("broken")

    with pytest.raises(RuntimeError, match="broken"):
        together(counter.clock, [breaks, lambda: counter.run("b", 3)])
    assert counter.steps == 3
    assert counter.run("c", 1) == "c"


def test_a_branch_that_never_waits_only_has_to_leave(counter: Counter) -> None:
    values = together(counter.clock, [lambda: "idle", lambda: counter.run("b", 3)])
    assert values == ["idle", "b"]
    assert counter.lost == []


def test_nested_branches_take_the_place_of_theirs(counter: Counter) -> None:
    def outer() -> None:
        counter.run("x", 1)
        together(counter.clock, [lambda: counter.run("y", 2), lambda: counter.run("z", 3)])
        counter.run("x", 2)

    together(counter.clock, [outer, lambda: counter.run("w", 8)])
    assert counter.steps == 8
    ranks = {"x": 0, "y": 1, "z": 2, "w": 3}
    assert counter.log == sorted(counter.log, key=lambda each: (each[0], ranks[each[1]]))
    assert [step for step, name in counter.log if name == "x"] == [0, 4, 5]


def test_a_branch_that_stays_away_is_left_behind_and_may_come_back() -> None:
    counter = Counter(patience=0.05)
    over = threading.Event()

    def away() -> None:
        assert over.wait(30)
        counter.run("a", 1)

    def here() -> None:
        counter.run("b", 3)
        over.set()

    together(counter.clock, [away, here])
    assert counter.lost == [(0,)]
    assert [step for step, name in counter.log if name == "b"] == [0, 1, 2]
    assert "a" in [name for _, name in counter.log]


def test_time_stands_still_until_a_sibling_was_told_to_stop(counter: Counter) -> None:
    clock, flag = counter.clock, threading.Event()
    verdict = threading.Event()

    def until_told() -> Skill[int]:
        while not flag.is_set():
            yield
        return counter.steps

    def ender(key: Key, other: Key) -> None:
        clock.enter(key)
        counter.run("a", 5)
        clock.expect_preempts([other])
        clock.leave(key)
        verdict.set()

    found: list[int] = []

    def told(key: Key) -> None:
        clock.enter(key)
        found.append(clock.run(until_told()))
        clock.leave(key)

    with clock.fork(2) as (one, two):
        threads = [
            threading.Thread(target=ender, args=(one, two)),
            threading.Thread(target=told, args=(two,)),
        ]
        for thread in threads:
            thread.start()
        assert verdict.wait(30)
        # As a container does, from its own thread and after the branch has ended.
        flag.set()
        clock.preempted(two)
        for thread in threads:
            thread.join()
    assert found == [5]


def test_a_guest_steps_alone_and_beside_others(counter: Counter) -> None:
    done: list[str] = []
    started = threading.Event()

    def first() -> Skill[None]:
        started.set()
        while not done:
            yield

    def guest() -> None:
        assert started.wait(30)
        done.append(counter.run("guest", 3))

    thread = threading.Thread(target=guest)
    thread.start()
    counter.clock.run(first())
    thread.join()
    assert done == ["guest"]


def test_the_skill_is_closed_when_its_caller_gives_up(counter: Counter) -> None:
    closed: list[bool] = []

    def endless() -> Iterator[None]:
        try:
            while True:
                yield
        finally:
            closed.append(True)

    def interrupts() -> None:
        if counter.steps == 2:
            raise KeyboardInterrupt
        counter.steps += 1

    clock = Clock(interrupts)
    with pytest.raises(KeyboardInterrupt):
        clock.run(endless())  # type: ignore[arg-type]
    assert closed == [True]
