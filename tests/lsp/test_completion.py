"""Completion: which words are offered, also in texts that are not complete."""

from __future__ import annotations

import os
import random
from pathlib import Path

import pytest

from bench.lsp_completion import places
from smachac.lsp.completion import complete
from smachac.lsp.session import Session

MAIN = """\
name: robot
template: Base
outcomes: [succeeded, aborted]
userdata: {goal: door, tries: 0}
states:
- GO:
    template: Concurrence
    outcomes: [there, lost]
    default_outcome: lost
    outcome_map:
      there: {DRIVE: arrived, WATCH: succeeded}
    transitions: {there: LOOK, lost: aborted}
    states:
    - DRIVE:
        template: ScriptedState
        outcomes: [arrived, stuck]
    - WATCH: {template: SleepState, time: 1}
- LOOK:
    template: PrintUserdataState
    input_keys: [goal]
    transitions: {succeeded: succeeded}
"""


def offered(text: str, folder: Path) -> list[str]:
    """The words at the `|` of a text."""
    offset = text.index("|")
    text = text.replace("|", "", 1)
    path = os.path.realpath(folder / "main.yml")
    session = Session([folder])
    session.change(path, text)
    return [item.word for item in complete(text, offset, path, session.view(path))]


@pytest.mark.parametrize(
    ("old", "new", "first"),
    [
        ("there: LOOK", "there: |", ["LOOK"]),
        ("lost: aborted", "lost: |", ["aborted"]),
        ("there: {DRIVE: arrived, WATCH", "there: {DRIVE: |, WATCH", ["arrived", "stuck"]),
        ("WATCH: succeeded}", "|: succeeded}", ["WATCH"]),
        ("default_outcome: lost", "default_outcome: |", ["lost"]),
        ("input_keys: [goal]", "input_keys: [|]", ["goal", "tries"]),
        ("template: PrintUserdataState", "template: Pr|", ["PrintUserdataState"]),
        ("{goal: door, ", "{|, ", ["goal"]),
        ("transitions: {succeeded: succeeded}", "|", ["transitions"]),
        ("transitions: {succeeded: succeeded}", "tra|", ["transitions"]),
        ("transitions: {succeeded: succeeded}", "transitions: {|", ["succeeded"]),
        ("transitions: {succeeded: succeeded}", "transitions: {succeeded: suc|", ["succeeded"]),
        ("transitions: {succeeded: succeeded}", "transitions:\n      |", ["succeeded"]),
        ("outcomes: [arrived, stuck]", "outcomes: [arrived, |", ["succeeded", "aborted"]),
        ("{template: SleepState, time: 1}", "{template: SleepState, |}", ["time"]),
        ("{template: SleepState, time: 1}", "{template: SleepState, |", ["time"]),
        ("outcomes: [there, lost]", "join: |\n    outcomes: [there, lost]", ["all", "any"]),
        ("{goal: door, tries: 0}", "{goal: {type: f|, value: 1}}", []),
    ],
)
def test_words(tmp_path: Path, old: str, new: str, first: list[str]) -> None:
    assert old in MAIN
    found = offered(MAIN.replace(old, new, 1), tmp_path)
    assert found[: len(first)] == first
    assert found


def test_words_of_a_text_with_errors_elsewhere(tmp_path: Path) -> None:
    text = MAIN.replace("outcomes: [arrived, stuck]", "outcomes: [arrived, stuck")
    text = text.replace("userdata: {goal: door, tries: 0}", "userdata: {goal: door: tries}")
    found = offered(text.replace("there: LOOK", "there: |"), tmp_path)
    assert found[0] == "LOOK"


def test_no_words_where_nothing_is_known(tmp_path: Path) -> None:
    assert offered("|", tmp_path) == []
    assert offered("# |", tmp_path) == []
    assert offered(MAIN.replace("goal: door", "goal: |"), tmp_path) == []


