"""Targets of other packages read the user's classes in their languages."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from smachac.diagnostics.diagnostic import Diagnostic
from smachac.diagnostics.source import Source
from smachac.driver import analyse, build
from smachac.frontend.files import disk_library
from smachac.frontend.loader import memory_library
from smachac.targets import load_target

TARGET = """
from smachac.diagnostics.source import Span, Word
from smachac.ir.class_facts import ClassFault, FaultKind
from smachac.targets import Declared, Target

NO_RUN = FaultKind(
    name="no run", message="`{name}` has no function `{word}`", help="add `{word}`", stops=STOPS
)


def declared(type_, library):
    source = library.code(type_.code.get("lua", ""))
    if source is None:
        return None
    words = source.text.partition("outcomes: ")[2].split()
    places = [source.text.index(word) for word in words]
    outcomes = [Word(word, Span(source, at, at + len(word))) for word, at in zip(words, places)]
    start = Span(source, 0, 1)
    faults = () if "run" in source.text else (ClassFault(kind=NO_RUN, name=Word("run", start)),)
    return Declared(name="Grasp", span=start, outcomes=tuple(outcomes), faults=faults)


def emit(machine, context, report):
    return {"main.lua": ""}


TARGET = Target(name="lua", description="Lua", emit=emit, declared=declared)
"""
SCRIPT = """
name: sm
outcomes: [done, lost]
states:
  - GRASP: {template: Grasp, transitions: {held: done, missed: lost}}
"""
INTERFACE = """
name: Grasp
outcomes: {held: {}, missed: {}}
code: {lua: arm/grasp.lua}
"""


@pytest.fixture
def installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with an installed package that has a target for Lua."""
    about = tmp_path / "smachac_lua-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: smachac-lua\nVersion: 1.0\n")
    entry = "[smachac.targets]\nlua = smachac_lua:TARGET\n"
    (about / "entry_points.txt").write_text(entry)
    monkeypatch.syspath_prepend(tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    ("code", "stops", "checked", "built"),
    [
        ("function run() outcomes: held missed", True, [], []),
        ("function run() outcomes: held lost", True,
         ["SM603 warning"], ["SM603 error"]),
        ("outcomes: held missed", True, ["SM609 error"], ["SM609 error"]),
        ("outcomes: held missed", False, ["SM609 warning"], ["SM609 error"]),
        ("outcomes: held lost", False,
         ["SM609 warning", "SM603 warning"], ["SM609 error", "SM603 error"]),
    ],
)  # fmt: skip
def test_a_class_in_the_language_of_another_package(
    code: str,
    stops: bool,
    checked: list[str],
    built: list[str],
    installed: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    (installed / "smachac_lua.py").write_text(TARGET.replace("STOPS", str(stops)))
    monkeypatch.delitem(sys.modules, "smachac_lua", raising=False)
    files = {"main.yml": SCRIPT, "templates/Grasp.yml": INTERFACE, "arm/grasp.lua": code}
    library = memory_library(files, disk_library(Path("main.yml"), []))
    analysis = analyse(Source("main.yml", SCRIPT), library, [])
    assert [item for item in _words(analysis.report) if "SM003" not in item] == checked
    target = load_target("lua")
    assert analysis.checked is not None
    assert target is not None
    found: list[Diagnostic] = []
    assert bool(build(analysis.checked, target, library, found)) is not bool(built)
    assert _words(found) == built
    python = load_target("python")
    found = []
    assert python is not None
    build(analysis.checked, python, library, found)
    assert not any("SM603" in item or "SM609" in item for item in _words(found))


def _words(report: list[Diagnostic]) -> list[str]:
    return [f"{item.code} {item.severity.value}" for item in report]
