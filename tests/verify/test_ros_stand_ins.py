"""Machines with ROS states are verified without ROS, for both of its versions."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import pytest

from smachac.commands.cli import main

CASES = Path(__file__).parents[1] / "cases" / "ros"


@pytest.mark.parametrize("name", ["ros_1", "ros_2"])
def test_every_ros_state_is_played(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    before = dict(sys.modules)
    script = str(CASES / name / "main.yml")
    assert main(["verify", script, "--paths", "40", "--targets", "python"]) == 0
    assert capsys.readouterr().out.endswith("python: agrees\n")
    left = set(sys.modules) - set(before)
    assert not [item for item in left if item.startswith(("rospy", "rclpy", "smach_ros"))]


@pytest.mark.parametrize("name", ["ros_1", "ros_2"])
def test_a_program_on_disk_is_compared(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    program = tmp_path / "patrol.py"
    shutil.copy(CASES / name / "expected" / "python" / "patrol.py", program)
    script = str(CASES / name / "main.yml")
    given = ["verify", script, "--paths", "40", "--program", str(program)]
    assert main(given) == 0
    text = program.read_text("utf-8")
    changed = text.replace('"succeeded": "COUNT_AGAIN"', '"succeeded": "ENABLE"', 1)
    assert changed != text
    program.write_text(changed, encoding="utf-8")
    assert main(given) == 1
    assert "COUNT_AGAIN" in capsys.readouterr().out


def test_the_runtime_is_the_same_afterwards() -> None:
    from smachac.runtime import smach_ros

    assert main(["verify", str(CASES / "ros_1" / "main.yml"), "--paths", "3"]) == 0
    from smachac.runtime import smach_ros as again

    assert again is smach_ros
    assert sys.modules["smachac.runtime.smach_ros"] is smach_ros
