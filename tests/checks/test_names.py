"""Rules over names and outcomes of machines made by hand, and what they leave alone."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from smachac.diagnostics.diagnostic import Severity
from smachac.diagnostics.source import Source, Span
from smachac.driver import analyse_script
from tests.support.ir_machines import concurrence, iterator, leaf, machine, sequence
from tests.support.rule_findings import found, one, report


def test_a_sound_machine_has_no_findings() -> None:
    root = machine(
        "sm",
        "done lost",
        leaf("A", {"ok": "B", "failed": "lost"}),
        leaf("B", {"ok": "done", "again": "A"}),
    )
    assert report(root) == []


def test_a_target_elsewhere_is_explained() -> None:
    inner = machine("IN", "ok", leaf("DEEP", {"ok": "ok"}), to={"ok": "done"})
    root = machine("sm", "done", leaf("A", {"ok": "IN", "no": "DEEP"}), inner)
    item = one(root, "SM101")
    assert item.finding.node == "sm/A"
    assert "the state `DEEP` in `sm/IN` cannot be a target here" in str(item.finding.help)


def test_an_empty_target_is_no_target() -> None:
    item = one(machine("sm", "done", leaf("A", {"ok": "", "go": "done"})), "SM101")
    assert item.finding.message == "the transition for outcome `ok` of `A` has no target"


def test_a_misspelt_target_is_one_fault() -> None:
    root = machine("sm", "done", leaf("PICK", {"ok": "PALCE"}), leaf("PLACE", {"ok": "doen"}))
    assert found(root) == ["SM101 sm/PICK", "SM101 sm/PLACE"]


def test_the_only_state_that_no_target_means_is_meant() -> None:
    root = machine("sm", "done", leaf("A", {"ok": "XYZ"}), leaf("B", {"ok": "done"}))
    assert (
        one(root, "SM101").help == "write `B`, to which no transition leads, or add the state `XYZ`"
    )
    assert found(root) == ["SM101 sm/A"]


def test_a_missing_state_may_lead_anywhere() -> None:
    others = [leaf("B", {"ok": "done"}), leaf("C", {"ok": "done"})]
    root = machine("sm", "done", leaf("A", {"ok": "XYZ"}), *others)
    assert found(root) == ["SM101 sm/A"]
    assert str(one(root, "SM101").finding.help).startswith("add the state `XYZ`, or use ")


def test_an_unknown_target_can_mean_each_state() -> None:
    others = [leaf("B", {"ok": "done"}), leaf("C", {"ok": "done"})]
    root = machine("sm", "done", leaf("A", {"ok": "xyz"}), *others)
    assert found(root) == ["SM101 sm/A"]


def test_children_that_run_together_have_no_transitions() -> None:
    both = concurrence("BOTH", "ok", leaf("L", {"x": "R"}), leaf("R", {"x": "ok"}), default="ok",
                       to={"ok": "IT"})  # fmt: skip
    each = iterator("IT", "exhausted x", leaf("C", {"x": "exhausted"}), loop="x", items_key="k",
                    held={"k": [1]}, to={"exhausted": "done", "x": "done"})  # fmt: skip
    root = machine("sm", "done", both, each)
    assert found(root) == ["SM101 sm/BOTH/L", "SM101 sm/BOTH/R", "SM101 sm/IT/C"]
    severities = {item.severity for item in report(root)}
    assert severities == {Severity.WARNING}


def test_transitions_of_an_open_leaf_are_taken_as_they_are() -> None:
    root = machine("sm", "done", leaf("A", {"whatever": "done"}, outcomes="x y", open=True))
    unknown = [line for line in found(root) if "SM102" in line]
    assert unknown == []


def test_a_misspelt_outcome_is_one_fault() -> None:
    root = machine(
        "sm", "done lost", leaf("A", {"ok": "done", "faild": "B"}, outcomes="ok failed"),
        leaf("B", {"ok": "lost"}),
    )  # fmt: skip
    assert found(root) == ["SM102 sm/A"]
    assert one(root, "SM102").finding.help == "did you mean `failed`?"


def test_a_misspelt_outcome_does_not_count_as_an_exit_by_name() -> None:
    node = leaf("A", {"ok": "done", "faild": "B", "failed": "=failed"}, outcomes="ok failed")
    root = machine("sm", "done failed", node, leaf("B", {"ok": "done"}))
    assert [item.code for item in report(root)] == ["SM102"]


def test_an_iterator_loops_only_on_outcomes_of_its_child() -> None:
    node = iterator("IT", "exhausted ok", leaf("C", outcomes="ok bad"), loop="bad baad",
                    items_key="k", held={"k": [1]},
                    to={"ok": "done", "exhausted": "done"})  # fmt: skip
    item = one(machine("sm", "done", node), "SM102")
    assert item.finding.message == (
        "`loop_outcomes` of `IT` lists `baad`, which is not an outcome of `C`"
    )


def test_a_state_behind_an_unknown_outcome_is_no_second_fault() -> None:
    root = machine("sm", "done", leaf("A", {"ok": "done", "bogus": "B"}, outcomes="ok"),
                   leaf("B", {"ok": "done"}))  # fmt: skip
    assert found(root) == ["SM102 sm/A"]


def test_a_state_that_lists_no_outcomes_is_one_fault() -> None:
    root = machine("sm", "done", replace(leaf("A", {"ok": "B"}), outcomes=()),
                   leaf("B", {"ok": "done"}))  # fmt: skip
    assert found(root) == ["SM102 sm/A"]


def test_a_name_used_twice_is_found_each_time() -> None:
    twins = (leaf("A", {"ok": "done"}) for _ in range(3))
    assert found(machine("sm", "done", *twins)) == ["SM106 sm/A", "SM106 sm/A"]
    both = concurrence("BOTH", "ok", leaf("L", outcomes="x"), leaf("L", outcomes="x"), default="ok",
                       to={"ok": "done"})  # fmt: skip
    assert found(machine("sm", "done", both)) == ["SM106 sm/BOTH/L"]


def test_the_same_name_in_two_containers_is_fine() -> None:
    parts = [machine(name, "ok", leaf("MOVE", {"ok": "ok"}), to={"ok": to})
             for name, to in (("LEFT", "RIGHT"), ("RIGHT", "done"))]  # fmt: skip
    assert report(machine("sm", "done", *parts)) == []


def test_a_state_named_like_an_outcome_is_found_where_transitions_are() -> None:
    clash = machine("sm", "done out", leaf("A", {"ok": "done", "no": "out"}),
                    leaf("done", {"ok": "out"}))  # fmt: skip
    assert found(clash) == ["SM107 sm/done"]
    both = concurrence("BOTH", "ok", leaf("ok", outcomes="x"), leaf("R", outcomes="x"),
                       default="ok", to={"ok": "done"})  # fmt: skip
    assert found(machine("sm", "done", both)) == []


@pytest.mark.parametrize(
    "name", ["Pick", "class", "delete", "None", "pick block", "3", "größer", "a.b", "self", "smach"]
)
def test_labels_need_not_be_identifiers(name: str) -> None:
    root = machine("sm", "done", leaf("PICK", {"ok": name}), leaf(name, {"ok": "done"}))
    assert report(root) == []


@pytest.mark.parametrize("name", ["A/B", "", "A\nB", "\x1b[2J"])
def test_names_that_paths_cannot_hold_are_found(name: str) -> None:
    root = machine("sm", "done", leaf("PICK", {"ok": "done"}), leaf(name, {"ok": "done"}))
    assert any(item.code == "SM107" for item in report(root))


def test_only_the_next_container_is_shadowed() -> None:
    inner = machine("IN", "ok", leaf("sm", {"ok": "ok"}), to={"ok": "done"})
    assert report(machine("sm", "done", inner)) == []
    assert found(machine("sm", "done", leaf("sm", {"ok": "done"}))) == ["SM108 sm/sm"]


def test_results_of_a_concurrence_are_declared() -> None:
    both = concurrence("BOTH", "ok", leaf("L", outcomes="x"), default="nope",
                       rules=(("okk", {"L": "x"}),), to={"ok": "done"})  # fmt: skip
    assert found(machine("sm", "done", both)) == ["SM103 sm/BOTH", "SM103 sm/BOTH"]


def test_a_missing_default_is_somebody_elses_fault() -> None:
    both = concurrence("BOTH", "ok", leaf("L", outcomes="x"), default="",
                       rules=(("ok", {"L": "x"}),), to={"ok": "done"})  # fmt: skip
    assert found(machine("sm", "done", both)) == []


@pytest.mark.parametrize(
    ("options", "codes"),
    [
        ({"loop": "bad"}, []),
        ({"loop": ""}, ["SM103 sm/IT"]),
        ({"loop": "", "final": {"bad": "ok"}}, []),
        ({"loop": "bad", "exhausted": "spent"}, ["SM103 sm/IT"]),
        ({"loop": "bad", "exhausted": "spent", "final": {"spent": "exhausted"}}, []),
        ({"loop": "bad", "final": {"bad": "ok"}}, []),
        ({"loop": "bad", "final": {"baad": "ok"}}, ["SM403 sm/IT"]),
    ],
)
def test_endings_of_an_iterator_are_declared(options: dict[str, Any], codes: list[str]) -> None:
    node = iterator("IT", "exhausted ok", leaf("C", outcomes="ok bad"), items_key="k",
                    held={"k": [1]}, to={"ok": "done", "exhausted": "done"}, **options)  # fmt: skip
    assert found(machine("sm", "done", node)) == codes


def test_every_visible_outcome_needs_a_transition() -> None:
    known = leaf("A", {"ok": "done"}, outcomes="ok no maybe")
    assert found(machine("sm", "done", known)) == ["SM104 sm/A"]
    item = one(machine("sm", "done", replace(known, open=True)), "SM104")
    assert item.finding.help == 'add `"no": done, maybe: done` to the transitions of `A`'
    both = concurrence("BOTH", "ok", leaf("L", outcomes="x y"), default="ok", to={"ok": "done"})
    assert found(machine("sm", "done", both)) == []


@pytest.mark.parametrize(
    ("to", "severity"),
    [
        ({"ok": "B", "failed": "=failed"}, Severity.WARNING),
        ({"found": "B", "grasp_failed": "=failed"}, Severity.WARNING),
        ({"ok": "B", "preempted": "=preempted"}, Severity.INFO),
        ({"go": "B", "ok": "=ok"}, Severity.INFO),
        ({"failed": "=failed", "ok": "=ok"}, Severity.INFO),
        ({"error": "B", "failed": "=failed"}, Severity.INFO),
        ({"preempted": "B", "failed": "=failed"}, Severity.INFO),
    ],
)
def test_only_a_failure_forgotten_beside_a_success_warns(
    to: dict[str, str], severity: Severity
) -> None:
    node = leaf("A", to)
    outcomes = "ok failed preempted"
    root = machine("sm", outcomes, node, leaf("B", {name: name for name in outcomes.split()}))
    implicit = [item for item in report(root) if item.code == "SM105"]
    assert {item.severity for item in implicit} == {severity}


def test_a_sequence_leaves_by_name_as_a_matter_of_course() -> None:
    steps = [leaf(name, {"ok": to, "failed": "=failed"}) for name, to in (("A", "B"), ("B", "=ok"))]
    linked = replace(
        steps[0], transitions=(replace(steps[0].transitions[0], origin="connector"),
                               steps[0].transitions[1])
    )  # fmt: skip
    node = sequence("SEQ", "ok failed", "ok", linked, steps[1],
                    to={"ok": "done", "failed": "lost"})  # fmt: skip
    assert found(machine("sm", "done lost", node)) == []


def test_rules_that_name_nothing_are_dead() -> None:
    both = concurrence(
        "BOTH", "ok no", leaf("L", outcomes="x"), leaf("R", open=True), default="no",
        rules=(("ok", {"L": "y", "M": "x"}), ("no", {}), ("ok", {"R": "anything", "L": "x"})),
        to={"ok": "done", "no": "done"},
    )  # fmt: skip
    assert found(machine("sm", "done", both)) == ["SM403 sm/BOTH"] * 3


def test_an_empty_concurrence_is_one_fault() -> None:
    both = concurrence("BOTH", "ok no", default="ok", to={"ok": "done", "no": "done"})
    assert found(machine("sm", "done", both)) == ["SM408 sm/BOTH"]


def test_calls_are_shown_only_for_what_stands_inside_the_called_script() -> None:
    main, sub = Source("main.yml", "x" * 9), Source("sub.yml", "x" * 9)
    call = Span(main, 1, 2)
    node = replace(leaf("A", {"ok": "away"}), via=(call,))
    step = node.transitions[0]

    def seen(place: Span) -> list[str]:
        moved = replace(node, transitions=(replace(step, target_span=place),))
        return [str(at.span) for at in one(machine("sm", "done", moved), "SM101").finding.related]

    assert seen(Span(sub, 3, 4)) == ["main.yml:1:2"]
    assert seen(Span(main, 3, 4)) == []


@pytest.mark.parametrize(
    ("fields", "name"),
    [
        ("retry: {on: [aborted], max: 2}", "A (retry)"),
        ("retry: {on: [aborted], max: 2, delay: 1 s}", "A (try)"),
        ("timeout: 2 s", "A (timeout)"),
        ("for_each: {item: x, in: [1, 2]}", "A (for_each)"),
    ],
)
def test_a_state_has_no_name_that_traces_have_for_another_one(fields: str, name: str) -> None:
    text = """
name: sm
template: Base
outcomes: [done]
states:
  - A: {template: ScriptedState, outcomes: [succeeded, aborted], FIELDS,
        transitions: {succeeded: NAME, aborted: done, exhausted: done, timeout: done,
                      preempted: done}}
  - NAME: {template: ScriptedState, outcomes: [succeeded], transitions: {succeeded: done}}
"""

    def clashes(fields: str) -> list[str]:
        source = Source("m.yml", text.replace("NAME", name).replace("FIELDS", fields))
        return [item.finding.node or "" for item in analyse_script(source).report
                if item.code == "SM107"]  # fmt: skip

    assert clashes(fields) == [f"sm/{name}"]
    assert clashes("doc: no field") == []