def test_params_and_sub_scripts(tmp_path: Path) -> None:
    (tmp_path / "wave.yml").write_text(
        "- WAVE:\n    template: SleepState\n    time: [params, pause]\n", "utf-8"
    )
    call = "- WAVE: {script: |}\n"
    assert offered(MAIN + call, tmp_path) == ["wave"]
    assert offered(MAIN + "- WAVE: {script: wave, params: {|}}\n", tmp_path) == ["pause"]
    found = offered(MAIN + "- WAVE: {script: wave, transitions: {|}}\n", tmp_path)
    assert found == ["succeeded", "preempted"]
    with_params = MAIN.replace("userdata:", "params: {pause: 1}\nuserdata:")
    look_up = with_params.replace("time: 1", "time: [params, |]")
    assert offered(look_up, tmp_path) == ["pause"]
    assert offered(with_params.replace("time: 1", "time: [[|]]"), tmp_path) == ["pause"]


ARM = """\
name: arm
template: PyBulletBase
robot: baxter
outcomes: [succeeded, aborted]
userdata: {part: [[0.5, 0.0, 0.1], [0.0, 0.0, 0.0, 1.0]]}
states:
- LOAD:
    template: LoadModelState
    model_name: block
    body: part_1
    remapping: {pose: part}
    transitions: {succeeded: GRIP, aborted: aborted}
- GRIP:
    template: GripperState
    limb: left
    command: close
    transitions: {succeeded: CHECK, aborted: aborted, preempted: aborted}
- CHECK:
    template: CheckGraspState
    limb: left
    body: part_1
    transitions: {succeeded: succeeded, aborted: aborted}
"""


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("robot: baxter", "robot: |", ["panda", "baxter", "iiwa"]),
        ("limb: left", "limb: |", ["left", "right"]),
        ("command: close", "command: |", ["open", "close"]),
        ("model_name: block", "model_name: |", ["block", "brick"]),
        ("    body: part_1\n    transitions", "    body: |\n    transitions", ["part_1"]),
    ],
)
def test_names_of_the_robot_and_its_world(
    old: str, new: str, found: list[str], tmp_path: Path
) -> None:
    assert old in ARM
    assert offered(ARM.replace(old, new, 1), tmp_path)[: len(found)] == found


def test_joints_are_those_of_the_robot_and_frames_those_of_the_script(tmp_path: Path) -> None:
    (tmp_path / "templates").mkdir()
    (tmp_path / "templates" / "Turn.yml").write_text(
        "name: Turn\nvariables: {joint: {names: joint}, of: {names: frame}}\noutcomes: {done: {}}\n"
    )
    state = "- TURN: {template: Turn, joint: left_s0, of: base, transitions: {done: succeeded}}\n"
    joints = offered(ARM + state.replace("left_s0", "|"), tmp_path)
    assert "left_s0" in joints
    assert len(joints) >= 14
    text = ARM.replace("robot: baxter", "robot: baxter\nframes: [camera]")
    assert offered(text + state.replace("base", "|"), tmp_path) == ["camera"]


@pytest.mark.parametrize(
    ("old", "new", "first"),
    [
        ("limb: left", "|: left", "limb"),
        ("command: close", "|: close", "command"),
        ("transitions: {succeeded: GRIP", "|: {succeeded: GRIP", "transitions"),
        ("template: PyBulletBase", "|: PyBulletBase", "template"),
        ("outcomes: [succeeded, aborted]", "|: [succeeded, aborted]", "outcomes"),
        ("PyBulletBase", "|", "PyBulletBase"),
    ],
)
def test_a_field_fits_the_value_behind_it(old: str, new: str, first: str, tmp_path: Path) -> None:
    assert old in ARM
    assert offered(ARM.replace(old, new, 1), tmp_path)[0] == first


def test_a_misspelt_field_of_a_similar_state_is_not_offered(tmp_path: Path) -> None:
    state = "- AGAIN:\n    template: LoadModelState\n    |: block\n"
    found = offered(ARM.replace("model_name:", "model_nmae:", 1) + state, tmp_path)
    assert found[0] == "model_name"
    assert "model_nmae" not in found


@pytest.mark.slow
def test_the_word_that_was_deleted_is_first() -> None:
    # Nearly all outcomes of example 14 are names of its own, which stand nowhere else.
    known = [place for place in places() if place[0].parent.name != "14_delivery_round"]
    chosen = random.Random(0).sample(known, 100)
    first = 0
    for path, word, _ in chosen:
        whole = path.read_text("utf-8")
        text = whole[: word.start] + whole[word.end :]
        session = Session([path.parent])
        session.change(str(path), text)
        found = complete(text, word.start, str(path), session.view(str(path)))
        first += bool(found) and found[0].word == word.value
    assert first >= 88
