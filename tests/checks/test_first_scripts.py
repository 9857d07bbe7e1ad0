"""Slips in the scripts of people who know another tool: one finding at the fault, and a help that
shows what to write."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from smachac.diagnostics.diagnostic import Severity
from tests.trust.project_text import analysed

PATROL = """\
name: patrol
outcomes: [succeeded, aborted]
userdata: {blocks: [red, green]}
states:
  - LOOK:
      template: ScriptedState
      input_keys: [blocks]
      outcomes: [found, nothing]
      transitions: {found: GRAB, nothing: aborted}
  - GRAB:
      template: ScriptedState
      outcomes: [held, slipped]
      transitions: {held: BOTH, slipped: LET_GO}
  - BOTH:
      template: Concurrence
      outcomes: [ready, not_ready]
      default_outcome: not_ready
      outcome_map: {ready: {LIGHT: done, DRIVE: done}}
      transitions: {ready: succeeded, not_ready: EACH}
      states:
        - LIGHT: {template: ScriptedState, outcomes: [done]}
        - DRIVE: {template: ScriptedState, outcomes: [done, lost]}
  - EACH:
      template: Iterator
      outcomes: [counted, aborted]
      input_keys: [blocks]
      it: blocks
      it_label: block
      exhausted_outcome: placed
      loop_outcomes: [put]
      final_outcome_map: {placed: counted, put: aborted}
      transitions: {counted: succeeded, aborted: LET_GO}
      states:
        - PUT:
            template: ScriptedState
            input_keys: [block]
            outcomes: [put, aborted]
  - LET_GO:
      template: ScriptedState
      outcomes: [open]
      transitions: {open: aborted}
"""


def reported(files: Mapping[str, str]) -> list[tuple[str, str, str | None]]:
    """Code, text at the place, and help of each finding above an info."""
    return [
        (item.code, item.span.text, item.finding.help)
        for item in analysed(files).report
        if item.severity is not Severity.INFO
    ]


def test_the_script_has_no_fault() -> None:
    assert reported({"main.yml": PATROL}) == []


MAPPINGS = [
    (
        "{found: GRAB, nothing: aborted}",
        "[found: GRAB, nothing: aborted]",
        "SM004",
        "write it as `{found: GRAB, nothing: aborted}`",
    ),
    (
        "{found: GRAB, nothing: aborted}",
        "{found: GRAB, [nothing]: aborted}",
        "SM004",
        "write an entry for each name: `nothing: aborted`",
    ),
    ("{blocks: [red, green]}", "[blocks]", "SM004", "write it as `{blocks: VALUE}`"),
    (
        "{held: BOTH, slipped: LET_GO}",
        "{held: BOTH slipped: LET_GO}",
        "SM001",
        "write a `,` before `slipped`, or put text that contains `:` in quotes",
    ),
    ("    it: blocks", "    it: 3", "SM004", "a loop of 3 turns has the items `[0, 1, 2]`"),
    (
        "    it: blocks",
        "    it: 30",
        "SM004",
        "a loop of 30 turns has the items '`range(30)`', with",
    ),
    (
        "default_outcome: not_ready",
        "join: first\n      default_outcome: not_ready",
        "SM004",
        "any`",
    ),
    (
        "default_outcome: not_ready",
        "join: ayn\n      default_outcome: not_ready",
        "SM004",
        "`any`?",
    ),
    (
        "states:\n  - LOOK",
        "on_error: {TimeoutError: LET_GO}\nstates:\n  - LOOK",
        "SM004",
        ": LET_GO`",
    ),
    ("states:\n  - LOOK", "robot: [panda, baxter]\nstates:\n  - LOOK", "SM004", "with `parts:`"),
    ("  - GRAB:\n", "    GRAB:\n", "SM004", "begin another item with `- GRAB:`"),
    ("  - GRAB:\n", "---\n  - GRAB:\n", "SM004", "remove the `---`: a script is one document"),
    (
        "default_outcome: not_ready",
        "initial: DRIVE\n      default_outcome: not_ready",
        "SM003",
        "only `Sequence` and `StateMachine` and the script itself can have `initial`",
    ),
    (
        "      outcomes: [held, slipped]",
        "      outcomes: [held, slipped]\n      scene: table.yml",
        "SM003",
        "write it at the top of the script: no state has `scene`",
    ),
    (
        "      outcomes: [held, slipped]",
        "      outcomes: [held, slipped]\n     \u00a0steps: []",
        "SM001",
        "replace it with spaces",
    ),
    (
        "      outcomes: [held, slipped]",
        "\u00a0     outcomes: [held, slipped]",
        "SM001",
        "replace it with spaces",
    ),
]


@pytest.mark.parametrize(("before", "after", "code", "help"), MAPPINGS)
def test_a_slip_is_one_finding_that_shows_what_to_write(
    before: str, after: str, code: str, help: str
) -> None:
    assert PATROL.count(before) == 1
    (found,) = reported({"main.yml": PATROL.replace(before, after)})
    assert found[0] == code
    assert help in (found[2] or "")


CALL = """\
name: pick
outcomes: [succeeded]
states:
  - LEFT:
      script: grip
      params: {limb: left}
      transitions: {done: succeeded}
"""
GRIP = """\
- GRIP:
    template: ScriptedState
    doc: [params, limb]
    outcomes: [done]
"""


def test_a_param_beside_params() -> None:
    main = CALL.replace("params: {limb: left}", "limb: left")
    assert reported({"main.yml": main, "grip.yml": GRIP}) == [
        ("SM003", "limb", "`limb` is a param of the sub-script: write it inside `params:`")
    ]


@pytest.mark.parametrize("word", ["param", "parmas", "Params"])
def test_a_misspelt_look_up(word: str) -> None:
    grip = GRIP.replace("[params,", f"[{word},")
    assert reported({"main.yml": CALL, "grip.yml": grip}) == [
        ("SM004", word, "did you mean `[params, limb]`?")
    ]


def test_a_list_whose_second_text_is_no_param() -> None:
    grip = GRIP.replace("[params, limb]", "[params, limb]\n    steps: [param, left]")
    assert "SM004" not in [code for code, _, _ in reported({"main.yml": CALL, "grip.yml": grip})]


def test_a_look_up_in_the_braces_of_jinja() -> None:
    grip = GRIP.replace("[params, limb]", "{{ params.limb }}")
    assert reported({"main.yml": CALL, "grip.yml": grip}) == [
        ("SM004", "{{ params.limb }}", "a param is looked up with `[params, limb]`")
    ]


def test_a_loop_in_words() -> None:
    main = PATROL.replace(
        "      transitions: {held: BOTH, slipped: LET_GO}",
        "      for_each: block in blocks\n      input_keys: [block]\n"
        "      transitions: {held: BOTH, slipped: LET_GO, preempted: aborted}",
    )
    assert reported({"main.yml": main})[-1:] == [
        ("SM004", "block in blocks", "write `for_each: {item: block, in: blocks}`")
    ]


def test_an_interface_with_a_list_of_outcomes() -> None:
    grab = "name: Grab\noutcomes: [held, slipped]\n"
    main = PATROL.replace("ScriptedState\n      outcomes: [held, slipped]", "Grab")
    assert reported({"main.yml": main, "templates/Grab.yml": grab}) == [
        ("SM004", "[held, slipped]", "write it as `{held: {}, slipped: {}}`")
    ]
