"""A state or an outcome is renamed in the properties of a script too."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.commands.cli import main

SCRIPT = """\
name: sm
template: Base
outcomes: [done]
properties:
  - before: {"PICK/GRASP:held": tag safe, PICK: LOOK}
  - never: {after: LOOK, until: ["GRASP", 'PICK:held'], enter: LOOK}
states:
  - LOOK:
      {template: ScriptedState, outcomes: [held], tags: [safe], transitions: {held: PICK}}
  - PICK:
      template: StateMachine
      outcomes: [held]
      transitions: {held: done}
      states:
        - GRASP: {template: ScriptedState, outcomes: [held]}
"""


@pytest.mark.parametrize(
    ("path", "new", "before", "until"),
    [
        ("PICK", "TAKE", '{"TAKE/GRASP:held": tag safe, TAKE: LOOK}', "['GRASP', 'TAKE:held']"),
        ("GRASP", "HOLD", '{"PICK/HOLD:held": tag safe, PICK: LOOK}', "['HOLD', 'PICK:held']"),
        (
            "sm/PICK/held",
            "got",
            '{"PICK/GRASP:held": tag safe, PICK: LOOK}',
            "['GRASP', 'PICK:got']",
        ),
    ],
)
def test_names_in_properties(path: str, new: str, before: str, until: str, tmp_path: Path) -> None:
    script = tmp_path / "main.yml"
    script.write_text(SCRIPT, "utf-8")
    assert main(["rename", str(script), path, new]) == 0
    text = script.read_text("utf-8")
    assert f"before: {before}" in text
    assert f"until: {until}" in text.replace('"GRASP"', "'GRASP'").replace('"HOLD"', "'HOLD'")
