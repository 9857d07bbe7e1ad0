"""The comparison of traces: what counts and what does not."""

from __future__ import annotations

import random
from dataclasses import replace
from typing import Any

import pytest

from smachac.interpreter.userdata import BehaviourError
from smachac.runtime.tracing.compare import compare
from tests.support.ir_machines import concurrence, leaf, machine, ran

Events = list[dict[str, Any]]


def trace(seed: int = 0, **acts: Any) -> Events:
    """A run of two branches, the second a machine, then a leaf."""
    inner = machine("B", "x", leaf("B1", {"x": "B2"}), leaf("B2", {"x": "x"}))
    both = concurrence("C", "x", leaf("A", outcomes="x y"), inner, default="x", to={"x": "D"})
    root = machine("sm", "x", both, leaf("D", {"x": "x"}))
    return ran(root, acts, seed=seed)[1]


def test_the_same_is_the_same() -> None:
    assert compare(trace(), trace()) is None
    assert compare([], []) is None


def test_the_order_between_branches_does_not_count() -> None:
    orders = {tuple((e["event"], e["path"]) for e in trace(seed)) for seed in range(10)}
    assert len(orders) > 1
    for seed in range(10):
        assert compare(trace(0), trace(seed)) is None


def failing(seed: int) -> Events:
    """A run of a machine that catches the exception in a branch of it, then two branches."""

    def fail(_: object) -> str:
        raise BehaviourError("no")

    end = {"x": "x"}
    raising = concurrence(
        "C", "x", leaf("F", outcomes="x"), leaf("B", outcomes="x"), default="x", to=end
    )
    caught = machine("M", "x error", raising, to={"x": "D", "error": "D"})
    both = concurrence(
        "D", "x", leaf("A", outcomes="x"), leaf("B", outcomes="x"), default="x", to=end
    )
    root = machine("sm", "x", replace(caught, catches="error"), both)
    events = ran(root, {"F": fail}, seed=seed)[1]
    # The order of branches decides whether the stop request comes before the end of the other.
    return [event for event in events if event["event"] != "preempt"]


def test_branches_are_sorted_after_an_exception_in_an_earlier_one() -> None:
    orders = {tuple((e["event"], e["path"]) for e in failing(seed)) for seed in range(10)}
    assert len(orders) > 1
    for seed in range(10):
        assert compare(failing(0), failing(seed)) is None


def visit(name: str, to: str) -> Events:
    path = f"sm/M/{name}"
    return [
        {"event": "enter", "path": path},
        {"event": "exit", "path": path, "outcome": "x"},
        {"event": "transition", "path": path, "outcome": "x", "to": f"sm/M/{to}"},
    ]


def test_a_machine_is_no_concurrence_because_a_state_in_it_failed() -> None:
    failed: Events = [
        {"event": "enter", "path": "sm/M"},
        {"event": "enter", "path": "sm/M/A"},
        {"event": "error", "path": "sm/M/A"},
        {"event": "exit", "path": "sm/M", "outcome": "error"},
        {"event": "transition", "path": "sm/M", "outcome": "error", "to": "sm/M"},
        {"event": "enter", "path": "sm/M"},
    ]
    first, second = visit("A", to="B"), visit("B", to="A")
    assert compare([*failed, *first, *second], [*failed, *second, *first]) is not None


def test_times_places_numbers_and_messages_do_not_count() -> None:
    changed: Events = [{**event, "t": 9.0, "src": "a:1", "seq": 0} for event in trace()]
    assert compare(trace(), changed) is None
    failed = [{"event": "error", "path": "sm", "message": text} for text in ("one", "two")]
    assert compare(failed[:1], failed[1:]) is None


def test_the_order_inside_a_branch_counts() -> None:
    events = trace()
    first, second = (
        next(at for at, event in enumerate(events) if (event["event"], event["path"]) == wanted)
        for wanted in (("exit", "sm/C/B/B1"), ("transition", "sm/C/B/B1"))
    )
    events[first], events[second] = events[second], events[first]
    assert compare(trace(), events) == (
        "event 7: `exit sm/C/B/B1 x`, but then `transition sm/C/B/B1 x sm/C/B/B2`"
    )


def test_outcomes_count() -> None:
    assert compare(trace(), trace(A="y")) == "event 4: `exit sm/C/A x`, but then `exit sm/C/A y`"


@pytest.mark.parametrize("seed", range(5))
def test_every_event_counts(seed: int) -> None:
    events = trace(seed)
    for at in range(len(events)):
        assert compare(trace(), events[:at] + events[at + 1 :]) is not None
        assert compare(events + events[at : at + 1], trace()) is not None
    after = events[:]
    random.Random(seed).shuffle(after)
    assert compare(events, after) is not None


def test_a_trace_that_goes_on_is_told() -> None:
    assert compare(trace(), trace()[:-1]) == "event 18: only the first trace has `finish sm x`"
    assert compare([], trace()[:1]) == "event 1: only the second trace has `start sm`"


def test_values_count() -> None:
    event = {"event": "write", "path": "sm/A", "key": "k", "value": [1]}
    assert compare([event], [{**event, "value": [2]}]) is not None
    assert compare([event], [{**event, "key": "j"}]) is not None


def test_a_concurrence_that_failed_is_compared_by_branch() -> None:
    start = {"event": "start", "path": "sm"}
    into = {"event": "enter", "path": "sm/C"}
    one = [{"event": "enter", "path": "sm/C/A"}, {"event": "error", "path": "sm/C/A"}]
    two = [
        {"event": "enter", "path": "sm/C/B"},
        {"event": "exit", "path": "sm/C/B", "outcome": "x"},
    ]
    assert compare([start, into, *one, *two], [start, into, *two, *one]) is None
    assert compare([start, into, *one, *two], [start, into, *two, *one[:1]]) is not None
