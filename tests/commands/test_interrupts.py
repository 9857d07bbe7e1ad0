"""Ctrl-C at any moment ends a command with its exit code and one line, never with a traceback."""

from __future__ import annotations

import os
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SCRIPT = str(ROOT / "examples" / "01_sequence" / "main.yml")

HOOK = """\
import atexit, os, signal, sys

at = int(os.environ["INTERRUPT_AT"])
count = 0

def interrupt(event, arguments):
    global count
    if event == "import" and (count or arguments[0].startswith("smachac.commands")):
        count += 1
        if count == at:
            signal.raise_signal(signal.SIGINT)

sys.addaudithook(interrupt)
if not at:
    atexit.register(lambda: print(count, file=sys.stderr))
"""
"""A module `sitecustomize` that sends SIGINT at the n-th import, counted from the first import of
the program itself on; the number 0 prints how many there are."""

MODULE = ("-m", "smachac")


def console_script() -> tuple[str, str]:
    """What the installed script `smachac` runs."""
    toml = import_module("tomllib" if sys.version_info >= (3, 11) else "tomli")
    project = toml.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    module, function = project["scripts"]["smachac"].split(":")
    return "-c", f"import sys\nfrom {module} import {function}\nsys.exit({function}())"


def interrupted(
    folder: Path, at: int, words: list[str], program: tuple[str, str] = MODULE
) -> subprocess.CompletedProcess[str]:
    (folder / "sitecustomize.py").write_text(HOOK)
    path = os.pathsep.join([str(folder), str(ROOT)])
    return subprocess.run(
        [sys.executable, *program, *words],
        env={**os.environ, "PYTHONPATH": path, "INTERRUPT_AT": str(at)},
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


def moments(folder: Path, words: list[str]) -> int:
    return int(interrupted(folder, 0, words).stderr.split()[-1])


def expect_no_traceback(folder: Path, words: list[str], step: int) -> None:
    """Interrupt a command at every `step`-th import: at most the last ones come when the command
    has ended."""
    last = moments(folder, words)
    assert last > 10
    codes = []
    for at in range(1, last + 1, step):
        ended = interrupted(folder, at, words)
        codes.append(ended.returncode)
        if ended.returncode:
            assert (ended.returncode, ended.stderr) == (130, "interrupted\n")
        else:
            assert ended.stderr == ""
    assert codes[0] == 130
    assert codes.count(130) >= len(codes) - 15 // step


def test_at_every_import_of_help(tmp_path: Path) -> None:
    expect_no_traceback(tmp_path, ["--help"], 1)


def test_at_the_first_imports_of_the_console_script(tmp_path: Path) -> None:
    for at in range(1, 12):
        ended = interrupted(tmp_path, at, ["--version"], console_script())
        assert (ended.returncode, ended.stderr) == (130, "interrupted\n")


@pytest.mark.slow
@pytest.mark.parametrize(
    "words",
    [["check", SCRIPT], ["build", SCRIPT, "-t", "python", "-o", "out"], ["run", SCRIPT, "-q"]],
    ids=lambda words: words[0],
)
def test_at_some_imports_of_commands(tmp_path: Path, words: list[str]) -> None:
    expect_no_traceback(tmp_path, words, 59)


@pytest.mark.nightly
@pytest.mark.parametrize(
    "words",
    [["check", SCRIPT], ["verify", SCRIPT], ["fmt", SCRIPT, "--check"]],
    ids=lambda words: words[0],
)
def test_at_more_imports_of_commands(tmp_path: Path, words: list[str]) -> None:
    expect_no_traceback(tmp_path, words, 13)
