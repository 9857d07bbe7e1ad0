"""What the simulated arm cannot reach (`smachac check --sim`)."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from smachac.analysis.context import Context
from smachac.checks.robot.workspace import poses_to_reach, unreachable
from smachac.commands.cli import main
from smachac.driver import read_machine
from smachac.frontend.files import disk_library, read_source
from smachac.ir.nodes import Machine

SCRIPT = """
name: sm
template: PyBulletBase
outcomes: [done, failed]
userdata: {userdata}
states:
  - GO:
      template: {type}
      remapping: {{pose: goal, offset: above}}
      {more}
      transitions: {{succeeded: done, aborted: failed{preempted}}}
"""

NEAR, FAR = "[[0.5, 0, 0.1], [1, 0, 0, 0]]", "[[0.5, 0, 1.9], [1, 0, 0, 0]]"


def machine_of(
    folder: Path, goal: str, above: str = "", type: str = "MoveAlongState", more: str = "doc: x"
) -> Machine:
    held = f"{{goal: {goal}" + (f", above: {above}" if above else "") + "}"
    preempted = ", preempted: failed" if type == "MoveAlongState" else ""
    path = folder / "main.yml"
    path.write_text(SCRIPT.format(userdata=held, type=type, more=more, preempted=preempted))
    source = read_source(path, [])
    assert source is not None
    machine = read_machine(source, disk_library(path, []), [])
    assert machine is not None
    return machine


@pytest.mark.parametrize(
    ("goal", "above", "type", "more", "reached"),
    [
        (NEAR, "", "MoveAlongState", "doc: x", True),
        (FAR, "", "MoveAlongState", "doc: x", False),
        (FAR, "", "PoseToJointPositionsState", "doc: x", False),
        (NEAR, "[[0, 0, 0.05], [0, 0, 0, 1]]", "MoveAlongState", "doc: x", True),
        (NEAR, "[[0, 0, 1.9], [0, 0, 0, 1]]", "MoveAlongState", "doc: x", False),
        (NEAR, "null", "MoveAlongState", "doc: x", True),
        # A block on the floor: its own pose looks up, the tool has to look down.
        ("[[0.5, 0, 0.1], [0, 0, 0, 1]]", "", "MoveAlongState", "grasp: true", True),
        ("[0.5, 0, 0.1]", "", "MoveAlongState", "grasp: true", True),
        ("[[0.5, 0, '`1.9`'], [1, 0, 0, 0]]", "", "MoveAlongState", "doc: x", True),
        (FAR, "", "MoveAlongState", "limb: other", True),
    ],
)
def test_poses(tmp_path: Path, goal: str, above: str, type: str, more: str, reached: bool) -> None:
    found = unreachable(machine_of(tmp_path, goal, above, type, more))
    assert [item.code for item in found] == ([] if reached else ["SM506"])


def test_an_offset_that_is_computed_is_not_guessed(tmp_path: Path) -> None:
    machine = machine_of(tmp_path, FAR, "[[0, 0, '`-1.8`'], [0, 0, 0, 1]]")
    assert list(poses_to_reach(Context(machine))) == []


def test_nothing_starts_without_a_pose(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    machine = machine_of(tmp_path, "null")
    monkeypatch.setitem(sys.modules, "smachac.sim", None)
    assert unreachable(machine) == []


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    machine_of(tmp_path, FAR)
    script = str(tmp_path / "main.yml")
    assert main(["check", script]) == 0
    assert "SM506" not in capsys.readouterr().out
    assert main(["check", script, "--sim", "--strict"]) == 1
    assert "`GO` cannot reach (0.500, 0.000, 1.900)" in capsys.readouterr().out


def test_without_a_simulation_it_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from smachac.sim import inverse_kinematics
    from smachac.sim.physics import SimUnavailable

    def missing(robot: object) -> None:
        raise SimUnavailable("PyBullet is not installed")

    machine_of(tmp_path, FAR)
    monkeypatch.setattr(inverse_kinematics, "Kinematics", missing)
    assert main(["check", str(tmp_path / "main.yml"), "--sim"]) == 2
    assert "PyBullet is not installed" in capsys.readouterr().err
