"""Python that is printed: code of the script in it, however it is written."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import smachac
from smachac.commands.cli import main
from smachac.targets.python.formatter import expression, flat

CODES = {
    "lambda a, b: a # the first": "lambda a, b: a",
    "lambda a, b: '#' # a hash": "lambda a, b: '#'",
    "lambda a, b: (a,\n  b)": "lambda a, b: (a, b)",
    "lambda a, b:\n  a  # one\n  + b # two": "lambda a, b: a + b",
    "lambda a, b: a": "lambda a, b: a",
}


@pytest.mark.parametrize("code", CODES)
def test_code_that_is_not_portable_stands_on_one_line_without_comments(code: str) -> None:
    assert flat(expression(code)) == CODES[code]
    assert ast.parse(f"f({flat(expression(code))}, 1)", mode="eval")


def moving(folder: Path, robot: str, template: str = "GripperState", base: str = "Base") -> str:
    """A script that moves an arm and names a robot; the path of its file."""
    script = folder / "main.yml"
    more = "outcomes: [done, failed]"
    if template == "GripperState":
        more = "command: open, transitions: {succeeded: done, aborted: failed, preempted: failed}"
    script.write_text(
        f"name: sm\ntemplate: {base}\nrobot: {robot}\noutcomes: [done, failed]\n"
        f"states:\n  - OPEN: {{template: {template}, {more}}}\n"
    )
    return str(script)


def arm(name: str, *joints: str) -> str:
    """The URDF of an arm with these joints in a row."""
    links = "".join(f'<link name="l{k}"/>' for k in range(len(joints) + 1))
    chain = "".join(
        f'<joint name="{joint}" type="revolute"><parent link="l{k}"/><child link="l{k + 1}"/>'
        '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
        for k, joint in enumerate(joints)
    )
    return f'<robot name="{name}">{links}{chain}</robot>'


@pytest.mark.parametrize("command", [["run"], ["build", "--target", "python", "-o", "-"]])
def test_another_robot_is_not_replaced_by_the_simulated_arm(
    tmp_path: Path, command: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "kuka.urdf").write_text(arm("kuka", "a1", "a2"))
    assert main([command[0], moving(tmp_path, "kuka.urdf"), *command[1:]]) == 1
    written = capsys.readouterr()
    assert written.out == ""
    assert "error[SM601]: not supported in Python: the robot `" in written.err
    assert "main.yml:3:8" in written.err


def test_the_simulated_arm_under_its_own_description(tmp_path: Path) -> None:
    (tmp_path / "arm.urdf").write_text(arm("mine", *(f"panda_joint{k}" for k in range(1, 8))))
    assert smachac.compile(moving(tmp_path, "arm.urdf"), "python")
    assert smachac.compile(moving(tmp_path, "panda"), "python")
    (tmp_path / "kuka.urdf").write_text(arm("kuka", "a1", "a2"))
    script = moving(tmp_path, "kuka.urdf", "ScriptedState")
    assert smachac.compile(script, "python")
    script = moving(tmp_path, "kuka.urdf")
    assert smachac.compile(script, "dot")
    (tmp_path / "templates").mkdir()
    own = tmp_path / "templates" / "GripperState.tpl.py"
    own.write_text('{% extends "State.tpl.py" %}\n')
    (tmp_path / "templates" / "GripperState.yml").write_text(
        "name: GripperState\nvariables: {command: {type: str}}\n"
        "outcomes: {succeeded: {}, aborted: {}, preempted: {}}\n"
    )
    assert smachac.compile(script, "python")


@pytest.mark.parametrize("levels", [70, 150, 190, 198])
def test_code_nested_too_deeply_for_a_call_is_an_error_of_the_build(
    levels: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    script = tmp_path / "main.yml"
    value = "lambda ud: " + "[" * levels + "]" * levels
    script.write_text(
        "name: sm\ntemplate: Base\noutcomes: [succeeded]\nstates:\n  - A:\n"
        "      template: CallbacksState\n      output_keys: [x]\n"
        f'      callbacks: {{x: "{value}"}}\n      transitions: {{succeeded: succeeded}}\n',
        encoding="utf-8",
    )
    code = main(["build", str(script), "--target", "python", "-o", str(tmp_path / "out")])
    found = tmp_path / "out" / "sm.py"
    if code == 0:
        ast.parse(found.read_text(encoding="utf-8"))
    else:
        assert not found.exists()
        assert "is nested deeper than 200 levels" in capsys.readouterr().err
    assert code == (levels == 198)
