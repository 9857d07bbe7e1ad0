"""Stops that a machine ignores or reports as a success, and what is fine."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.ir.nodes import Leaf, Node, StateMachine
from tests.support.examples import examples
from tests.support.ir_machines import concurrence, iterator, leaf, machine, ran, short
from tests.support.rule_findings import found, one, report

CODES = ("SM209", "SM210", "SM211")


def said(root: StateMachine) -> list[str]:
    """The findings about stops, with the places that their witness paths pass."""
    items = [item for item in report(root) if item.code in CODES or item.code == "SM407"]
    return [" ".join([item.code, *item.finding.path_labels]) for item in items]


def sm(*states: Node, outcomes: str = "succeeded failed preempted") -> StateMachine:
    return machine("sm", outcomes, *states)


def holding(node: Leaf) -> Leaf:
    return replace(node, claims=("arm",))


@pytest.mark.parametrize(
    ("states", "path"),
    [
        ([leaf("A", {"ok": "succeeded", "preempted": "A"})], "A (preempted) A"),
        ([leaf("A", {"ok": "B"}), leaf("B", {"ok": "succeeded", "preempted": "A"})],
         "B (preempted) A (ok) B"),
        ([leaf("A", {"ok": "succeeded", "preempted": "C"}), leaf("C", {"ok": "A"})],
         "A (preempted) C (ok) A"),
        ([leaf("A", {"ok": "B", "preempted": "B"}), leaf("B", {"far": "A", "near": "succeeded"})],
         "A (preempted) B (far) A"),
        ([leaf("A", {"ok": "B", "preempted": "failed"}), leaf("B", {"ok": "succeeded"})], None),
        ([leaf("A", {"ok": "succeeded", "preempted": "C"}), leaf("C", {"ok": "failed"})], None),
        ([leaf("A", {"ok": "succeeded", "preempted": "C"}),
          leaf("C", {"succeeded": "failed", "aborted": "A"})], None),
        ([leaf("A", {"ok": "succeeded", "preempted": "C"}),
          leaf("C", {"resume": "A", "quit": "failed"})], None),
        ([leaf("A", {"ok": "succeeded", "aborted": "C", "preempted": "C"}),
          leaf("C", {"again": "A", "enough": "failed"})], "A (preempted) C (again) A"),
        ([leaf("A", {"ok": "succeeded", "aborted": "C", "preempted": "C"}),
          replace(leaf("C", {"again": "A", "enough": "failed"}), blocking=True)], None),
        ([leaf("A", {"near": "succeeded", "aborted": "C", "preempted": "C"}),
          replace(leaf("C", {"again": "A", "enough": "failed"}), blocking=True)], None),
        ([leaf("A", {"ok": "succeeded", "aborted": "C", "preempted": "C"}),
          holding(replace(leaf("C", {"again": "A", "enough": "failed"}), blocking=True))],
         "A (preempted) C (again) A"),
        ([leaf("A", {"ok": "succeeded", "aborted": "C", "preempted": "C"}),
          replace(leaf("C", {"ok": "A", "aborted": "failed"}), blocking=True)],
         "A (preempted) C (ok) A"),
        ([replace(leaf("C", {"go": "A", "enough": "failed"}), blocking=True),
          leaf("A", {"ok": "succeeded", "preempted": "C"})], "A (preempted) C (go) A"),
    ],
    ids=["itself", "before it", "handler leads back", "into its loop", "ends", "handler ends",
         "only after a failure", "operator decides", "decides after failures",
         "operator decides after failures",
         "no success before it", "moves after failures", "recovers after failures",
         "part of the task"],
)  # fmt: skip
def test_a_state_that_starts_again_after_a_stop(states: list[Node], path: str | None) -> None:
    assert said(sm(*states)) == ([f"SM209 {path}"] if path else [])


def test_a_container_that_starts_again_after_a_stop() -> None:
    inner = machine("PICK", "ok failed", leaf("MOVE", {"ok": "ok", "preempted": "failed"}),
                    to={"ok": "succeeded", "failed": "PICK"})  # fmt: skip
    item = one(sm(inner), "SM209")
    assert item.finding.node == "sm/PICK"
    assert "in `MOVE` `PICK` starts again" in item.message
    named = replace(inner, name="sm")
    root = machine("top", "succeeded failed", replace(named, name="PICK"))
    assert said(root) == ["SM209 PICK (failed) PICK"]


def test_a_machine_without_an_end_that_ignores_stops() -> None:
    root = replace(machine("sm", "", leaf("A", {"ok": "A", "preempted": "A"})), forever=True)
    assert said(root) == ["SM209 A (preempted) A"]
    assert found(replace(root, forever=False), "SM2") == ["SM202 sm/A"]


@pytest.mark.parametrize(
    ("join", "sugar", "code", "message"),
    [
        ("any", "", "SM407", "`IN` does not stop when another branch of `BOTH` ends"),
        ("any", "timeout", "SM407", "the time limit of `BOTH` cannot stop it"),
        ("all", "", "SM209", "after a preempt request `WAIT` starts again"),
    ],
)
def test_a_branch_that_a_sibling_cannot_stop(
    join: str, sugar: Any, code: str, message: str
) -> None:
    branch = machine("IN" if not sugar else "BOTH", "seen",
                     leaf("WAIT", {"ok": "seen", "preempted": "WAIT"}))  # fmt: skip
    move, to = leaf("MOVE", outcomes="ok preempted"), {"done": "failed", "preempted": "failed"}
    node = concurrence("BOTH", "done preempted", branch, move, default="done", join=join, to=to)
    root = sm(replace(node, sugar=sugar))
    assert said(root) == [f"{code} WAIT (preempted) WAIT"]
    assert one(root, code).message.startswith(message)


@pytest.mark.parametrize(
    ("states", "path"),
    [
        ([leaf("A", {"ok": "succeeded", "preempted": "succeeded"})], "A (preempted) succeeded"),
        ([leaf("A", {"ok": "succeeded", "preempted": "C"}), leaf("C", {"ok": "succeeded"})],
         "A (preempted) C"),
        ([leaf("A", {"ok": "failed", "preempted": "succeeded"})], None),
        ([leaf("A", {"ok": "succeeded", "aborted": "C", "preempted": "C"}),
          leaf("C", {"ok": "succeeded"})], None),
        ([machine("IN", "ok stopped", leaf("A", {"ok": "ok", "preempted": "stopped"}),
                  to={"ok": "succeeded", "stopped": "succeeded"})], "IN (stopped) succeeded"),
        ([machine("IN", "done failed", leaf("A", {"ok": "done", "preempted": "done"}),
                  to={"done": "succeeded", "failed": "failed"})], "A (preempted) done"),
        ([machine("IN", "succeeded", leaf("A", {"no": "A", "preempted": "succeeded"}),
                  to={"succeeded": "succeeded"}), leaf("B", {"ok": "succeeded"})], None),
    ],
    ids=["itself", "handler", "works until it is stopped", "as a failure", "through a container",
         "in a container", "container works until it is stopped"],
)  # fmt: skip
def test_a_stop_that_is_called_a_success(states: list[Node], path: str | None) -> None:
    assert said(sm(*states)) == ([f"SM210 {path}"] if path else [])


def test_a_concurrence_that_is_stopped_and_succeeds() -> None:
    branches = [leaf(name, outcomes="ok preempted") for name in ("LEFT", "RIGHT")]
    to = {"succeeded": "succeeded", "failed": "failed"}
    rules = (("failed", {"LEFT": "preempted", "RIGHT": "ok"}),)
    node = concurrence("BOTH", "succeeded failed", *branches, default="succeeded", rules=rules,
                       to=to)  # fmt: skip
    assert "although its branches were stopped" in one(sm(node), "SM210").message
    lazy = replace(node, children=(branches[0], leaf("RIGHT", outcomes="ok")))
    assert said(sm(lazy)) == []
    ok = (("succeeded", {"LEFT": "ok", "RIGHT": "ok"}),)
    right = concurrence("BOTH", "succeeded failed", *branches, default="failed", rules=ok, to=to)
    assert said(sm(right)) == []


@pytest.mark.parametrize(
    ("final", "exhausted", "items", "help"),
    [
        ({}, "succeeded", [1, 2], "and write `exhausted_outcome: exhausted` and `final_outcome_map:"
         " {succeeded: preempted, exhausted: succeeded}`"),
        ({"exhausted": "succeeded"}, "exhausted", [1, 2], "write `succeeded: preempted` in the"),
        ({"exhausted": "succeeded", "succeeded": "failed"}, "exhausted", [1, 2], None),
        ({}, "succeeded", [1], None),
    ],
    ids=["one name", "renamed", "other end", "one item"],
)  # fmt: skip
def test_a_loop_that_ends_early_and_succeeds(
    final: dict[str, str], exhausted: str, items: list[int], help: str | None
) -> None:
    loop = iterator("EACH", "succeeded failed", leaf("A", outcomes="succeeded"), items=items,
                    loop="succeeded", final=final, exhausted=exhausted,
                    to={"succeeded": "succeeded", "failed": "failed"})  # fmt: skip
    helps = [item.help for item in report(sm(loop)) if item.code == "SM210"]
    assert len(helps) == bool(help)
    assert all(help is not None and help in (help_ or "") for help_ in helps)
    answering = replace(loop, children=(leaf("A", outcomes="succeeded preempted"),))
    assert [item for item in report(sm(answering)) if item.code == "SM210"] == []


@pytest.mark.parametrize(
    ("states", "path"),
    [
        ([leaf("A", {"ok": "B", "preempted": "B"}), holding(leaf("B", {"ok": "succeeded"}))],
         "A (preempted) B"),
        ([leaf("A", {"ok": "B", "preempted": "B"}), leaf("B", {"ok": "C"}),
          holding(leaf("C", {"ok": "succeeded"}))], "A (preempted) B (ok) C"),
        ([leaf("A", {"ok": "B", "preempted": "STOP"}), holding(leaf("B", {"ok": "succeeded"})),
          leaf("STOP", {"ok": "B"})], "A (preempted) STOP (ok) B"),
        ([leaf("A", {"ok": "B", "preempted": "ASK"}), holding(leaf("B", {"ok": "succeeded"})),
          leaf("ASK", {"go_on": "B", "quit": "failed"})], None),
        ([leaf("A", {"ok": "succeeded", "preempted": "OPEN"}),
          holding(leaf("OPEN", {"ok": "HOME"})), holding(leaf("HOME", {"ok": "failed"}))], None),
        ([leaf("A", {"ok": "HOME", "aborted": "HOME", "preempted": "HOME"}),
          holding(leaf("HOME", {"ok": "failed"}))], None),
        ([machine("IN", "ok stopped", leaf("A", {"ok": "ok", "preempted": "stopped"}),
                  to={"ok": "B", "stopped": "B"}), holding(leaf("B", {"ok": "succeeded"}))],
         "IN (stopped) B"),
    ],
    ids=["next state", "later state", "through a handler", "operator decides", "safe states",
         "as a failure", "after a container"],
)  # fmt: skip
def test_a_task_that_continues_after_a_stop(states: list[Node], path: str | None) -> None:
    assert said(sm(*states)) == ([f"SM211 {path}"] if path else [])


Flow = dict[str, dict[str, str]]


@st.composite
def flows(draw: st.DrawFn) -> Flow:
    names = [f"S{number}" for number in range(draw(st.integers(1, 5)))]
    targets = st.sampled_from([*names, *names, "out", "lost"])
    outcomes = st.sampled_from(["ok", "other", "preempted"])
    return {
        name: draw(st.dictionaries(outcomes, targets, min_size=1, max_size=3)) for name in names
    }


@settings(max_examples=examples(200))
@given(flows())
def test_what_starts_again_does_so_in_a_run(flow: Flow) -> None:
    """Each witness path of SM209 can be run: a stop in its first state leads back to it."""
    root = machine("sm", "out lost", *(leaf(name, to) for name, to in flow.items()))
    for item in [each for each in report(root) if each.code == "SM209"]:
        path = [label.strip("()") for label in item.finding.path_labels]
        steps = list(zip(path[::2], path[1::2], strict=False))
        assert path[0] == path[-1]
        for (name, outcome), (target, _) in pairwise([*steps, (path[-1], "")]):
            assert flow[name][outcome] == target
        assert [outcome for _, outcome in steps].count("preempted") == 1
        acts = {name: [outcome, "ok"] for name, outcome in steps}
        begun = replace(root, initial=path[0])
        _, events = ran(begun, {**dict.fromkeys(flow, "ok"), **acts}, max_steps=len(path))
        entered = [line.split("/")[1] for line in short(events) if line.startswith("enter sm/")]
        assert entered[: len(steps) + 1] == path[::2]
