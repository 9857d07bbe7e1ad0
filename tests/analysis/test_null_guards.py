"""Null guards: a nullable key may be read as its type where a state has excluded null."""

from __future__ import annotations

import pytest

from tests.trust.project_text import analysed

MAIN = """\
name: sm
template: Base
outcomes: [succeeded, failed, preempted]
userdata:
  PRESET
states:
  - CHECK:
      template: ConditionalOutcomeState
      input_keys: {goal: "Pose?"}
      outcomes: [is_set]
      callbacks: {is_set: 'CONDITION'}
      default_outcome: is_null
      transitions: {is_set: IF, is_null: ELSE}
  - MOVE:
      template: Move
      remapping: {pose: goal}
      transitions: {succeeded: succeeded, aborted: failed, preempted: preempted}
  - OTHER:
      template: Other
      remapping: {pose: goal}
      transitions: {done: failed, again: CHECK}
"""
MOVE = "input_keys: {pose: Pose}\noutcomes: {succeeded: {}, aborted: {}, preempted: {}}\n"
OTHER = 'input_keys: {pose: "Pose?"}\noutcomes: {done: {}, again: {}}\n'
PRESETS = ['goal: {type: "Pose?", value: null}', "goal: null"]


def clashes(text: str, move: str = MOVE, other: str = OTHER) -> list[str]:
    files = {"main.yml": text, "templates/Move.yml": move, "templates/Other.yml": other}
    return [item.code for item in analysed(files).report if item.code == "SM304"]


def script(preset: str, condition: str, yes: str = "MOVE", no: str = "OTHER") -> str:
    text = MAIN.replace("PRESET", preset).replace("CONDITION", condition)
    return text.replace("IF,", f"{yes},").replace("ELSE", no)


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize(
    ("condition", "yes", "no"),
    [
        ("lambda ud: ud.goal is not None", "MOVE", "OTHER"),
        ("lambda u: u.goal != None", "MOVE", "OTHER"),
        ("lambda ud: None is not ud.goal", "MOVE", "OTHER"),
        ("lambda ud: ud.goal", "MOVE", "OTHER"),
        ("lambda ud: bool(ud['goal'])", "MOVE", "OTHER"),
        ("lambda ud: ud.goal is None", "OTHER", "MOVE"),
        ("lambda ud: not ud.goal", "OTHER", "MOVE"),
        ("lambda ud: ud.goal is not None and ud.goal[0][2] > 0.1", "MOVE", "OTHER"),
        ("lambda ud: ud.goal is None or ud.goal[0][2] > 0.1", "OTHER", "MOVE"),
        ("lambda ud: not (ud.goal is None or ud.goal[0][2] > 0.1)", "MOVE", "OTHER"),
    ],
)
def test_a_guarded_read(preset: str, condition: str, yes: str, no: str) -> None:
    assert clashes(script(preset, condition, yes, no)) == []


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize(
    ("condition", "yes", "no"),
    [
        ("lambda ud: ud.goal is not None", "OTHER", "MOVE"),
        ("lambda ud: ud.goal is None", "MOVE", "OTHER"),
        ("lambda ud: ud.goal is not None or 1 > 0", "MOVE", "OTHER"),
        ("lambda ud: ud.goal is None and 1 > 0", "OTHER", "MOVE"),
        ("lambda ud: ud.goal is not None", "MOVE", "MOVE"),
    ],
)
def test_an_unguarded_read(preset: str, condition: str, yes: str, no: str) -> None:
    assert clashes(script(preset, condition, yes, no).replace("again: CHECK", "again: failed"))


def test_a_state_that_takes_a_nullable_key_and_decides_is_a_guard() -> None:
    text = MAIN.replace("PRESET", PRESETS[0]).replace("CHECK:", "GONE:", 1)
    text = text.replace("template: Other", "template: Other", 1).replace(
        "again: CHECK", "again: MOVE"
    )
    text = text[: text.index("  - GONE")] + text[text.index("  - MOVE") :]
    text = text.replace("states:\n", "initial: OTHER\nstates:\n")
    assert clashes(text) == []
    single = OTHER.replace(", again: {}", "")
    assert clashes(text.replace("{done: failed, again: MOVE}", "{done: MOVE}"), other=single)


def test_a_null_written_after_the_guard() -> None:
    text = script(PRESETS[0], "lambda ud: ud.goal is not None", "OTHER", "OTHER")
    lose = 'outcomes: {done: {}, again: {}}\noutput_keys: {pose: "Pose?"}\n'
    assert clashes(text.replace("again: CHECK", "again: MOVE"), other=lose)
    find = lose.replace("Pose?", "Pose")
    assert clashes(text.replace("again: CHECK", "again: MOVE"), other=find) == []
