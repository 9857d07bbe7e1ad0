"""Player of the C++ target: one generated program, compiled once, runs all test cases."""

from __future__ import annotations

import importlib.util
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, NamedTuple

from smachac.diagnostics.diagnostic import Report
from smachac.frontend.loader import Library
from smachac.ir.nodes import Machine
from smachac.ir.types import Bounds
from smachac.targets.cpp.plan import plan
from smachac.targets.cpp.records import scripted_names
from smachac.targets.cpp.types import UnportableError
from smachac.verify.players.cpp_program import Program
from smachac.verify.players.cpp_step_program import StepProgram
from smachac.verify.test_case import Event, Player, TestCase, UnplayableError

HEADERS = Path(__file__).parents[2] / "runtime" / "cpp"
"""The folder of smachac/*.hpp."""

FLAGS = ("-std=c++17", "-O0", "-ffp-contract=off", "-pthread", f"-I{HEADERS}")
"""`-ffp-contract=off`: floats as in Python, also where the processor could fuse two operations."""

DONE = "--"
"""The line after each trace."""

MOST_ERRORS = 5
"""Limit on the lines of compiler output that are shown."""


def player(
    machine: Machine, report: Report, bounds: Bounds | None = None, library: Library | None = None
) -> Player:
    """A player of the generated C++ code. Adds to `report` what C++ cannot express of the machine.
    `bounds` are those of a stepped machine; `library` has the classes of C++ for types.

    The program is compiled when the player receives test cases. Raises UnplayableError if there is
    no compiler, or if the compilation fails.
    """
    planned = plan(machine, bounds, scripted_names(machine, library, stepped=bounds is not None))
    make = Program if bounds is None else StepProgram
    report.extend(make(planned, ()).refused())

    def play(cases: Sequence[TestCase]) -> Iterator[list[Event]]:
        compiler = first_compiler()
        program = make(planned, cases)
        try:
            text = program.text()
        except UnportableError as error:
            raise UnplayableError(f"the C++ program cannot be printed: {error}") from error
        try:
            yield from traces(text, program.script(), compiler)
        except CompilationError as error:
            lines = ["the C++ program does not compile:", *error.lines[:MOST_ERRORS]]
            raise UnplayableError("\n".join(lines)) from error

    return play


def traces(text: str, cases: str, compiler: Compiler, *flags: str) -> Iterator[list[Event]]:
    """The traces that a program prints, one after the other, while it runs.

    If the program fails, the last trace ends with an error event. Raises CompilationError.
    """
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryFile("w+") as given:
        made = compiled(text, compiler, Path(folder), *flags)
        given.write(cases)
        given.seek(0)
        with _process([made], stdin=given) as run:
            assert run.stdout is not None
            events: list[Event] = []
            for line in run.stdout:
                if line.strip() == DONE:
                    yield events
                    events = []
                elif (event := _event(line)) is not None:
                    events.append(event)
            if run.wait() != 0:
                how = f"the program ended with {run.returncode}"
                yield [*events, {"event": "error", "path": "", "outcome": how}]


def _event(line: str) -> Event | None:
    """The event of a line; None for a line of another kind, which code of the user printed."""
    try:
        event = json.loads(line)
    except ValueError:
        return None
    return event if isinstance(event, dict) and "event" in event else None


class CompilationError(Exception):
    """A program that does not compile; `lines` are the errors that the compiler printed."""

    def __init__(self, lines: Sequence[str]) -> None:
        super().__init__(*lines[:1])
        self.lines = lines


def compiled(text: str, compiler: Compiler, folder: Path, *flags: str) -> str:
    """Compile a program; the path of the executable. Raises CompilationError.

    The compiler runs in `folder`: headers in the working folder of the user are found only there
    where `flags` lead to.
    """
    made = str(folder / "verify")
    call = [*compiler.command, *flags, *FLAGS, "-x", "c++", "-", "-o", made]
    environment = {**os.environ, "TMPDIR": str(folder)}
    errors = subprocess.STDOUT
    with _process(
        call, stdin=subprocess.PIPE, stderr=errors, cwd=folder, env=environment
    ) as process:
        printed = process.communicate(text)[0]
    if process.returncode != 0:
        lines = printed.splitlines()
        raise CompilationError([line for line in lines if "error: " in line] or lines)
    return made


@contextmanager
def _process(
    command: Sequence[str],
    *,
    stdin: int | IO[str],
    stderr: int | None = None,
    cwd: Path | None = None,
    env: Mapping[str, str] | None = None,
) -> Iterator[subprocess.Popen[str]]:
    """A process that leads a session of its own: if it still runs when the context ends, it is
    ended with all processes that it started, such as those of a compiler. A Ctrl-C while it starts
    comes when it has started."""
    with _interrupts_later() as interrupts:
        process = subprocess.Popen(
            command,
            stdin=stdin,
            stdout=subprocess.PIPE,
            stderr=stderr,
            cwd=cwd,
            env=env,
            encoding="utf-8",
            errors="replace",
            start_new_session=True,
        )
        try:
            interrupts()
            yield process
        finally:
            if process.poll() is None:
                _end_session(process)
            process.wait()
            for pipe in (process.stdin, process.stdout):
                if pipe is not None:
                    pipe.close()


@contextmanager
def _interrupts_later() -> Iterator[Callable[[], None]]:
    """Delays Ctrl-C up to the call of the function, where the platform can."""
    mask = getattr(signal, "pthread_sigmask", None)
    if mask is None:
        yield lambda: None
        return
    before = mask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield lambda: mask(signal.SIG_SETMASK, before)
    finally:
        mask(signal.SIG_SETMASK, before)


def _end_session(process: subprocess.Popen[str]) -> None:
    with suppress(ProcessLookupError):
        if hasattr(os, "killpg"):
            os.killpg(process.pid, signal.SIGKILL)
        else:
            process.kill()


class Compiler(NamedTuple):
    """A compiler: its kind, `g++` or `clang++`, and its command."""

    name: str
    command: tuple[str, ...]


def first_compiler() -> Compiler:
    """The compiler that programs are compiled with. Raises UnplayableError if there is none."""
    found = compilers()
    if not found:
        words = "no C++ compiler is here: install g++ or clang++, or the Python package ziglang"
        raise UnplayableError(words)
    return found[0]


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
