"""Player of the C++ target: one generated program, compiled once, runs all test cases."""

from __future__ import annotations

import importlib.util
import json
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import smachac
from smachac.diagnostics.diagnostic import Report
from smachac.ir.nodes import Machine
from smachac.targets.cpp.plan import plan
from smachac.targets.cpp.types import UnportableError
from smachac.verify.players.cpp_program import Program
from smachac.verify.test_case import Event, Player, TestCase, UnplayableError

HEADERS = Path(smachac.__file__).parent / "runtime" / "cpp"
"""The folder of smachac/*.hpp."""

FLAGS = ("-std=c++17", "-O0", "-ffp-contract=off", "-pthread", f"-I{HEADERS}")
"""`-ffp-contract=off`: floats as in Python, also where the processor could fuse two operations."""

DONE = "--"
"""The line after each trace."""

MOST_ERRORS = 5
"""Limit on the lines of compiler output that are shown."""


def player(machine: Machine, report: Report) -> Player:
    """A player of the generated C++ code. Adds to `report` what C++ cannot express of the machine.

    The program is compiled when the player receives test cases. Raises UnplayableError if there is
    no compiler, or if the compilation fails.
    """
    planned = plan(machine)
    report.extend(Program(planned, ()).refused())

    def play(cases: Sequence[TestCase]) -> Iterator[list[Event]]:
        found = compilers()
        if not found:
            words = "no C++ compiler is here: install g++ or clang++, or the Python package ziglang"
            raise UnplayableError(words)
        program = Program(planned, cases)
        try:
            text = program.text()
        except UnportableError as error:
            raise UnplayableError(f"the C++ program cannot be printed: {error}") from error
        yield from traces(text, program.script(), found[0])

    return play


def traces(text: str, cases: str, compiler: Compiler) -> Iterator[list[Event]]:
    """The traces that a program prints, one after the other, while it runs.

    If the program fails, the last trace ends with an error event.
    """
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryFile("w+") as given:
        made = compiled(text, compiler, Path(folder))
        given.write(cases)
        given.seek(0)
        run = subprocess.Popen([made], stdin=given, stdout=subprocess.PIPE, text=True)
        assert run.stdout is not None
        events: list[Event] = []
        try:
            for line in run.stdout:
                if line.strip() == DONE:
                    yield events
                    events = []
                else:
                    events.append(json.loads(line))
            if run.wait() != 0:
                how = f"the program ended with {run.returncode}"
                yield [*events, {"event": "error", "path": "", "outcome": how}]
        finally:
            run.kill()
            run.wait()
            run.stdout.close()


def compiled(text: str, compiler: Compiler, folder: Path) -> str:
    """Compile a program; the path of the executable. Raises UnplayableError with the first errors
    of the compiler."""
    made = str(folder / "verify")
    call = [*compiler.command, *FLAGS, "-x", "c++", "-", "-o", made]
    run = subprocess.run(call, input=text, capture_output=True, text=True, check=False)
    if run.returncode != 0:
        lines = run.stderr.splitlines()
        errors = [line for line in lines if "error" in line] or lines
        raise UnplayableError(
            "\n".join(["the C++ program does not compile:", *errors[:MOST_ERRORS]])
        )
    return made


class Compiler(NamedTuple):
    """A compiler: its kind, `g++` or `clang++`, and its command."""

    name: str
    command: tuple[str, ...]


def compilers() -> tuple[Compiler, ...]:
    """The installed compilers, at most one of each kind; the package `ziglang` if there is none."""
    versions = [f"clang++-{number}" for number in range(22, 11, -1)]
    found = [*_first("g++", ["g++"]), *_first("clang++", ["clang++", *versions])]
    if not found and importlib.util.find_spec("ziglang"):
        found = [Compiler("clang++", (sys.executable, "-m", "ziglang", "c++"))]
    return tuple(found)


def _first(kind: str, names: Sequence[str]) -> list[Compiler]:
    found = next(filter(None, map(shutil.which, names)), None)
    return [Compiler(kind, (found,))] if found else []
