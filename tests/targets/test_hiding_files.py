"""SM611: a generated file does not hide a module that programs import."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from smachac.commands.cli import main
from smachac.diagnostics.source import Source
from smachac.driver import read_machine
from smachac.frontend.loader import Library
from smachac.targets.hiding_files import hiding_files

SCRIPT = """\
name: NAME
template: Base
outcomes: [done]
states:
- A: {template: TYPE, transitions: {ok: done}}
"""
CLASS = """\
import smach
class Own(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["ok"])
    def execute(self, ud):
        return "ok"
"""


def build(folder: Path, name: str, target: str, *options: str, type_: str = "") -> int:
    type_ = type_ or "ScriptedState, outcomes: [ok]"
    script = folder / "main.yml"
    base = "ROSBase" if any("package" in option for option in options) else "Base"
    text = SCRIPT.replace("NAME", name).replace("TYPE", type_).replace("Base", base)
    script.write_text(text)
    words = [word for option in options for word in ("--option", option)]
    return main(["build", str(script), "-t", target, "-o", str(folder / "out"), *words])


@pytest.mark.parametrize(
    "name",
    ["smachac", "smach", "smach_ros", "threading", "typing", "copy", "re", "rclpy", "std_msgs",
     "Threading", "RE", "Smach", "collections", "signal"],
)  # fmt: skip
def test_a_machine_named_like_a_module(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert build(tmp_path, name, "python") == 1
    shown = capsys.readouterr().err
    assert f"the file `{name}.py` of this machine hides the module `{name.lower()}`" in shown
    assert f"write another `name`, such as `{name}_task`" in shown
    assert not (tmp_path / "out").exists()
    for target in ("cpp", "dot", "json", "ir", "mermaid", "html"):
        assert build(tmp_path, name, target) == 0
    assert build(tmp_path, f"{name}_task", "python") == 0


def test_a_machine_named_like_the_module_of_its_class(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "templates").mkdir()
    (tmp_path / "templates" / "Own.yml").write_text(
        "name: Own\ncode: {python: 'grasp:Own'}\noutcomes: {ok: {}}\n"
    )
    (tmp_path / "grasp.py").write_text(CLASS)
    assert build(tmp_path, "Grasp", "python", type_="Own") == 1
    assert "the file `Grasp.py` of this machine hides the module `grasp`" in capsys.readouterr().err
    assert build(tmp_path, "task", "python", type_="Own") == 0


def test_a_machine_named_like_the_header_of_its_class(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "templates").mkdir()
    (tmp_path / "templates" / "Own.yml").write_text(
        "name: Own\ncode: {cpp: {header: grasp.hpp, class: Own}}\noutcomes: {ok: {}}\n"
    )
    (tmp_path / "grasp.hpp").write_text(
        "#pragma once\n#include <smachac/smachac.hpp>\nclass Own : public smachac::State {};\n"
    )
    for name in ("grasp", "GRASP"):
        assert build(tmp_path, name, "cpp", type_="Own") == 1
        shown = capsys.readouterr().err
        assert f"the generated header would both be `{name}.hpp`" in shown


@pytest.mark.parametrize("name", ["std_msgs", "rclpy"])
def test_a_package_named_like_a_module(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert build(tmp_path, "task", "python", "ros=2", f"package={name}") == 1
    assert f"hides the module `{name}`" in capsys.readouterr().err
    assert build(tmp_path, "typing", "python", "ros=2", "package=true") == 1
    assert build(tmp_path, "task", "python", "ros=2", "package=true") == 0


def test_a_word_for_a_task_is_refused_if_the_program_imports_its_module(tmp_path: Path) -> None:
    assert build(tmp_path, "wave", "python") == 0
    callbacks = "CallbacksState, output_keys: [x], callbacks: {x: 'lambda ud: wave.Error'}"
    script = tmp_path / "main.yml"
    text = SCRIPT.replace("NAME", "wave").replace("TYPE", callbacks).replace("ok:", "succeeded:")
    script.write_text(text)
    assert main(["build", str(script), "-t", "python", "-o", str(tmp_path / "new")]) == 1


def test_a_program_with_the_name_in_the_help_runs(tmp_path: Path) -> None:
    assert build(tmp_path, "threading_task", "python") == 0
    program = tmp_path / "out" / "threading_task.py"
    subprocess.run([sys.executable, str(program)], check=True, capture_output=True)


@pytest.mark.parametrize(
    ("program", "hides"),
    [
        ("import os, grasping", True),
        ("import os as grasping", False),
        ("import os, \\\n    grasping as g", True),
        ("x = 1; import grasping.arm", True),
        ("def run():\n    from grasping import (\n        arm,\n    )", True),
        ("from GRASPING import arm", True),
        ("import \uff47rasping", True),
        ("from .grasping import arm", False),
        ("from os import grasping", False),
        ("import grasping_task", False),
        ("# import grasping", False),
        ("text = 'import grasping'", False),
        ("import grasping\nx = (", False),
        ("x = 1", False),
    ],
)
def test_a_file_hides_what_its_program_imports(program: str, hides: bool) -> None:
    machine = read_machine(Source("main.yml", SCRIPT), Library(
        script=lambda name, caller: None, template=lambda name: None,
        own_template=lambda name: None, code=lambda name: None,
        code_names=lambda folder: ()), [])  # fmt: skip
    assert machine is not None
    found = list(hiding_files({"grasping.py": f"{program}\n"}, machine))
    assert [item.code for item in found] == ["SM611"] * hides
