"""Concurrences, requests to stop, and virtual time in the interpreter."""

from __future__ import annotations

from typing import Any

import pytest

from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import Interpreter
from smachac.interpreter.result import Event
from smachac.interpreter.userdata import Userdata
from smachac.ir.nodes import Leaf, Machine
from tests.support.ir_machines import concurrence, iterator, leaf, machine, ran, short


def both(*rules: Any, join: str = "all", **more: Any) -> Any:
    """A machine around a concurrence of two leaves `A` and `B`, with outcomes `x` and `y`."""
    children = more.pop("children", (leaf("A", outcomes="x y"), leaf("B", outcomes="x y")))
    outcomes = "one two none"
    node = concurrence(
        "C",
        outcomes,
        *children,
        default="none",
        rules=rules,
        join=join,
        to={name: name for name in outcomes.split()},
        **more,
    )
    return machine("sm", outcomes, node)


@pytest.mark.parametrize(
    ("rules", "outcome"),
    [
        ([], "none"),
        ([("one", {"A": "x"})], "one"),
        ([("one", {"A": "y"})], "none"),
        ([("one", {"A": "x", "B": "y"})], "one"),
        ([("one", {"A": "x", "B": "x"})], "none"),
        ([("one", {"A": "x", "B": "y"}), ("two", {"A": "x"})], "one"),
        ([("two", {"A": "x"}), ("one", {"A": "x", "B": "y"})], "one"),
        ([("one", {"A": "x"}), ("two", {"B": "y"})], "two"),
        ([("one", {"A": "x"}), ("two", {})], "one"),
        ([("two", {})], "two"),
    ],
)
def test_n5_n6_the_rule_with_most_conditions_wins(rules: Any, outcome: str) -> None:
    assert ran(both(*rules), {"B": "y"})[0].outcome == outcome


def test_n4_children_start_together_and_have_no_transitions() -> None:
    lines = short(ran(both())[1])
    assert lines[:4] == ["start sm", "enter sm/C", "enter sm/C/A", "enter sm/C/B"]
    assert sorted(lines[4:6]) == ["exit sm/C/A x", "exit sm/C/B x"]
    assert lines[6:] == ["exit sm/C none", "transition sm/C none -> sm:none", "finish sm none"]


def chain(name: str, length: int) -> Any:
    """A machine of leaves in a row."""
    names = [f"{name}{number}" for number in range(length)]
    follow = [*names[1:], "x"]
    children = [leaf(here, {"x": to}) for here, to in zip(names, follow, strict=True)]
    return machine(name, "x", *children)


def order(events: list[Event]) -> list[str]:
    return [event["path"] for event in events if event["event"] == "exit"]


def test_the_seed_settles_the_order_of_branches() -> None:
    root = both(children=(chain("A", 6), chain("B", 6)))
    first, again = ran(root, seed=1)[1], ran(root, seed=1)[1]
    assert first == again
    orders = {tuple(order(ran(root, seed=seed)[1])) for seed in range(20)}
    assert len(orders) > 10
    assert len({tuple(sorted(one)) for one in orders}) == 1


def test_n9_branches_share_userdata() -> None:
    def work(userdata: Userdata) -> str:
        userdata["log"] = [*userdata["log"], 1]  # type: ignore[misc]
        return "x"

    children = [
        leaf(name, outcomes="x", ins="log", outs="log", remaps={"log": "all"}) for name in "AB"
    ]
    root = both(children=children, held={"all": []}, outs="all")
    assert ran(root, {"A": work, "B": work})[0].userdata == {"all": [1, 1]}


@pytest.mark.parametrize("seed", range(4))
def test_p2_join_any_preempts_what_still_runs(seed: int) -> None:
    slow = leaf("B", outcomes="succeeded preempted", type="SleepState", time=5.0)
    quick = leaf("A", outcomes="succeeded", type="SleepState", time=1)
    root = both(("one", {"A": "succeeded", "B": "preempted"}), join="any", children=(slow, quick))
    result, events = ran(root, builtin_behaviour(), seed=seed)
    assert (result.outcome, result.time) == ("one", 1.0)
    assert short(events)[4:7] == [
        "exit sm/C/A succeeded",
        "preempt sm/C/B",
        "exit sm/C/B preempted",
    ]
    assert [event["t"] for event in events][3:6] == [0.0, 1.0, 1.0]


