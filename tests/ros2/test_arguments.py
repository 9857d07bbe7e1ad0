"""Arguments of ROS that are not valid: one line with the reason, and the exit code."""

from __future__ import annotations

import pytest

import smachac
from tests.ros2.ros2_graph import PYTHON, ROOT, Graph

pytestmark = pytest.mark.ros2

SCRIPT = ROOT / "examples" / "ros2_mobile_base" / "patrol.yml"

WRONG = [
    (2, "ROS 2 cannot start: Couldn't parse remap rule: '-r drive'", "-r drive"),
    (2, "ROS 2 cannot start: Couldn't parse remap rule: '-r __ns:=robot'", "-r __ns:=robot"),
    (2, "ROS 2 cannot start: Couldn't parse parameter override rule: '-p x'", "-p x"),
    (2, "ROS 2 cannot start: Couldn't parse params file: '--params-file no.yaml'",
     "--params-file no.yaml"),
    (2, "ROS 2 cannot start: Couldn't parse trailing -r flag.", "-r"),
    (2, "ROS 2 cannot start: unknown arguments ['--speed']", "--speed"),
    (2, "ROS 2 cannot start: Trying to set parameter 'use_sim_time'", "-p use_sim_time:=maybe"),
    (1, "parameter 'patience': ", "-p patience:=long"),
]  # fmt: skip
"""The exit code, the begin of the line, and the arguments."""


def check(output: str, begin: str) -> None:
    """The output is one line that begins so, without places in the source of ROS."""
    (line,) = output.splitlines()
    assert line.startswith(begin)
    assert "/project/" not in line


def test_a_generated_program(graph2: Graph) -> None:
    (text,) = smachac.compile(SCRIPT, "python").values()
    programs = [graph2.start(text, "--ros-args", *arguments.split()) for _, _, arguments in WRONG]
    for program, (code, begin, _) in zip(programs, WRONG, strict=True):
        assert program.end() == code, program.output
        check(program.output, begin)


def test_run(graph2: Graph) -> None:
    command = [PYTHON, "-m", "smachac", "run", str(SCRIPT), "--ros", "--ros-args"]
    programs = [graph2._launch([*command, *arguments.split()]) for _, _, arguments in WRONG]
    for program, (code, begin, _) in zip(programs, WRONG, strict=True):
        assert program.end() == code, program.output
        check(program.output, begin)


LEVEL = """
from machine_node import *
import rclpy.logging
report("level", rclpy.logging.get_logger_level("rcl").name)
program.stop_node(node)
"""


def test_the_logger_of_ros_keeps_its_level(graph2: Graph) -> None:
    assert "level: UNSET\n" in graph2.run(LEVEL)
    assert "level: ERROR\n" in graph2.run(LEVEL, "--ros-args", "--log-level", "rcl:=error")
