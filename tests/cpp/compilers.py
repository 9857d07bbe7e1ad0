"""The C++ compilers of this computer: `g++`, `clang++`, else the one in the package `ziglang`."""

from __future__ import annotations

import functools
import hashlib
import os
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import pytest

from smachac.verify.players.cpp import HEADERS
from smachac.verify.players.cpp import compilers as installed

WARNINGS = (
    *("-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror"),
    # Floats as Python computes them, also where the machine could fuse two operations.
    "-ffp-contract=off",
)
SANITIZED = ("-fsanitize=address,undefined", "-fno-sanitize-recover=all")
THREADED = ("-fsanitize=thread",)
STRICT = (
    *("-Weffc++", "-Wsign-conversion", "-Wuseless-cast", "-Wnull-dereference", "-Wold-style-cast"),
    *("-Wdouble-promotion", "-Wno-unknown-warning-option", "-O2"),
)
"""Warnings that generated headers and those of the runtime do not give either."""
BARE = ("-fno-exceptions", "-fno-rtti")


@dataclass(frozen=True, slots=True)
class Compiler:
    """A compiler by its kind, `g++` or `clang++`, and how it is called."""

    name: str
    command: tuple[str, ...]

    def runs_with(self, *flags: str) -> bool:
        """Whether what some flags need is installed."""
        with tempfile.TemporaryDirectory() as folder:
            try:
                self.run("int main() {}", Path(folder), *flags)
            except AssertionError:
                return False
        return True

    def compile(
        self, text: str, folder: Path, *flags: str, standard: str = "c++17", warnings: bool = True
    ) -> Path:
        """The program of one translation unit, made once in a folder for a text and its flags.

        Fails with what the compiler says.
        """
        call = [*self.command, f"-std={standard}", *(WARNINGS if warnings else ()), *flags]
        digest = hashlib.sha256("\0".join([*call, text]).encode()).hexdigest()[:16]
        program = folder / f"program-{digest}"
        if not program.exists():
            source = folder / f"{digest}.cpp"
            source.write_text(text, "utf-8")
            made = folder / f"{digest}-{os.getpid()}"
            call += [f"-I{HEADERS}", str(source), "-o", str(made)]
            run = subprocess.run(call, capture_output=True, text=True, timeout=600, check=False)
            assert run.returncode == 0, f"{' '.join(call)}\n{run.stderr[:6000]}"
            made.replace(program)
        return program

    def run(self, text: str, folder: Path, *flags: str, standard: str = "c++17") -> str:
        """What the program of a text prints. Fails where it does not end well."""
        program = self.compile(text, folder, *flags, standard=standard)
        run = subprocess.run(
            [str(program)], capture_output=True, text=True, timeout=600, check=False
        )
        assert run.returncode == 0, f"ended with {run.returncode}\n{run.stderr[:6000]}"
        return run.stdout


@functools.cache
def compilers() -> tuple[Compiler, ...]:
    """Those that are here, one of each kind."""
    return tuple(Compiler(each.name, each.command) for each in installed())


COMPILERS = pytest.mark.parametrize(
    "compiler",
    [
        pytest.param(each, id=each.name, marks=pytest.mark.slow if number else ())
        for number, each in enumerate(compilers())
    ]
    or [pytest.param(None, marks=pytest.mark.skip("no C++ compiler"))],
)
"""Marks a test that runs once with each compiler; with others than the first one it is slow."""


def last_with(*flags: str) -> Compiler:
    """The last of our compilers, the quickest, that can build with such flags."""
    found = [each for each in compilers() if each.runs_with(*flags)]
    if not found:
        pytest.skip(f"no compiler has what {' '.join(flags)} needs")
    return found[-1]
