"""What the interpreter does, the compiled C++ does: event by event."""

from __future__ import annotations

import functools
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, seed, settings

from smachac.diagnostics.diagnostic import Report
from smachac.driver import analyse
from smachac.frontend.files import disk_library, read_source
from smachac.ir.nodes import Concurrence, Machine
from smachac.ir.traversal import walk
from smachac.targets.cpp import containers
from tests.cpp.compiled_traces import NOBODY, ROOT, Asked, Part, header, named, traces
from tests.cpp.compilers import BARE, COMPILERS, SANITIZED, THREADED, Compiler, last_with
from tests.pipeline.test_differential import Event, differ, of_interpreter
from tests.strategies.full_machines import busy_machines

STANDARDS = {"g++": "c++17", "clang++": "c++20"}
RANDOM = {"g++": 30, "clang++": 15}
"""How many random machines each compiler gets: clang is the second opinion."""

SCRIPTS = [
    *sorted((ROOT / "examples").glob("0[1-7]*/main.yml")),
    ROOT / "tests" / "cases" / "containers" / "main.yml",
    ROOT / "tests" / "cases" / "concurrence_any" / "main.yml",
    ROOT / "tests" / "cases" / "deep_nesting" / "main.yml",
    ROOT / "tests" / "cases" / "on_error" / "main.yml",
    ROOT / "tests" / "cases" / "sugar" / "main.yml",
]

Expected = tuple[Part, list[Event]]


@functools.cache
def of_scripts() -> list[Expected]:
    """The examples, with the traces of the interpreter."""
    found: list[Expected] = []
    for script in SCRIPTS:
        report: Report = []
        source = read_source(script, report)
        assert source is not None
        library = disk_library(script, report)
        checked = analyse(source, library, report).checked
        assert checked is not None, script
        machine = named(checked, f"m{len(found)}_{checked.root.name}")
        text, ours = header(machine, library), of_interpreter(machine)
        assert text is not None, script
        assert ours is not None, script
        found.append(((machine, text, NOBODY), ours))
    return found


@functools.cache
def drawn(number: int, count: int) -> list[Expected]:
    """Random machines that C++ can say, with the traces of the interpreter."""
    found: list[Expected] = []

    @seed(number)
    @settings(
        max_examples=count,
        database=None,
        deadline=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(busy_machines())
    def draw(given: tuple[Machine, Asked]) -> None:
        machine, (path, visit) = given
        name = f"m{len(found)}"
        machine = named(machine, name)
        asked = (name + path.removeprefix("sm"), visit) if path else NOBODY
        ours, text = of_interpreter(machine, asked), header(machine)
        if ours is not None and text is not None:
            found.append(((machine, text, asked), ours))

    draw()
    assert len(found) > count / 2
    return found


def agree(expected: list[Expected], compiler: Compiler, folder: Path, *flags: str) -> None:
    """Compare the traces of the compiled machines with those of the interpreter."""
    parts = [part for part, _ in expected]
    told = traces(parts, compiler, folder, *flags, standard=STANDARDS[compiler.name])
    for ((machine, _, _), ours), theirs in zip(expected, told, strict=True):
        difference = differ(ours, theirs)
        assert difference is None, f"{machine.root.name}: {difference}"


@pytest.mark.slow
@COMPILERS
def test_machines_do_what_the_interpreter_does(compiler: Compiler, tmp_path: Path) -> None:
    agree([*of_scripts(), *drawn(1, RANDOM[compiler.name])], compiler, tmp_path)


@pytest.mark.slow
def test_large_machines_become_several_functions(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(containers, "MOST_STATES", 2)
    found: list[Expected] = []
    for (machine, _, asked), ours in of_scripts():
        text = header(machine)
        assert text is not None
        found.append(((machine, text, asked), ours))
    assert sum("bool part_1(" in text for (_, text, _), _ in found) > 5
    agree(found, last_with(), tmp_path)


@pytest.mark.nightly
def test_sanitizers_find_nothing(tmp_path: Path) -> None:
    agree([*of_scripts(), *drawn(2, 15)], last_with(*SANITIZED), tmp_path, *SANITIZED)


@pytest.mark.nightly
def test_threads_do_not_race(tmp_path: Path) -> None:
    parallel = [
        script
        for script in [*of_scripts(), *drawn(3, 15)]
        if any(isinstance(node, Concurrence) for _, node in walk(script[0][0].root))
    ]
    assert len(parallel) > 3
    agree(parallel, last_with(*THREADED), tmp_path, *THREADED)


@pytest.mark.slow
@COMPILERS
def test_machines_run_without_exceptions_and_type_information(
    compiler: Compiler, tmp_path: Path
) -> None:
    """Machines that catch exceptions are refused by such a compiler, and are left out."""
    unfailing = [
        script
        for script in [*of_scripts(), *drawn(4, 10)]
        if all(event["event"] != "error" for event in script[1])
        and not any(node.catches for _, node in walk(script[0][0].root))
    ]
    assert len(unfailing) > 10
    agree(unfailing, compiler, tmp_path, *BARE)
