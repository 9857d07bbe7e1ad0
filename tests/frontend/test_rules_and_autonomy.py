"""Rules of a concurrence as a list, `join: rule`, and levels of autonomy: what is wrong in them."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.diagnostics.diagnostic import Report, Severity
from smachac.diagnostics.source import Source
from smachac.driver import analyse, build
from smachac.frontend.files import disk_library
from smachac.targets.flexbe import TARGET

LIBRARY = disk_library(Path("main.yml"), [])

SCRIPT = """\
name: sm
outcomes: [held, lost]
states:
- BOTH:
    template: Concurrence
    join: JOIN
    outcomes: [held, lost]
    outcome_map: RULES
    transitions: {held: held, lost: lost}
    states:
    - A: {template: ScriptedState, outcomes: [done, slipped]}
    - B: {template: ScriptedState, outcomes: [done, slipped], autonomy: LEVELS}
"""

WHOLE = "[{lost: {A: slipped}}, {lost: {B: slipped}}, {held: {A: done, B: done}}]"
FAULTS = {
    "word in a list": ("rule", "[lost]", "{}", ("SM004", "expected one rule, found a string", "")),
    "two rules in one item": (
        "rule", "[{lost: {A: slipped}, held: {A: done}}]", "{}",
        ("SM004", "expected one rule", "write it as `{OUTCOME: {STATE: OUTCOME}}`")),
    "no conditions": ("rule", "[{lost: A}]", "{}", ("SM004", "expected a mapping", "STATE")),
    "unknown join": ("rulle", WHOLE, "{}", ("SM004", "`rulle` is not a value of `join`", "`rule`")),
    "uncovered": ("rule", "[{lost: {A: slipped}}, {held: {A: done, B: done}}]", "{}",
                  ("SM401", "no rule of `BOTH` matches `A: done`, `B: slipped`", "")),
    "unknown level": ("rule", WHOLE, "{done: Hihg}",
                      ("SM004", "`Hihg` is not a value of `autonomy`", "`High`")),
    "unknown outcome": ("rule", WHOLE, "{doen: High}",
                        ("SM102", "`B` has no outcome `doen`", "`done`")),
}  # fmt: skip


def report_of(join: str, rules: str, levels: str) -> Report:
    text = SCRIPT.replace("JOIN", join).replace("RULES", rules).replace("LEVELS", levels)
    return analyse(Source("main.yml", text), LIBRARY, []).report


@pytest.mark.parametrize("name", FAULTS)
def test_faults(name: str) -> None:
    join, rules, levels, (code, message, help) = FAULTS[name]
    found = [item for item in report_of(join, rules, levels) if item.code == code]
    assert any(message in item.message for item in found), found
    assert any(help in (item.finding.help or "") for item in found), found


def test_a_level_for_an_unknown_outcome_is_no_transition() -> None:
    (found,) = report_of("rule", WHOLE, "{doen: High}")
    assert found.finding.effect == "the level of autonomy has no effect"


@pytest.mark.parametrize("join", ["rule", "all", "any"])
def test_rules_in_a_list_have_no_fault(join: str) -> None:
    report = report_of(join, WHOLE, "{done: Low}")
    assert [item.code for item in report if item.severity is Severity.ERROR] == []


def test_levels_are_those_of_the_state_with_its_sugar() -> None:
    text = """\
name: sm
outcomes: [held, lost]
states:
- A:
    template: ScriptedState
    outcomes: [done, slipped]
    retry: {on: [slipped], max: 2}
    autonomy: {done: Low, exhausted: Full}
    transitions: {done: held, exhausted: lost, preempted: lost}
"""
    checked = analyse(Source("main.yml", text), LIBRARY, []).checked
    assert checked is not None
    behavior = next(iter(build(checked, TARGET, LIBRARY, []).values()))
    lines = [line.strip() for line in behavior.split("\n") if "autonomy=" in line]
    assert [line.count("Autonomy.Off") for line in lines] == [2, 0]
    assert "'done': Autonomy.Low" in lines[1]
    assert "'exhausted': Autonomy.Full" in lines[1]
    assert "'preempted_': Autonomy.Inherit" in lines[1]