def test_n13_the_rest_is_preempted_once() -> None:
    sleeps = [
        leaf(name, outcomes="succeeded", type="SleepState", time=seconds)
        for seconds, name in enumerate("ABC", 1)
    ]
    result, events = ran(both(join="any", children=sleeps), builtin_behaviour())
    assert preempted(events) == ["sm/C/B", "sm/C/C"]
    assert result.time == 3.0


def test_a_sleep_that_cannot_be_preempted_lasts() -> None:
    slow = leaf("B", outcomes="succeeded", type="SleepState", time=5.0)
    quick = leaf("A", outcomes="succeeded", type="SleepState", time=1)
    result, _ = ran(both(join="any", children=(slow, quick)), builtin_behaviour())
    assert result.time == 5.0


def test_sleeps_of_branches_go_on_at_once() -> None:
    children = [leaf(name, outcomes="succeeded", type="SleepState", time=2) for name in "AB"]
    assert ran(both(children=children), builtin_behaviour())[0].time == 2.0


def test_n10_a_failing_child_preempts_its_siblings_and_fails_the_concurrence() -> None:
    def fail(userdata: Userdata) -> str:
        raise ValueError("broken")

    slow = leaf("B", outcomes="succeeded preempted", type="SleepState", time=5.0)
    bad = machine("A", "x", leaf("BAD", {"x": "x"}))
    sleep = builtin_behaviour()

    def behave(path: str, node: Leaf, visit: int, userdata: Userdata) -> str:
        return fail(userdata) if node.name == "BAD" else sleep(path, node, visit, userdata)

    for seed in range(4):
        result, events = ran(both(children=(slow, bad), outs="k"), behave, seed=seed)
        assert str(result.error) == "sm/C/A/BAD: ValueError: broken"
        lines = short(events)
        assert lines[-1] == "exit sm/C/B preempted"
        assert [line for line in lines if line.startswith("preempt")] == ["preempt sm/C/B"]


def test_n8_any_outcome_of_a_child_will_do() -> None:
    assert ran(both(), {"A": "undeclared"})[0].outcome == "none"


def test_of_two_failures_the_first_is_told() -> None:
    def fail(userdata: Userdata) -> str:
        raise ValueError("broken")

    result, events = ran(both(), {"A": fail, "B": fail})
    assert result.error is not None
    failed = [event["path"] for event in events if event["event"] == "error"]
    assert sorted(failed) == ["sm/C/A", "sm/C/B"]
    assert result.error.path == failed[0]


def test_a_branch_without_end_stops_the_run() -> None:
    endless = machine("B", "x", leaf("L", {"x": "L"}))
    result, _ = ran(both(children=(leaf("A", outcomes="x"), endless)), max_steps=50)
    assert result.error is not None
    assert result.error.kind == "no-end"


def test_n1_a_concurrence_without_children_is_an_error() -> None:
    result, _ = ran(both(children=()))
    assert result.error is not None
    assert (result.error.kind, result.error.path) == ("no-state", "sm/C")


def stops(userdata: Userdata) -> str:
    """Answers a request to stop, else goes on."""
    if userdata.preempted:
        userdata.service_preempt()
        return "preempted"
    return "x"


def ignores(userdata: Userdata) -> str:
    return "x"


def preempted(events: list[Event]) -> list[str]:
    return [event["path"] for event in events if event["event"] == "preempt"]


def three(**names: Any) -> Any:
    """Three leaves in a row, which may go on after `preempted`."""
    return machine(
        "sm",
        "end stopped",
        leaf("A", {"x": "B", "preempted": "B"}),
        leaf("B", {"x": "C", "preempted": "stopped"}),
        leaf("C", {"x": "end", "preempted": "stopped"}),
    )


def test_p1_a_request_forces_nothing() -> None:
    result, events = ran(three(), dict.fromkeys("ABC", ignores), preempt_at=[1])
    assert result.outcome == "end"
    assert preempted(events) == ["sm", "sm/A", "sm/B", "sm/C"]


def test_p3_a_request_that_was_answered_is_not_passed_on() -> None:
    result, events = ran(three(), dict.fromkeys("ABC", stops), preempt_at=[1])
    assert result.outcome == "end"
    assert preempted(events) == ["sm", "sm/A"]
    assert "exit sm/A preempted" in short(events)


def test_p3_a_request_that_was_not_answered_reaches_the_next_state() -> None:
    result, events = ran(three(), {"A": ignores, "B": stops}, preempt_at=[1])
    assert result.outcome == "stopped"
    assert short(events)[4:7] == [
        "exit sm/A x",
        "transition sm/A x -> sm/B",
        "preempt sm/B",
    ]


