"""The rules about the code of the user together: the order of the files, a check and a build."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.analysis.context import Context
from smachac.checks import check_machine, code_rules
from smachac.diagnostics.diagnostic import Diagnostic
from smachac.diagnostics.source import Source
from smachac.driver import analyse, build
from smachac.frontend.files import disk_library
from smachac.frontend.loader import Library, memory_library
from smachac.targets import load_target

SCRIPT = """
name: sm
outcomes: [done]
states:
  - ZERO: {template: Zero, transitions: {done: ONE}}
  - ONE: {template: One, transitions: {done: TWO}}
  - TWO: {template: Two, transitions: {done: done}}
"""
INTERFACE = """
name: NAME
outcomes: {done: {}}
code: {python: "cell.FILE:NAME"}
"""
GOOD = """
import smach


class NAME(smach.State):
    def __init__(self):
        super().__init__(outcomes=["done"])

    def execute(self, userdata):
        return "done"
"""
NO_EXECUTE = GOOD.replace("execute", "run")
MORE = GOOD.replace('["done"]', '["done", "lost"]')
NO_NAME = f"from cell.zone import Nowhere\n{GOOD}"


def _library(*classes: str) -> tuple[Source, Library]:
    files = {"main.yml": SCRIPT, "cell/zone.py": "SIZE = 1\n"}
    for name, text in zip(("Zero", "One", "Two"), classes, strict=True):
        file = {"Zero": "z", "One": "m", "Two": "a"}[name]
        interface = INTERFACE.replace("NAME", name).replace("FILE", file)
        files |= {f"templates/{name}.yml": interface, f"cell/{file}.py": text.replace("NAME", name)}
    return Source("main.yml", SCRIPT), memory_library(files, disk_library(Path("main.yml"), []))


CASES = [
    ((NO_EXECUTE, GOOD, NO_NAME), ["SM609 cell/z.py", "SM608 cell/a.py"]),
    ((NO_EXECUTE, MORE, GOOD), ["SM609 cell/z.py", "SM603 cell/m.py"]),
    ((MORE, NO_NAME, NO_EXECUTE), ["SM603 cell/z.py", "SM608 cell/m.py", "SM609 cell/a.py"]),
    ((GOOD, GOOD, GOOD), []),
]


@pytest.mark.parametrize(("classes", "expected"), CASES)
def test_files_are_in_the_order_in_which_states_use_them(
    classes: tuple[str, str, str], expected: list[str]
) -> None:
    analysis = analyse(*_library(*classes), [])
    assert _places(analysis.report) == expected


@pytest.mark.parametrize(("classes", "expected"), CASES)
def test_a_build_for_another_language_needs_no_class(
    classes: tuple[str, str, str], expected: list[str]
) -> None:
    source, library = _library(*classes)
    analysis = analyse(source, library, [])
    assert analysis.checked is not None
    for name, found in ("python", expected), ("dot", []):
        target, report = load_target(name), list[Diagnostic]()
        assert target is not None
        files = build(analysis.checked, target, library, report)
        assert _places(report) == found
        assert bool(files) is not bool(found)


def test_a_machine_without_a_project_has_no_code() -> None:
    source, library = _library(MORE, NO_NAME, NO_EXECUTE)
    machine = analyse(source, library, []).machine
    assert machine is not None
    assert check_machine(machine, code_rules()) == []
    assert Context(machine).code_facts.files == ()


def _places(report: list[Diagnostic]) -> list[str]:
    return [f"{item.code} {item.span.source.name}" for item in report]
