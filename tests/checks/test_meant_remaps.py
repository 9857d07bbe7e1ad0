"""SM302: the key that a remapping to an unset key means: one that nothing reads and whose type
fits, never one of another type."""

from __future__ import annotations

import pytest

from tests.checks.test_first_scripts import reported

PICK = """\
name: pick
template: Base
outcomes: [done]
userdata:
  pick_pose: [[0.5, 0.0, 0.1], [0.0, 0.0, 0.0, 1.0]]
  PRESET
states:
  - PLAN:
      template: Plan
      remapping: {pose: pick_pose, joints: JOINTS}
      transitions: {ok: MOVE}
  - MOVE:
      template: Move
      remapping: {positions: TO}
      transitions: {ok: done}
"""
TYPES = {
    "templates/Plan.yml": "name: Plan\ninput_keys: {pose: Pose, offset: Pose?}\n"
    'output_keys: {joints: "list[float<rad>]"}\noutcomes: [ok]\n',
    "templates/Move.yml": "name: Move\ninput_keys: {positions: TYPE}\noutcomes: [ok]\n",
}
OFFSET = "hover_offset: [[0.0, 0.0, 0.1], [0.0, 0.0, 0.0, 1.0]]"
WRITE = "write `positions: approach`, which `PLAN` sets"


def found(
    to: str, joints: str = "approach", preset: str = "x: 1", type_: str = '"list[float<rad>]"'
) -> list[tuple[str, str, str | None]]:
    text = PICK.replace("JOINTS", joints).replace("TO}", f"{to}}}").replace("PRESET", preset)
    types = {name: each.replace("TYPE", type_) for name, each in TYPES.items()}
    every = reported({"main.yml": text, **types})
    return [each for each in every if each[:2] != ("SM305", "x")]


@pytest.mark.parametrize(
    ("to", "joints", "preset", "help"),
    [
        ("hover_joints", "approach", "x: 1", WRITE),
        ("hover_joints", "approach", OFFSET, WRITE),
        ("target", "approach", OFFSET, WRITE),
        ("aproach", "approach", OFFSET, "did you mean `approach`?"),
        ("approach_joints", "approach", OFFSET, "did you mean `approach`?"),
        ("pick_pos", "approach", "x: 1", WRITE),
    ],
)
def test_a_result_that_nothing_reads(to: str, joints: str, preset: str, help: str) -> None:
    every = [each for each in found(to, joints, preset) if each[1] != "hover_offset"]
    assert every == [("SM302", to, help)]


def test_a_preset_that_nothing_reads() -> None:
    preset = 'home: {type: "list[float<rad>]", value: [0.1, 0.2]}'
    text = PICK.replace("JOINTS", "unused").replace("TO}", "start}").replace("PRESET", preset)
    text = text.replace(text[text.index("  - PLAN") : text.index("  - MOVE")], "")
    text = text.replace("  pick_pose: [[0.5, 0.0, 0.1], [0.0, 0.0, 0.0, 1.0]]\n", "")
    types = {
        "templates/Move.yml": TYPES["templates/Move.yml"].replace("TYPE", '"list[float<rad>]"')
    }
    assert reported({"main.yml": text, **types}) == [("SM302", "start", "write `positions: home`")]


def test_a_key_of_another_type_is_not_meant() -> None:
    """`pick_pose` is a pose, and no number."""
    ((code, word, help),) = found("pick", type_="float")
    assert (code, word) == ("SM302", "pick")
    assert "pick_pose" not in (help or "")
    assert found("pick", type_="Pose") == [("SM302", "pick", "did you mean `pick_pose`?")]


def test_a_number_needs_a_word_in_common() -> None:
    preset = "speed_limit: 0.5\n  x: 1"
    every = found("max_force", preset=preset, type_="float")
    assert all("speed_limit" not in (each[2] or "") for each in every if each[0] == "SM302")
