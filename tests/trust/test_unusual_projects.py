"""Unusual but correct projects, written by hand (`unusual_projects`), are without a finding.

The first line of one may permit notes: `# permitted: SM401`.
"""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from smachac.diagnostics.diagnostic import Severity
from smachac.driver import compile_script
from smachac.ir.nodes import Machine, StateType
from smachac.report.text import render_text
from smachac.runtime import smach
from smachac.targets.python import TARGET
from smachac.verify import verify
from smachac.verify.players.python import player
from tests.trust.project_text import MAIN, analysed
from tests.trust.unusual_projects import PROJECTS, files_in

PERMITTED = "# permitted:"
BUILT_ONLY = {
    "class_from_an_installed_package",
    "items_of_a_dictionary",
    "iterator_over_an_expression",
    "math_in_callbacks",
    "optional_outcome_of_a_type",
}
"""Projects with a package that is not installed here, with code that only Python evaluates, or with
a state type whose states have different outcomes, as no stand-in has."""


@pytest.mark.parametrize("path", PROJECTS, ids=lambda path: path.stem)
def test_an_unusual_project_has_no_finding(path: Path) -> None:
    text = path.read_bytes().decode("utf-8")
    head = text.partition("\n")[0]
    permitted = head.removeprefix(PERMITTED).split() if head.startswith(PERMITTED) else []
    report = [
        item
        for item in analysed(files_in(text)).report
        if item.severity is not Severity.INFO or item.code not in permitted
    ]
    assert render_text(report) == render_text([])


def without_code(name: str, text: str) -> bool:
    return name.startswith("templates/") and name.endswith(".yml") and "code:" not in text


def with_code(files: dict[str, str]) -> dict[str, str]:
    """The project where each state type without code has a class in a module not in the project."""
    return {
        name: f'{text}\ncode: {{python: "stand_ins:{Path(name).stem}"}}\n'
        if without_code(name, text)
        else text
        for name, text in files.items()
    }


def stand_in(type_: StateType) -> str:
    """A class that has the interface of a state type; a scenario replaces what it does."""
    outcomes, inputs, outputs = (
        [item.name for item in items]
        for items in (type_.outcomes, type_.input_keys, type_.output_keys)
    )
    return (
        f"class {type_.name}(smach.State):\n"
        "    def __init__(self, **variables):\n"
        f"        super().__init__({outcomes}, {inputs}, {outputs})\n"
    )


def write_modules(folder: Path, files: dict[str, str], machine: Machine) -> None:
    """The modules of a project, and the classes that `with_code` names."""
    types = [
        stand_in(machine.state_types[Path(name).stem])
        for name, text in files.items()
        if without_code(name, text) and Path(name).stem in machine.state_types
    ]
    modules = {name: text for name, text in files.items() if name.endswith(".py")}
    modules["stand_ins.py"] = "\n".join(["import smach", *types])
    for name, text in modules.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")


@pytest.mark.slow
@pytest.mark.parametrize("path", PROJECTS, ids=lambda path: path.stem)
def test_an_unusual_project_is_built_and_runs_in_python_as_in_the_interpreter(
    path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    files = files_in(path.read_bytes().decode("utf-8"))
    analysis = analysed(with_code(files))
    compiled = compile_script(analysis, TARGET)
    errors = [item for item in compiled.report if item.severity is Severity.ERROR]
    assert render_text(errors) == render_text([])
    machine = analysis.machine
    assert machine is not None
    name, text = next(iter(compiled.files.items()))
    compile(text, name, "exec")
    if path.stem in BUILT_ONLY or machine.base == "ROSBase":
        return
    write_modules(tmp_path, files, machine)
    monkeypatch.setitem(sys.modules, "smach", smach)
    played = player(name, text, machine, folders=[tmp_path])
    verdict = verify(machine, {"python": played}, script=MAIN, most=20)
    assert verdict.disagreements == []


def test_there_are_many() -> None:
    assert len(PROJECTS) >= 240
