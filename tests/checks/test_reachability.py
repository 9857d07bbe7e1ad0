"""Rules over the graph of machines made by hand, and what they leave alone."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from smachac.diagnostics.diagnostic import Severity
from smachac.ir.nodes import Node, StateMachine
from tests.support.ir_machines import concurrence, iterator, leaf, machine, sequence
from tests.support.rule_findings import blocking, found, looping, one, report


def test_every_kind_of_edge_reaches() -> None:
    root = machine(
        "sm",
        "done",
        leaf("A", {"ok": "done", "timeout": "B"}),
        leaf("B", {"preempted": "C", "ok": "done"}),
        leaf("C", {"error": "D", "ok": "done"}),
        leaf("D", {"ok": "done"}, open=True),
    )
    assert found(root) == []


def test_the_start_need_not_be_the_first() -> None:
    root = machine("sm", "done", leaf("A", {"ok": "done"}), leaf("B", {"ok": "A"}), initial="B")
    assert found(root) == []
    assert found(replace(root, initial="A")) == ["SM201 sm/B"]


def test_a_start_that_does_not_exist_hides_nothing_else() -> None:
    root = machine("sm", "done", leaf("A", {"ok": "done"}), leaf("B", {"ok": "A"}), initial="C")
    assert found(root) == ["SM205 sm"]


def test_a_state_behind_an_unreachable_one_is_no_second_fault() -> None:
    root = machine(
        "sm",
        "done",
        leaf("A", {"ok": "done"}),
        leaf("B", {"ok": "C"}),
        leaf("C", {"ok": "done", "no": "B"}),
        leaf("D", {"ok": "D", "no": "done"}),
    )
    items = [item for item in report(root) if item.code == "SM201"]
    assert [item.finding.node for item in items] == ["sm/B", "sm/D"]
    assert items[1].finding.help == "add a transition to `D`, or remove `D`"


def test_a_sequence_whose_link_is_missing_says_so() -> None:
    node = sequence("SEQ", "ok", "ok", leaf("A", {"yes": "ok"}), leaf("B", {"ok": "=ok"}),
                    to={"ok": "done"})  # fmt: skip
    item = one(machine("sm", "done", node), "SM201")
    assert item.finding.node == "sm/SEQ/B"
    assert "the outcome `ok` without a transition" in str(item.finding.help)


@pytest.mark.parametrize("kind", [machine, iterator])
def test_an_empty_container_has_no_start(kind: Any) -> None:
    options = {"items_key": "k", "held": {"k": [1]}} if kind is iterator else {}
    inner = kind("IN", "exhausted", to={"exhausted": "done"}, **options)
    assert found(machine("sm", "done", inner)) == ["SM205 sm/IN"]
    assert found(machine("sm", "done")) == ["SM205 sm"]


def test_a_trap_is_one_finding_with_the_way_into_it_and_round() -> None:
    root = machine(
        "sm",
        "done",
        leaf("A", {"ok": "done", "no": "B"}),
        leaf("B", {"x": "C"}),
        leaf("C", {"x": "D"}),
        leaf("D", {"x": "C", "y": "D"}),
    )
    assert found(root) == ["SM202 sm/C"]
    way = one(root, "SM202").finding.path_labels
    assert way == ("A", "(no)", "B", "(x)", "C", "(x)", "D", "(x)", "C")


def test_each_trap_is_found() -> None:
    root = machine("sm", "done", leaf("A", {"x": "B", "y": "C", "z": "done"}),
                   leaf("B", {"x": "B"}), leaf("C", {"x": "C"}))  # fmt: skip
    assert found(root) == ["SM202 sm/B", "SM202 sm/C"]


@pytest.mark.parametrize(
    "root",
    [
        machine("sm", "done", leaf("A", {"ok": "done"}), leaf("B", {"x": "B"})),
        machine("sm", "done", leaf("A", {"x": "A", "preempted": "done"})),
        machine("sm", "done", leaf("A", {"x": "A", "done": "=done"})),
        machine(
            "sm", "done aborted", leaf("A", {"done": "A"}, open=True), leaf("B", {"x": "done"})
        ),
        machine("sm", "done", leaf("A", {"x": "A"}, outcomes="x y")),
        machine("sm", "done", leaf("A", {"x": "A", "y": "nowhere at all"})),
        looping(machine("sm", "", leaf("A", {"x": "A"}))),
    ],
    ids=["unreachable", "preempted", "by name", "open", "unhandled", "to nowhere", "forever"],
)
def test_these_are_no_traps(root: StateMachine) -> None:
    assert found(root, "SM202") == []


def test_an_open_leaf_that_handles_all_outcomes_can_be_a_trap() -> None:
    root = machine("sm", "done", leaf("A", {"done": "A", "x": "A"}, open=True))
    assert "SM202 sm/A" in found(root)


def test_a_state_without_outcomes_is_a_trap() -> None:
    root = machine("sm", "done", leaf("A", {"ok": "done", "no": "B"}), leaf("B"))
    assert found(root) == ["SM202 sm/B"]
    assert "has no outcomes" in one(root, "SM202").finding.message


def endless(name: str, to: dict[str, str]) -> Node:
    inner = machine(name, "ok", leaf("WAIT", {"x": "WAIT"}), to=to)
    return looping(replace(inner, children=(blocking(leaf("WAIT", {"x": "WAIT"})),)))


def test_a_trap_inside_is_not_reported_outside_as_well() -> None:
    inner = machine("IN", "ok", leaf("A", {"x": "A", "y": "A"}), to={"ok": "done"})
    root = machine("sm", "done", leaf("B", {"x": "IN"}), inner)
    assert found(root, "SM202") == ["SM202 sm/IN/A"]


def test_a_part_that_is_meant_to_go_on_traps_what_is_around_it() -> None:
    root = machine("sm", "done", endless("IN", {"ok": "done"}))
    assert found(root, "SM202") == ["SM202 sm/IN"]
    message = one(root, "SM202").finding.message
    assert message == "`IN` never ends, so `sm` never ends after entering it"
    assert found(looping(root), "SM202") == []


@pytest.mark.parametrize(("join", "expected"), [("all", ["SM202 sm/BOTH"]), ("any", [])])
def test_a_concurrence_ends_with_its_last_or_first_branch(join: str, expected: list[str]) -> None:
    both = concurrence("BOTH", "ok", leaf("L", outcomes="x"), endless("R", {}), default="ok",
                       join=join, to={"ok": "done"})  # fmt: skip
    assert found(machine("sm", "done", both), "SM202") == expected


@pytest.mark.parametrize(("items", "expected"), [([1], ["SM202 sm/IT"]), ([], [])])
def test_an_iterator_without_items_ends(items: list[int], expected: list[str]) -> None:
    node = iterator("IT", "exhausted", endless("IN", {}), loop="ok", items=items,
                    to={"exhausted": "done"})  # fmt: skip
    assert found(machine("sm", "done", node), "SM202") == expected


def test_an_outcome_that_nothing_brings_about_is_impossible() -> None:
    root = machine("sm", "done lost", leaf("A", {"ok": "done"}))
    assert found(root) == ["SM203 sm"]


def test_what_is_behind_an_unreachable_state_or_inside_is_one_fault() -> None:
    root = machine("sm", "done lost", leaf("A", {"ok": "done"}), leaf("B", {"ok": "lost"}))
    assert found(root) == ["SM201 sm/B"]
    inner = machine("IN", "ok bad", leaf("C", {"x": "ok"}), to={"ok": "done", "bad": "lost"})
    assert found(machine("sm", "done lost", inner)) == ["SM203 sm/IN"]


def test_an_open_leaf_may_bring_about_what_it_does_not_handle() -> None:
    assert found(machine("sm", "done lost", leaf("A", {"ok": "done"}, open=True))) == []
    handled = leaf("A", {"ok": "done", "lost": "done"}, open=True)
    assert found(machine("sm", "done lost", handled)) == ["SM203 sm"]
    more = (
        replace(handled, transitions=(*handled.transitions,)),
        leaf("B", {"x": "done"}, open=True),
    )
    root = machine("sm", "done lost", leaf("A", {"ok": "B", "lost": "B"}, open=True), more[1])
    assert found(root) == []


def test_an_unhandled_outcome_may_be_what_is_missed() -> None:
    root = machine("sm", "done lost", leaf("A", {"ok": "done"}, outcomes="ok bad"))
    assert found(root) == ["SM104 sm/A"]


def test_a_default_and_a_preemption_are_possible() -> None:
    def both(outcomes: str) -> StateMachine:
        node = concurrence("BOTH", outcomes, leaf("L", outcomes="x"), default="no",
                           rules=(("ok", {"L": "x"}),),
                           to=dict.fromkeys(outcomes.split(), "done"))  # fmt: skip
        return machine("sm", "done", node)

    assert found(both("ok no")) == []
    assert found(both("ok no preempted")) == []
    assert one(both("ok no preempted"), "SM203").severity is Severity.INFO
    assert found(both("ok no lost")) == ["SM203 sm/BOTH"]


@pytest.mark.parametrize(
    ("options", "codes"),
    [
        ({"items_key": "k", "held": {"k": [1]}, "loop": "ok"}, []),
        ({"items_key": "k", "held": {"k": [1]}}, []),
        ({"items": [1, 2], "loop": "bad"}, []),
        ({"items": [1, 2]}, ["SM203 sm/IT"]),
        ({"items": []}, []),
    ],
)
def test_an_iterator_is_exhausted_if_it_loops(options: dict[str, Any], codes: list[str]) -> None:
    outcomes = "exhausted ok bad" if "loop" not in options else "exhausted ok bad".replace(
        f" {options['loop']}", "")  # fmt: skip
    node = iterator("IT", outcomes, leaf("C", outcomes="ok bad"),
                    to=dict.fromkeys(outcomes.split(), "done"), **options)  # fmt: skip
    assert found(machine("sm", "done", node)) == codes


def test_an_iterator_that_is_asked_to_stop_needs_an_outcome_for_that() -> None:
    def each(outcomes: str, caught: str = "", **final: str) -> StateMachine:
        node = iterator("E", outcomes, leaf("A", outcomes="next bad"), items=[1, 2],
                        exhausted="all", loop="next", final={"bad": "all", **final},
                        to=dict.fromkeys(outcomes.split(), "done"))  # fmt: skip
        return machine("sm", "done", replace(node, catches=caught))

    assert one(each("all"), "SM208").severity is Severity.INFO
    assert one(each("all preempted"), "SM208").severity is Severity.WARNING
    assert found(each("all preempted")) == ["SM208 sm/E"]
    for fine in (
        each("all preempted", next="preempted"),
        each("all next"),
        each("all", next="all"),
        each("all error", caught="error"),
    ):
        assert [item.code for item in report(fine)] == []