def test_p2_two_requests_are_two() -> None:
    _, events = ran(three(), dict.fromkeys("ABC", stops), preempt_at=[1, 2])
    assert preempted(events) == ["sm", "sm/A", "sm", "sm/B"]


def test_p4_p5_a_request_without_an_answer_waits_for_the_next_run() -> None:
    visits: list[tuple[str, bool]] = []

    def behave(path: str, node: Leaf, visit: int, userdata: Userdata) -> str:
        visits.append((node.name, userdata.preempted))
        return ignores(userdata) if len(visits) < 4 else stops(userdata)

    interpreter = Interpreter(Machine(root=three()), behave, preempt_at=[3])
    interpreter.execute()
    interpreter.execute()
    assert visits[2:5] == [("C", True), ("A", True), ("B", False)]


def test_p5_a_request_before_the_start_reaches_the_first_leaves() -> None:
    root = both(children=(chain("A", 2), leaf("B", outcomes="x preempted")))
    result, events = ran(root, {"B": stops}, preempt_at=[0])
    assert result.outcome == "none"
    assert preempted(events) == ["sm", "sm/C", "sm/C/A", "sm/C/B", "sm/C/A/A0", "sm/C/A/A1"]


def test_p2_p6_a_request_goes_inwards_and_is_judged_outwards() -> None:
    inner = machine("B", "x", leaf("L", {"x": "x", "preempted": "x"}), to={"x": "C"})
    root = machine("sm", "end", inner, leaf("C", {"x": "end", "preempted": "end"}))
    _, events = ran(root, {"L": stops, "C": stops}, preempt_at=[1])
    assert preempted(events) == ["sm", "sm/B", "sm/B/L"]
    _, events = ran(root, {"L": ignores, "C": stops}, preempt_at=[1])
    assert preempted(events) == ["sm", "sm/B", "sm/B/L", "sm/C"]


def test_p8_what_join_any_asked_is_forgotten_after() -> None:
    asked: list[bool] = []

    def note(userdata: Userdata) -> str:
        asked.append(userdata.preempted)
        return "x"

    node = concurrence(
        "C",
        "again",
        leaf("A", outcomes="x"),
        machine("B", "x", leaf("B1", {"x": "B2"}), leaf("B2", {"x": "x"})),
        default="again",
        join="any",
        to={"again": "D"},
    )
    root = machine("sm", "end", node, leaf("D", {"x": "C", "y": "end"}))
    for seed in range(6):
        asked.clear()
        ran(root, {"B1": note, "D": ["x", "y"]}, seed=seed)
        assert len(asked) == 2
        assert asked[1] in (False, True)
        result, events = ran(root, {"B1": note, "D": ["x", "y"]}, seed=seed)
        second = max(at for at, line in enumerate(short(events)) if line == "enter sm/C/B/B1")
        assert not short(events)[second - 1].startswith("preempt")
        assert result.outcome == "end"


def test_p9_a_request_ends_an_iterator_after_the_item() -> None:
    each = iterator(
        "I",
        "none next",
        leaf("L", outcomes="next preempted"),
        items=[1, 2, 3],
        exhausted="none",
        loop="next",
        to={"none": "end", "next": "end"},
    )
    root = machine("sm", "end", each)
    result, events = ran(root, {"L": "next"}, preempt_at=[2])
    assert result.scopes["sm/I"] == {"it_data": 2}
    assert short(events)[-3] == "exit sm/I next"
    assert preempted(events) == ["sm", "sm/I", "sm/I/L"]
    result, events = ran(root, {"L": "next"}, preempt_at=[0])
    assert result.scopes["sm/I"] == {"it_data": 1}
    assert preempted(events) == ["sm", "sm/I", "sm/I/L"]


def test_p10_a_request_to_a_concurrence_is_served_when_no_child_holds_it() -> None:
    def root() -> Any:
        children = (leaf("A", outcomes="x preempted"), leaf("B", outcomes="x preempted"))
        node = concurrence("C", "x", *children, default="x", to={"x": "D"})
        return machine("sm", "end", node, leaf("D", {"x": "end", "preempted": "end"}))

    served = ran(root(), {"A": stops, "B": stops, "D": stops}, preempt_at=[2])[1]
    assert preempted(served) == ["sm", "sm/C", "sm/C/A", "sm/C/B"]
    held = ran(root(), {"A": stops, "B": ignores, "D": stops}, preempt_at=[2])[1]
    assert preempted(held) == ["sm", "sm/C", "sm/C/A", "sm/C/B", "sm/D"]
