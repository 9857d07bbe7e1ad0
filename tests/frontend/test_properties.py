"""Properties as scripts have them: the meaning of each form, and what is wrong with others."""

from __future__ import annotations

import textwrap

import pytest

from smachac.diagnostics.source import Source
from smachac.driver import Analysis, analyse
from smachac.frontend.loader import memory_library
from smachac.ir.properties import in_words
from tests.support.typed_machines import BUILT_IN

STATES = """\
name: sm
template: Base
outcomes: [done, stopped]
states:
  - A:
      template: ScriptedState
      outcomes: [done]
      tags: [safe]
      claims: [arm.left]
      transitions: {done: B}
  - B:
      template: StateMachine
      outcomes: [done]
      transitions: {done: C}
      states:
        - IN: {template: ScriptedState, outcomes: [done], transitions: {done: done}}
  - C:
      template: StateMachine
      outcomes: [done, again]
      transitions: {done: done, again: B}
      states:
        - IN:
            template: ScriptedState
            outcomes: [done, again]
            timeout: 1s
            transitions: {timeout: done, preempted: done}
"""


def analysed(properties: str, **files: str) -> Analysis:
    text = STATES + "properties:" + properties
    library = memory_library({f"{name}.yml": each for name, each in files.items()}, BUILT_IN)
    return analyse(Source("main.yml", text), library, [])


def listed(items: str) -> str:
    return "\n" + textwrap.indent(textwrap.dedent(items).strip(), "  ") + "\n"


def faults(items: str) -> list[str]:
    """The findings about properties: code, text of the place, help."""
    found = analysed(listed(items)).report
    return [
        f"{item.code} {item.span.text} | {item.help}"
        for item in found
        if item.code in ("SM003", "SM004", "SM701", "SM702", "SM703", "SM704")
    ]


def test_every_form_is_read() -> None:
    items = """
        - never: {after: A, until: [B, "B:done"], enter: tag safe}
        - before: {B: A, C: A}
        - {name: goes on, after: {"A:done": [B]}}
        - whenever: {B: C, within: 2 states, before_claim: [arm.left, arm.right]}
        - at_most: {type ScriptedState: 7}
        - always_ends
        - always_ends: true
          stops: false
          exceptions: none
    """
    machine = analysed(listed(items)).machine
    assert machine is not None
    assert [in_words(property_.form) for property_ in machine.properties] == [
        "never `tag safe` after `A` until `B` or `B:done`",
        "`A` before `B`",
        "`A` before `C`",
        "`B` after `A:done`",
        "`C` after `B` within 2 states before `claim arm.left` or `claim arm.right`",
        "`type ScriptedState` at most 7 times",
        "always ends",
        "always ends",
    ]
    assert machine.properties[3].name == "goes on"
    assert (machine.properties[7].stops, machine.properties[7].exceptions) == (False, "none")


def test_properties_in_a_file() -> None:
    machine = analysed(" safety.yml\n", safety="- before: {B: A}\n").machine
    assert machine is not None
    assert [property_.name for property_ in machine.properties] == ["`A` before `B`"]
    (finding,) = [
        item for item in analysed(" safty.yml\n", safety="[]").report if item.code == "SM004"
    ]
    assert finding.span.text == "safty.yml"
    assert finding.help == "did you mean `safety.yml`?"


@pytest.mark.parametrize(
    ("items", "expected"),
    [
        ("- nevr: {enter: A}", "SM004 nevr | did you mean `never`?"),
        ("- never: {after: A, enters: B}", "SM004 enters | did you mean `enter`?"),
        ("- alway_ends", "SM004 alway_ends | did you mean `always_ends`?"),
        ("- {name: x}", "SM004 {name: x} | use one of `after`"),
        ("- {before: {B: A}, after: {A: B}}", "SM004 after | begin another item"),
        ("- before: [A, B]", "SM004 [A, B] | write it like `before: {CLOSE: OPEN}`"),
        ("- after: {A: {B: C}}", "SM004 {B: C} | write a name"),
        ("- at_most: {B: many}", "SM004 many | write it like `3`"),
        ("- at_most: {B: 0}", "SM004 0 | write `never: {enter: B}`"),
        ("- whenever: {B: C, within: soon}", "SM004 soon | write it like `3 states`"),
        ("- whenever: {within: 3 states}", "SM004 {within: 3 states} | write it like"),
        ("- {before: {B: A}, exceptions: al}", "SM004 al | did you mean `all`?"),
        ("- {before: {B: A}, stops: sometimes}", "SM004 sometimes | write `stops: false`"),
        ("- before: {B: A b}", "SM004 A b | write a state"),
        ("- before: {B: 'A:'}", "SM004 'A:' | write a state"),
        ("- before: {B: AA}", "SM703 AA | did you mean `A`?"),
        ("- before: {C: IN}", "SM703 IN | write more of its path"),
        ("- before: {C: tag save}", "SM703 tag save | did you mean `safe`?"),
        ("- before: {C: type ScriptedStat}", "SM703 type ScriptedStat | did you mean"),
        ("- before: {C: safe}", "SM703 safe | `safe` is a tag: write `tag safe`"),
        ("- before: {C: ScriptedState}", "SM703 ScriptedState | `ScriptedState` is a type: write"),
        ("- before: {C: 'arm.left:done'}", "SM703 'arm.left:done' | `arm.left` is a claim: write"),
        ("- before: {C: claim leg}", "SM703 claim leg | use one of `arm`, `arm.left`"),
        ("- before: {C: 'A:don'}", "SM703 'A:don' | did you mean `done`?"),
    ],
)  # fmt: skip
def test_a_fault_is_at_its_word_with_its_cure(items: str, expected: str) -> None:
    (fault,) = faults(items)
    assert fault.startswith(expected)


def test_names_are_ends_of_paths_also_where_sugar_repeats_a_name() -> None:
    assert faults("- at_most: {B/IN: 1000}")[0].startswith("SM701")
    assert faults("- after: {C/IN: C, 'C/IN:timeout': 'C:done'}")[0].startswith("SM701")
    assert faults("- before: {C/IN: B/IN}\n- before: {'C:again': 'claim arm:done'}") == []
    assert faults("- before: {'C/IN:timeout': C/IN}") == []


def test_an_item_with_only_a_name() -> None:
    split = "- name: no B after A\n- never: {after: A, enter: B}"
    line = STATES.count("\n") + 3
    help = f"remove the `-` before `never` in line {line}"
    first, second = faults(split)
    assert first == f"SM004 name: no B after A | {help}"
    assert second.startswith("SM701 never")  # the form is read
    named = split.replace("- never", "- name: two\n  never")
    assert faults(named)[0].startswith("SM004 name: no B after A | use one of `after`")
