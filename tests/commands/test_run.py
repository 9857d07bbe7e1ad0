"""The command `run`: wrong usage, and what it reports before and after a run."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from smachac.commands.cli import main

WAIT = """\
name: wait
outcomes: [succeeded, preempted]
states:
  - WAIT:
      template: SleepState
      time: 0.01
      transitions: {succeeded: succeeded, preempted: preempted}
"""
ROS_1 = "ros = 1\n"


@pytest.fixture
def script(tmp_path: Path) -> Path:
    path = tmp_path / "main.yml"
    path.write_text(WAIT)
    return path


@pytest.mark.parametrize("project", ["", ROS_1])
def test_a_script_without_a_node_is_not_run_as_one(
    project: str, script: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (script.parent / "smachac.toml").write_text(project)
    assert main(["run", str(script), "--ros"]) == 2
    printed = capsys.readouterr()
    assert "this script is no ROS node: run it without --ros" in printed.err
    assert not printed.out


def test_a_node_of_ros_1_needs_rospy(
    script: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "rospy", None)  # as if it was not installed
    (script.parent / "smachac.toml").write_text(ROS_1)
    script.write_text(WAIT.replace("name: wait", "name: wait\ntemplate: ROSBase"))
    assert main(["run", str(script), "--ros"]) == 2
    assert "--ros needs rospy: start smachac with the Python of ROS 1" in capsys.readouterr().err


def test_arguments_of_ros_2_are_refused_for_ros_1(
    script: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (script.parent / "smachac.toml").write_text(ROS_1)
    script.write_text(WAIT.replace("name: wait", "name: wait\ntemplate: ROSBase"))
    assert main(["run", str(script), "--ros", "--ros-args", "-p", "speed:=1.0"]) == 2
    assert "--ros-args passes arguments of ROS 2" in capsys.readouterr().err


@pytest.mark.parametrize("play", [False, True])
def test_an_expected_outcome_that_the_machine_lacks_is_refused_before_the_run(
    play: bool, script: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scenario = script.with_name("scenario.yml")
    scenario.write_text("states: {}")
    mock = ["--mock", str(scenario)] if play else []
    assert main(["run", str(script), "--expect", "suceeded", *mock]) == 2
    printed = capsys.readouterr()
    assert "the machine has no outcome `suceeded`" in printed.err
    assert "did you mean `succeeded`?" in printed.err
    assert not printed.out
