"""SM302: the keys that a remapping to an unset key can mean: of its type, those that nothing reads
first."""

from __future__ import annotations

import pytest

from tests.trust.judged_repairs import printed

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
WRITE = "write `positions: approach`"


def found(
    to: str, joints: str = "approach", preset: str = "x: 1", type_: str = '"list[float<rad>]"'
) -> list[tuple[str, str, str]]:
    text = PICK.replace("JOINTS", joints).replace("TO}", f"{to}}}").replace("PRESET", preset)
    types = {name: each.replace("TYPE", type_) for name, each in TYPES.items()}
    every = printed({"main.yml": text, **types})
    return [item for item in every if item[:2] != ("SM305", "x")]


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
    every = [item for item in found(to, joints, preset) if item[1] != "hover_offset"]
    ((code, place, text),) = every
    assert (code, place) == ("SM302", to)
    assert text.startswith(help)


def test_a_preset_that_nothing_reads() -> None:
    preset = 'home: {type: "list[float<rad>]", value: [0.1, 0.2]}'
    text = PICK.replace("JOINTS", "unused").replace("TO}", "start}").replace("PRESET", preset)
    text = text.replace(text[text.index("  - PLAN") : text.index("  - MOVE")], "")
    text = text.replace("  pick_pose: [[0.5, 0.0, 0.1], [0.0, 0.0, 0.0, 1.0]]\n", "")
    types = {
        "templates/Move.yml": TYPES["templates/Move.yml"].replace("TYPE", '"list[float<rad>]"')
    }
    ((code, place, help),) = printed({"main.yml": text, **types})
    assert (code, place) == ("SM302", "start")
    assert help.startswith("write `positions: home`")


def test_a_key_of_another_type_is_not_meant() -> None:
    """`pick_pose` is a pose, and no number."""
    ((code, word, help),) = found("pick", type_="float")
    assert (code, word) == ("SM302", "pick")
    assert "pick_pose" not in help
    ((_, _, help),) = found("pick", type_="Pose")
    assert help.startswith("write `positions: pick_pose`")
