"""Branches that do not end and waits without a limit, and what is fine."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.analysis.context import Context
from smachac.checks import check_machine
from smachac.diagnostics.diagnostic import Severity
from smachac.ir.nodes import Leaf, Machine, Node, StateMachine, StateType, Value, VariableType
from tests.support.examples import examples
from tests.support.ir_machines import concurrence, iterator, leaf, machine, value
from tests.support.rule_findings import blocking, found, one, report

WORK = leaf("WORK", outcomes="done")


def both(*branches: Node, join: str = "all") -> StateMachine:
    node = concurrence("BOTH", "done", *branches, default="done", to={"done": "done"}, join=join)
    return machine("sm", "done", node)


def watch(to: dict[str, str], *, forever: bool = False) -> StateMachine:
    wait = blocking(leaf("WAIT", {"x": "WAIT", **to}))
    return replace(machine("WATCH", "stopped", wait), forever=forever)


@pytest.mark.parametrize(
    ("branch", "join", "says"),
    [
        (watch({"preempted": "stopped"}), "all", "ends only after a preempt request"),
        (leaf("WATCH", outcomes="preempted"), "all", "ends only after a preempt request"),
        (watch({"preempted": "stopped"}), "any", None),
        (watch({"seen": "stopped"}), "all", None),
        (watch({"preempted": "stopped"}, forever=True), "any", None),
        (watch({"preempted": "WAIT"}, forever=True), "any", "runs forever, also after"),
        (iterator("WATCH", "stopped", watch({"preempted": "stopped"}), items=[1],
                  exhausted="stopped"), "all", "ends only after a preempt request"),
        (concurrence("WATCH", "x", leaf("A", outcomes="x"), watch({"preempted": "stopped"}),
                     default="x", join="any"), "all", None),
        (leaf("WATCH", outcomes="preempted", open=True), "all", None),
    ],
    ids=["monitor", "leaf", "stopped by the other", "ends itself", "forever, answers",
         "forever, ignores", "in an iterator", "stopped inside", "open"],
)  # fmt: skip
def test_a_branch_that_does_not_end(branch: Node, join: str, says: str | None) -> None:
    items = [item for item in report(both(WORK, branch, join=join)) if item.code == "SM407"]
    assert [item.finding.node for item in items] == (["sm/BOTH/WATCH"] if says else [])
    assert all(says is not None and says in item.finding.message for item in items)


def test_branches_that_all_go_on_until_they_are_stopped_are_meant_so() -> None:
    one_ = watch({"preempted": "stopped"})
    assert found(both(one_, replace(one_, name="OTHER")), "SM407") == []


def test_a_trap_in_a_branch_is_reported_as_a_trap() -> None:
    trap = watch({"preempted": "WAIT"})
    root = both(WORK, trap, join="any")
    assert found(root, "SM202") == ["SM202 sm/BOTH/WATCH/WAIT"]
    assert found(root, "SM4") == []


@pytest.mark.parametrize(
    ("outcomes", "variables", "limited"),
    [
        ("ok", {}, False),
        ("ok preempted", {}, False),
        ("ok preempted", {"timeout": None}, False),
        ("ok preempted", {"timeout": 3}, True),
        ("ok lost preempted", {}, True),
        ("ok lost preempted", {"timeout": None}, False),
        ("ok timeout", {}, True),
        ("ok timed_out", {}, True),
        ("ok", {"timeout": 3}, True),
        ("ok", {"exec_timeout": 3}, True),
        ("ok", {"timeout": None}, False),
    ],
)
def test_a_wait_needs_a_limit(outcomes: str, variables: dict[str, Any], limited: bool) -> None:
    to = dict.fromkeys(outcomes.split(), "done")
    wait = blocking(leaf("WAIT", to, **variables))
    root = machine("sm", "done", wait)
    items = [item for item in report(root) if item.code == "SM207"]
    assert [item.severity for item in items] == ([] if limited else [Severity.INFO])
    inside = both(WORK, machine("IN", "done", wait))
    assert found(inside, "SM207") == ([] if limited else ["SM207 sm/BOTH/IN/WAIT"])
    unlike = machine("sm", "done", replace(wait, blocking=False))
    assert [item for item in report(unlike) if item.code == "SM207"] == []


def test_a_time_limit_needs_a_state_that_answers() -> None:
    node = concurrence("WAIT", "ok timeout", blocking(leaf("WAIT", outcomes="ok")),
                       leaf("TIMER", outcomes="succeeded preempted"), default="timeout",
                       join="any", to={"ok": "done", "timeout": "lost"})  # fmt: skip
    item = one(machine("sm", "done lost", replace(node, sugar="timeout")), "SM207")
    assert "the time limit of `WAIT` cannot stop `WAIT`" in item.finding.message


@pytest.mark.parametrize(
    ("join", "sugar", "other", "limited"),
    [
        ("all", "", "ok", False),
        ("any", "", "ok", True),
        ("any", "timeout", "ok", True),
        ("any", "", "preempted", False),
    ],
    ids=["nothing preempts it", "a sibling", "a time limit", "no sibling ends"],
)
def test_preempted_is_a_limit_where_something_sends_a_request(
    join: str, sugar: Any, other: str, limited: bool
) -> None:
    wait = blocking(leaf("WAIT", outcomes="pressed preempted"))
    to = dict.fromkeys(["done", "preempted"], "done")
    node = concurrence("WAIT", "done preempted", wait, leaf("OTHER", outcomes=other),
                       default="done", join=join, to=to)  # fmt: skip
    root = machine("sm", "done", replace(node, sugar=sugar))
    items = [each for each in report(root) if each.code == "SM207"]
    assert [item.severity for item in items] == ([] if limited else [Severity.WARNING])


def test_a_time_limit_of_a_state_type_counts_when_it_is_set() -> None:
    def said(default: Value | None) -> list[str]:
        variables = {"timeout": VariableType(name="timeout", default=default)}
        type_ = StateType(name="Wait", variables=variables)
        to = dict.fromkeys(["ok", "lost", "preempted"], "done")
        root = machine("sm", "done", blocking(leaf("WAIT", to, type="Wait")))
        items = check_machine(Machine(root=root, state_types={"Wait": type_}))
        return [item.code for item in items if item.code == "SM207"]

    assert said(None) == ["SM207"]
    assert said(value(10.0)) == []


@pytest.mark.parametrize(
    ("default", "given", "limited"),
    [
        (1, {}, True),
        (1, {"max_checks": 5}, True),
        (1, {"max_checks": -1}, False),
        (1, {"max_checks": None}, False),
        (-1, {}, False),
        (None, {}, False),
        (-1, {"max_checks": 0}, True),
        (-1, {"timeout": 3.0}, True),
    ],
)
def test_a_limit_of_the_tries_is_a_limit(
    default: int | None, given: dict[str, Any], limited: bool
) -> None:
    variables = {
        "max_checks": VariableType(name="max_checks", default=value(default), role="tries"),
        "timeout": VariableType(name="timeout"),
    }
    to = dict.fromkeys(["true", "false", "preempted"], "done")
    root = machine("sm", "done", blocking(leaf("WAIT", to, type="Check", **given)))
    types = {"Check": StateType(name="Check", variables=variables)}
    items = check_machine(Machine(root=root, state_types=types))
    assert [item.code for item in items if item.code == "SM207"] == ([] if limited else ["SM207"])


def sleep(seconds: Any, to: dict[str, str] | None = None, name: str = "WAIT") -> Leaf:
    made = leaf(name, to or {}, outcomes="succeeded preempted", time=seconds)
    variables = tuple(replace(variable, role="duration") for variable in made.variables)
    return replace(made, variables=variables)


def limited(seconds: float, inner: Node) -> StateMachine:
    """A machine with a state under a time limit."""
    names = [outcome.name for outcome in inner.outcomes]
    node = concurrence("WAIT", " ".join([*names, "timeout"]), inner, sleep(seconds, name="TIMER"),
                       default="timeout", join="any",
                       to=dict.fromkeys([*names, "timeout"], "done"))  # fmt: skip
    return machine("sm", "done", replace(node, sugar="timeout"))


def row(*states: Node, outcomes: str = "ok lost") -> StateMachine:
    return machine("WAIT", outcomes, *states)


LONG = {"succeeded": "B", "preempted": "lost"}
END = {"succeeded": "ok", "preempted": "lost"}
TRIES = iterator("WAIT", "done gone", sleep(2, name="A"), items=[1, 2, 3], loop="succeeded",
                 exhausted="done")  # fmt: skip
TRY = replace(
    row(sleep("`lambda ud: ud.pause`", {"succeeded": "A", "preempted": "bad"}, "PAUSE"),
        leaf("A", {"bad": "bad"}), outcomes="bad"),
    sugar="retry", name="TRY",
)  # fmt: skip
RETRY = replace(
    iterator("WAIT", "exhausted", TRY, items=[0.0, 2.0, 2.0], loop="bad"), sugar="retry"
)


@pytest.mark.parametrize(
    ("inner", "least"),
    [
        (sleep(3), 3),
        (row(sleep(1, LONG, "A"), sleep(2, END, "B")), 3),
        (row(leaf("A", {"near": "C", "far": "B"}), sleep(9, {"succeeded": "C"}, "B"),
             sleep(2, END, "C")), 2),
        (TRIES, 6),
        (RETRY, 4),
        (concurrence("WAIT", "ok", sleep(2, name="A"), sleep(3, name="B"), default="ok"), 3),
        (concurrence("WAIT", "ok", sleep(2, name="A"), sleep(3, name="B"), default="ok",
                     join="any"), 2),
    ],
    ids=["sleep", "row", "shortest way", "loop", "delays of a retry", "all", "any"],
)  # fmt: skip
def test_a_time_limit_that_is_too_short(inner: Node, least: float) -> None:
    assert found(limited(least + 0.5, inner), "SM212") == []
    for seconds in (least, least - 0.5):
        item = one(limited(seconds, inner), "SM212")
        assert f"takes {least} s or more" in item.message
        assert item.help is not None
        assert item.help.startswith(f"write a time limit of more than {least} s")


@pytest.mark.parametrize(
    "inner",
    [
        sleep("`lambda ud: ud.t`"),
        leaf("WAIT", outcomes="ok", time=9),
        iterator("WAIT", "done", sleep(2, name="A"), items_key="k", loop="succeeded",
                 exhausted="done"),
        row(leaf("A", {"skip": "ok", "wait": "B"}), sleep(9, {"succeeded": "ok"}, "B"),
            outcomes="ok"),
    ],
    ids=["function", "another type", "unknown items", "a way round"],
)  # fmt: skip
def test_times_that_are_not_known(inner: Node) -> None:
    assert found(limited(1, inner), "SM212") == []


Flow = dict[str, dict[str, str]]


@st.composite
def flows(draw: st.DrawFn) -> Flow:
    names = [f"S{number}" for number in range(draw(st.integers(1, 4)))]
    targets = st.sampled_from([*names, *names, "out", "lost"])
    outcomes = st.sampled_from(["ok", "other", "preempted"])
    steps = st.dictionaries(outcomes, targets, min_size=1, max_size=3)
    return {name: draw(steps) for name in names}


def exits(flow: Flow, left_out: str = "") -> set[str]:
    """The exits that can be reached from S0."""
    seen = {"S0"}
    while True:
        more = {to for name in seen for outcome, to in flow.get(name, {}).items()
                if outcome != left_out} - seen  # fmt: skip
        if not more:
            return seen - flow.keys()
        seen |= more


@settings(max_examples=examples(150))
@given(flows())
def test_endings_are_the_exits_that_can_be_reached(flow: Flow) -> None:
    branch = machine("IN", "out lost", *(leaf(name, to) for name, to in flow.items()))
    root = both(WORK, branch)
    ever, unstopped = Context(Machine(root=root)).endings
    assert set(ever["sm/BOTH/IN"]) == exits(flow)
    assert set(unstopped["sm/BOTH/IN"]) == exits(flow, left_out="preempted")
    lasting = bool(exits(flow)) and not exits(flow, left_out="preempted")
    assert bool(found(root, "SM407")) == lasting
