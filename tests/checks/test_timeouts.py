"""Branches that do not end and waits without a limit, and what is fine."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.analysis.context import Context
from smachac.diagnostics.diagnostic import Severity
from smachac.ir.nodes import Machine, Node, StateMachine
from tests.support.ir_machines import concurrence, iterator, leaf, machine
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
        ("ok preempted", {}, True),
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


@settings(max_examples=150)
@given(flows())
def test_endings_are_the_exits_that_can_be_reached(flow: Flow) -> None:
    branch = machine("IN", "out lost", *(leaf(name, to) for name, to in flow.items()))
    root = both(WORK, branch)
    ever, calm = Context(Machine(root=root)).endings
    assert set(ever["sm/BOTH/IN"]) == exits(flow)
    assert set(calm["sm/BOTH/IN"]) == exits(flow, left_out="preempted")
    lasting = bool(exits(flow)) and not exits(flow, left_out="preempted")
    assert bool(found(root, "SM407")) == lasting
