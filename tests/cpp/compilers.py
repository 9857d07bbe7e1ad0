"""The C++ compilers of this computer: `g++`, `clang++`, else the one in the package `ziglang`."""

from __future__ import annotations

import functools
import hashlib
import os
import shutil
import subprocess
import tempfile
import time
from collections.abc import Iterable
from contextlib import suppress
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

CLANG_FORMAT = "BasedOnStyle: LLVM\nColumnLimit: 0\n"
"""The `.clang-format` that does not change generated code: the style of LLVM without a line length.
The headers of the runtime have the style of LLVM with 100 columns."""

PROGRAMS = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "smachac-tests"
"""The compiled programs of earlier runs, by the hash of their texts, flags and compiler."""

UNUSED = 14 * 24 * 3600
"""In seconds. Programs that no run has used for so long are deleted."""


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
        """The program of one translation unit, compiled once for a text, its flags and headers.

        Fails with what the compiler says.
        """
        call = [*self.command, f"-std={standard}", *(WARNINGS if warnings else ()), *flags]
        call.append(f"-I{HEADERS}")
        digest = _digest([_version(self.command), *map(_content, call), text])
        program, kept = folder / f"program-{digest}", PROGRAMS / digest
        if not program.exists():
            made = folder / f"{digest}-{os.getpid()}"
            if kept.exists():
                kept.touch()
                shutil.copy(kept, made)
            else:
                self._compile(call, text, made)
                _keep(made, kept)
            made.replace(program)
        return program

    def _compile(self, call: list[str], text: str, made: Path) -> None:
        source = made.with_suffix(".cpp")
        source.write_text(text, "utf-8")
        call = [*call, str(source), "-o", str(made)]
        run = subprocess.run(call, capture_output=True, text=True, timeout=600, check=False)
        assert run.returncode == 0, f"{' '.join(call)}\n{run.stderr[:6000]}"

    def run(self, text: str, folder: Path, *flags: str, standard: str = "c++17") -> str:
        """What the program of a text prints. Fails where it does not end well."""
        program = self.compile(text, folder, *flags, standard=standard)
        run = subprocess.run(
            [str(program)], capture_output=True, text=True, timeout=600, check=False
        )
        assert run.returncode == 0, f"ended with {run.returncode}\n{run.stderr[:6000]}"
        return run.stdout


def _digest(parts: Iterable[str]) -> str:
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:32]


@functools.cache
def _version(command: tuple[str, ...]) -> str:
    """What a compiler prints about itself."""
    return subprocess.run(
        [*command, "--version"], capture_output=True, text=True, check=True
    ).stdout


def _content(flag: str) -> str:
    """A flag of a compiler; a folder in it by the texts of its headers."""
    folder = Path(flag.removeprefix("-I"))
    if not folder.is_dir():
        return flag
    headers = sorted(path for path in folder.rglob("*.h*") if path.is_file())
    return _digest(
        f"{path.relative_to(folder)}\0{path.read_text('utf-8', 'replace')}" for path in headers
    )


def _keep(made: Path, kept: Path) -> None:
    """Keep a program for later runs; those that no run has used for two weeks go."""
    kept.parent.mkdir(parents=True, exist_ok=True)
    oldest = time.time() - UNUSED
    for path in kept.parent.iterdir():
        with suppress(FileNotFoundError):  # another worker has removed it
            if path.stat().st_mtime < oldest:
                path.unlink()
    new = kept.with_name(f"{kept.name}-{os.getpid()}")
    shutil.copy(made, new)
    new.replace(kept)


@functools.cache
def compilers() -> tuple[Compiler, ...]:
    """Those that are here, one of each kind."""
    return tuple(Compiler(item.name, item.command) for item in installed())


COMPILERS = pytest.mark.parametrize(
    "compiler",
    [
        pytest.param(each, id=each.name, marks=pytest.mark.nightly if number else ())
        for number, each in enumerate(compilers())
    ]
    or [pytest.param(None, marks=pytest.mark.skip("no C++ compiler"))],
)
"""Marks a test that runs once with each compiler; with others than the first one it is nightly."""


def last_with(*flags: str) -> Compiler:
    """The last of our compilers, the quickest, that can build with such flags."""
    found = [compiler for compiler in compilers() if compiler.runs_with(*flags)]
    if not found:
        pytest.skip(f"no compiler has what {' '.join(flags)} needs")
    return found[-1]
