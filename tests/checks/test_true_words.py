"""Statements of findings that hold for the script: loops that can be left, rules with `any`, names
that YAML 1.1 reads as booleans, and entries that SMACH ignores."""

from __future__ import annotations

import pytest

from tests.trust.project_text import analysed

LOOP = """\
name: sm
template: Base
outcomes: [stopped]
states:
  - TAKE:
      template: ScriptedState
      outcomes: [taken, nothing]
      transitions: {taken: COUNT, nothing: WAIT}
  - COUNT: {template: ScriptedState, outcomes: [ok], transitions: {ok: TAKE}}
  - WAIT:
      template: SleepState
      time: 2.0
      transitions: {succeeded: TAKE, preempted: stopped}
"""
BOTH = """\
name: sm
template: Base
outcomes: [safe]
states:
  - BOTH:
      template: Concurrence
      outcomes: [safe]
      outcome_map: {safe: {F: any, R: any}}
      transitions: {safe: safe}
      states:
        - F: {template: ScriptedState, outcomes: [ok, lost]}
        - R: {template: ScriptedState, outcomes: [ok, lost]}
"""


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("", "", "the loop of `COUNT`, `TAKE` contains no state that waits"),
        ("outcomes: [taken, nothing]\n      transitions: {taken: COUNT, nothing: WAIT}",
         "outcomes: [taken]\n      transitions: {taken: COUNT}",
         "the loop of `COUNT`, `TAKE` has no end and contains no state that waits"),
    ],
)  # fmt: skip
def test_a_loop_without_a_wait(old: str, new: str, message: str) -> None:
    assert old in LOOP
    script = LOOP.replace(old, new).replace(
        "outcomes: [stopped]", "outcomes: [stopped]\nforever: true"
    )
    found = [item for item in analysed({"main.yml": script}).report if item.code == "SM204"]
    assert [item.message for item in found] == [message]


@pytest.mark.parametrize(
    ("default", "help"),
    [
        ("", "write `default_outcome: safe` in place of the rule"),
        ("      default_outcome: safe\n", "write `default_outcome: safe` in place of the rule"),
        ("      default_outcome: other\n", "write conditions, as in `safe: {F: ok}`, or remove"
         " the rule"),
    ],
)  # fmt: skip
def test_a_rule_with_any_alone(default: str, help: str) -> None:
    script = BOTH.replace("      outcome_map", f"{default}      outcome_map")
    if "other" in default:
        script = script.replace("outcomes: [safe]\n      d", "outcomes: [safe, other]\n      d")
        script = script.replace("{safe: safe}", "{safe: safe, other: safe}")
    found = [item for item in analysed({"main.yml": script}).report if item.code == "SM403"]
    assert [(item.message, item.help) for item in found] == [
        ("the rule for `safe` has no conditions beside `any`, which stands for every outcome", help)
    ]


@pytest.mark.parametrize(("name", "entry"), [("no", '`"no": "no"`'), ("none", "`none: none`")])
def test_a_name_that_is_a_boolean(name: str, entry: str) -> None:
    script = (
        f'name: sm\ntemplate: Base\noutcomes: ["{name}"]\nstates:\n'
        f'  - A: {{template: ScriptedState, outcomes: ["{name}"]}}\n'
    )
    (found,) = [item for item in analysed({"main.yml": script}).report if item.code == "SM105"]
    assert found.help == f"add {entry} to the `transitions` of `A` to show that this is intended"


@pytest.mark.parametrize(
    ("type_", "effect"),
    [
        ("float?", "SMACH ignores the entry: the optional key `offset` stays unset"),
        ("float", "SMACH ignores the entry: `PUT` reads the key `offset`, not `above`"),
    ],
)
def test_an_entry_that_smach_ignores(type_: str, effect: str) -> None:
    script = f"""\
name: sm
template: Base
outcomes: [ok]
userdata: {{above: 0.1, offset: 0.1}}
states:
  - PUT:
      template: ScriptedState
      outcomes: [ok]
      input_keys: {{offset: "{type_}"}}
      remapping: {{ofset: above}}
      transitions: {{ok: ok}}
"""
    (found,) = [item for item in analysed({"main.yml": script}).report if item.code == "SM302"]
    assert (found.effect, found.help) == (effect, "did you mean `offset`?")
