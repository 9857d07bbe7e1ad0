"""Arguments of ROS that are not valid: one line with the reason, and the exit code."""

from __future__ import annotations

import json
from pathlib import Path

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
    (1, "parameter 'patience': `[]` is a list, the default is 20.0", "-p patience:=[]"),
    (2, "ROS 2 cannot start: '-p patience:=010': a number that begins with 0 is read as octal",
     "-p patience:=010"),
    (2, "ROS 2 cannot start: '-p /patrol:patience:=08': ", "--param /patrol:patience:=08"),
    (2, "ROS 2 cannot start: '-p patience:=-07': ", "-p patience:=-07"),
    (2, "ROS 2 cannot start: '-p patience:=[1,010]': ", "-p patience:=[1,010]"),
    (2, "ROS 2 cannot start: '-p patience:=[08]': ", "-p patience:=[08]"),
    (2, "ROS 2 cannot start: '-p patience:=0' and '-p patience:=0.5': ROS 2 does not take the last"
     " of two values of different types", "-p patience:=0 -p patience:=0.5"),
    (2, "ROS 2 cannot start: '-p patience:=[1]' and '-p patience:=[1.5]': ",
     "-p patience:=[1] --param patience:=[1.5]"),
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


DECLARED = """
import json, sys
from machine_node import *
from smachac.runtime.smach_ros2 import parameters

def build(node, joints=[1.0, 2.0], names=["a"], flags=[True], counts=[1], none=[], limit=20.0):
    pass

values = parameters.declared(node, build)
report("values", json.dumps(values))
report("again", json.dumps(parameters.declared(node, build)) == json.dumps(values))
"""

DEFAULTS = {
    "joints": [1.0, 2.0],
    "names": ["a"],
    "flags": [True],
    "counts": [1],
    "none": [],
    "limit": 20.0,
}

GIVEN: list[tuple[str, dict[str, object]]] = [
    ("-p joints:=[]", {"joints": []}),
    ("-p names:=[] -p flags:=[] -p counts:=[]", {"names": [], "flags": [], "counts": []}),
    ("-p joints:=[1,2]", {"joints": [1.0, 2.0]}),
    ("-p joints:=[0.5] -p limit:=7", {"joints": [0.5], "limit": 7.0}),
    ("-p joints:=[0,0.5]", {}),
    ("-p counts:=[0] -p limit:=0.5", {"counts": [0], "limit": 0.5}),
]  # fmt: skip


def test_the_values_of_parameters_have_the_types_of_the_defaults(graph2: Graph) -> None:
    programs = [graph2.start(DECLARED, "--ros-args", *arguments.split()) for arguments, _ in GIVEN]
    for program, (arguments, changed) in zip(programs, GIVEN, strict=True):
        code = program.end()
        if not changed:  # rcl refuses a list of two types
            assert code == 2, program.output
            continue
        assert code == 0, program.output
        values = json.dumps({**DEFAULTS, **changed})
        assert f"values: {values}\nagain: True\n" in program.output, arguments


SECTIONS = {
    "/**": "/**:\n  ros__parameters: {limit: 1.0}\n",
    "machine": "machine:\n  ros__parameters: {limit: 2.0}\n",
}
FILES: list[tuple[list[str], str, float]] = [
    (["/**", "machine"], "", 2.0),
    (["machine", "/**"], "", 1.0),
    (["machine", "/**"], "-p limit:=3.0", 3.0),
    (["machine"], "-p limit:=3e0", 3.0),
    (["/**"], "-p limit:=3", 3.0),
    (["/**", "machine"], "-p machine:limit:=3.0", 3.0),
    (["/**", "machine"], "-p limit:=2", 2.0),
]
"""Sections of a file of parameters in their order, arguments after it, and the value."""


def test_the_last_section_of_a_file_of_parameters_wins(graph2: Graph, tmp_path: Path) -> None:
    programs = []
    for number, (sections, more, _) in enumerate(FILES):
        path = tmp_path / f"{number}.yaml"
        path.write_text("".join(map(SECTIONS.__getitem__, sections)), "utf-8")
        given = ["--ros-args", "--params-file", str(path), *more.split()]
        programs.append(graph2.start(DECLARED, *given))
    for program, (_, _, value) in zip(programs, FILES, strict=True):
        assert program.end() == 0, program.output
        assert f'"limit": {value}' in program.output


HIDDEN = [
    ("3.0", "3.0", SECTIONS["/**"] + SECTIONS["machine"], 2.0),
    ("3", "3", SECTIONS["/**"] + SECTIONS["machine"], 2.0),
    (".nan", "nan", SECTIONS["/**"] + SECTIONS["machine"], 2.0),
    ("0.5", "0.5", SECTIONS["/**"].replace("1.0", "1"), 1.0),
]
"""The argument, as it is shown, and what a file has and gives."""


def test_an_argument_that_a_file_of_parameters_hides(graph2: Graph, tmp_path: Path) -> None:
    programs = []
    for number, (text, _, file, _) in enumerate(HIDDEN):
        path = tmp_path / f"{number}.yaml"
        path.write_text(file, "utf-8")
        given = ["--ros-args", "--params-file", str(path), "-p", f"limit:={text}"]
        programs.append(graph2.start(DECLARED, *given))
    for program, (_, shown, _, value) in zip(programs, HIDDEN, strict=True):
        assert program.end() == 1, program.output
        assert (
            f"ParameterError: parameter 'limit': the argument {shown} has no effect, because a "
            f"file of parameters gives {value} in a section after `/**` or as another type; "
            "write `-p machine:limit:=...` after the file\n"
        ) in program.output


def test_values_that_are_no_texts_are_logged(graph2: Graph) -> None:
    output = graph2.run(
        """
from machine_node import *
for log in smach.loginfo, smach.logwarn, smach.logerr:
    for value in 5, None, ["a"], ValueError("b"):
        log(value)
smach.logdebug(7)
"""
    )
    for shown in ("5", "None", "['a']", "b"):
        assert output.count(f"[smach_ros]: {shown}\n") == 3
