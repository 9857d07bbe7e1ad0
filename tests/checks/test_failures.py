"""Failures that end as a success: in concurrences and in whole machines, made by hand."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.ir.nodes import Leaf, Node, StateMachine
from tests.support.examples import examples
from tests.support.ir_machines import concurrence, iterator, leaf, machine, ran
from tests.support.rule_findings import found, one, report

ROOT = "succeeded aborted"


def both(*branches: Node, rules: Any = (), default: str = "failed", **options: Any) -> StateMachine:
    to = options.pop("to", {"ready": "succeeded", "failed": "aborted"})
    node = concurrence("BOTH", " ".join(to), *branches, default=default, rules=rules, to=to,
                       **options)  # fmt: skip
    return machine("sm", ROOT, node)


LEFT = leaf("LEFT", outcomes="done aborted preempted")
RIGHT = leaf("RIGHT", outcomes="done aborted preempted")
WELL = ("ready", {"LEFT": "done", "RIGHT": "done"})


def test_a_rule_that_asks_one_child_hides_the_other() -> None:
    item = one(both(LEFT, RIGHT, rules=(("ready", {"LEFT": "done"}),)), "SM404")
    assert item.finding.message == (
        "`BOTH` ends with `ready` although `RIGHT` failed: `LEFT: done`, `RIGHT: aborted`"
    )
    assert item.finding.path_labels == ("BOTH", "(ready)", "succeeded")


def test_two_rules_for_one_outcome_are_two_faults() -> None:
    root = both(LEFT, RIGHT, rules=(("ready", {"LEFT": "done"}), ("ready", {"RIGHT": "done"})))
    items = [item.finding.arguments for item in report(root) if item.code == "SM404"]
    assert items == [
        ("BOTH", "ready", "LEFT: done", "RIGHT"),
        ("BOTH", "ready", "RIGHT: done", "LEFT"),
    ]


@pytest.mark.parametrize(
    "root",
    [
        both(LEFT, RIGHT, rules=(WELL,)),
        both(LEFT, RIGHT, rules=(("ready", {"LEFT": "done"}), ("failed", {"RIGHT": "aborted"}),
                                 ("half", {"LEFT": "done", "RIGHT": "aborted"})),
             to={"ready": "succeeded", "failed": "aborted", "half": "aborted"}),
        both(LEFT, RIGHT, rules=(WELL, ("all_right", {"LEFT": "done", "RIGHT": "aborted"})),
             to={"ready": "succeeded", "failed": "aborted", "all_right": "succeeded"}),
        both(LEFT, RIGHT, rules=(WELL,), default="not_ready",
             to={"ready": "succeeded", "not_ready": "aborted"}),
        both(leaf("LEFT", outcomes="found nothing aborted"), RIGHT, default="not_ready",
             rules=(("ready", {"LEFT": "found", "RIGHT": "done"}),),
             to={"ready": "succeeded", "not_ready": "succeeded"}),
        both(LEFT, RIGHT, default="over", to={"over": "aborted"}),
        both(leaf("LEFT", outcomes="done preempted"), leaf("RIGHT", outcomes="done"),
             default="ready", to={"ready": "succeeded"}),
        both(LEFT, leaf("TIMER", outcomes="aborted preempted"), join="any",
             rules=(("ready", {"LEFT": "done"}),)),
    ],
    ids=["all asked", "named", "an outcome of its own", "default is another", "neutral outcomes",
         "leads to a failure", "only preempted", "the first decides"],
)  # fmt: skip
def test_these_hide_nothing(root: StateMachine) -> None:
    assert found(root, "SM404") == []


def test_with_join_any_a_branch_that_cannot_be_stopped_may_hide_the_first() -> None:
    rules = (("ready", {"LEFT": "done"}),)
    stubborn = leaf("LEFT", outcomes="done aborted")
    timer = leaf("TIMER", outcomes="timeout preempted")
    item = one(both(stubborn, timer, rules=rules, join="any"), "SM404")
    assert "although `TIMER` failed: `LEFT: done`, `TIMER: timeout`" in item.finding.message


def test_tries_that_are_used_up_are_a_failure() -> None:
    tries = iterator("LEFT", "done exhausted", leaf("X", outcomes="done failed"), items=[1, 2],
                     loop="failed")  # fmt: skip
    rules = (("failed", {"RIGHT": "aborted"}),)
    root = both(replace(tries, sugar="retry"), RIGHT, rules=rules, default="ready")
    assert "`LEFT: exhausted`" in one(root, "SM404").finding.message
    assert found(both(tries, RIGHT, rules=rules, default="ready"), "SM404") == []


@pytest.mark.parametrize(
    ("root", "states"),
    [
        (machine("sm", ROOT, leaf("A", {"ok": "succeeded", "failed": "succeeded"})), ["sm/A"]),
        (machine("sm", ROOT, leaf("A", {"ok": "succeeded", "failed": "aborted"})), []),
        (machine("sm", ROOT, leaf("A", {"ok": "succeeded", "no": "succeeded"})), []),
        (machine("sm", "done lost", leaf("A", {"ok": "done", "failed": "done"})), []),
        (machine("sm", "done failed", leaf("A", {"ok": "done", "failed": "done"})), ["sm/A"]),
        (machine("sm", ROOT, leaf("A", {"ok": "succeeded", "failed": "B"}),
                 leaf("B", {"ok": "succeeded"})), []),
        (machine("sm", ROOT, machine("IN", "x aborted", leaf("A", {"aborted": "=aborted"}),
                                     to={"x": "aborted", "aborted": "succeeded"})), ["sm/IN"]),
        (machine("sm", ROOT, machine("IN", "ok aborted", leaf("A", {"aborted": "ok"}),
                                     to={"ok": "succeeded", "aborted": "aborted"})), ["sm/IN/A"]),
        (machine("sm", ROOT, machine("IN", "lost", leaf("A", {"aborted": "lost"}),
                                     to={"lost": "B"}), leaf("B", {"x": "succeeded"})), []),
        (machine("sm", ROOT, iterator("IN", "exhausted", leaf("A", outcomes="ok failed"),
                                      loop="ok", items=[1], final={"failed": "exhausted"},
                                      to={"exhausted": "succeeded"})), ["sm/IN"]),
        (machine("sm", ROOT, iterator("IN", "exhausted", leaf("A", outcomes="ok failed"),
                                      loop="ok failed", items=[1],
                                      to={"exhausted": "succeeded"})), []),
        (machine("sm", ROOT, replace(
            iterator("IN", "ok exhausted", leaf("A", outcomes="ok failed"), loop="failed",
                     items=[1], to={"ok": "succeeded", "exhausted": "succeeded"}),
            sugar="retry")), ["sm/IN"]),
        (machine("sm", ROOT, replace(
            concurrence("A", "ok aborted timeout", leaf("A", outcomes="ok aborted"),
                        leaf("TIMER", outcomes="succeeded preempted"), default="timeout",
                        join="any", to={"ok": "succeeded", "aborted": "succeeded",
                                        "timeout": "aborted"}), sugar="timeout")), ["sm/A"]),
    ],
    ids=["written", "handled", "no failure", "done alone", "done", "recovery", "outside", "inside",
         "state between", "iterator", "loops on failures", "retry", "time limit"],
)  # fmt: skip
def test_a_failure_that_ends_the_machine_with_a_success(root: Any, states: list[str]) -> None:
    assert found(root, "SM206") == [f"SM206 {state}" for state in states]


def test_a_masking_step_is_reported_once_with_a_path_to_it() -> None:
    inside = machine("IN", "x aborted", leaf("A", {"aborted": "=aborted", "x": "B"}),
                     leaf("B", {"aborted": "=aborted", "x": "x"}),
                     to={"x": "succeeded", "aborted": "succeeded"})  # fmt: skip
    item = one(machine("sm", ROOT, inside), "SM206")
    assert item.finding.path_labels == ("A", "(aborted)", "IN", "(aborted)", "succeeded")
    assert item.finding.message == (
        "`A` fails with `aborted`, but `sm` ends with a success; failures of `B` are hidden too"
    )
    assert item.finding.arguments == ("IN", "aborted", "A", "B")


@st.composite
def machines(draw: st.DrawFn) -> StateMachine:
    """Two levels of states with three outcomes each, which lead anywhere."""

    def states(prefix: str, exits: list[str], depth: int) -> list[Node]:
        names = [f"{prefix}{number}" for number in range(draw(st.integers(1, 3)))]
        return [state(name, [*names, *exits, *exits], depth) for name in names]

    def state(name: str, targets: list[str], depth: int) -> Node:
        outcomes = ["done", "aborted", "lost"]
        to = {outcome: draw(st.sampled_from(targets)) for outcome in outcomes}
        if depth and draw(st.booleans()):
            return machine(name, " ".join(outcomes), *states(name, outcomes, depth - 1), to=to)
        return leaf(name, to)

    return machine("sm", ROOT, *states("S", ROOT.split(), 1))


@settings(max_examples=examples(150))
@given(machines())
def test_played_the_failure_is_the_last_that_happens(root: StateMachine) -> None:
    """A failure is unhandled if and only if a run that starts in its state ends well, with that
    state as the last."""
    unhandled = set()
    for name, begun in starts(root):
        result, events = ran(begun, {name: "aborted"}, max_steps=30)
        entered = [e["path"].rpartition("/")[2] for e in events if e["event"] == "enter"]
        if result.outcome == "succeeded" and entered[-1] == name:
            unhandled.add(name)
    told = [item for item in report(root) if item.code == "SM206"]
    assert bool(told) == bool(unhandled)
    for item in told:
        assert set(item.finding.arguments[2:]) <= unhandled


def starts(root: StateMachine) -> list[tuple[str, StateMachine]]:
    """Each leaf, and the machine as if it started there."""
    found_: list[tuple[str, StateMachine]] = []
    for child in root.children:
        if isinstance(child, Leaf):
            found_.append((child.name, replace(root, initial=child.name)))
        elif isinstance(child, StateMachine):
            for inner in child.children:
                children = tuple(
                    replace(child, initial=inner.name) if one is child else one
                    for one in root.children
                )
                whole = replace(root, children=children, initial=child.name)
                found_.append((inner.name, whole))
    return found_
