"""Every command of four pages, such as docs/tutorial.md, in order, in an empty folder."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from bench import tutorial
from smachac.commands.cli import main

DOCS = Path(__file__).parents[2] / "docs"
PAGES = ("tutorial", "robots", "scenarios", "sweep")
REWRITE = os.environ.get("SMACHAC_GOLDEN") == "rewrite"
NEEDS = {"g++": "g++", "build/fetch": "g++"}
"""Programs that a command needs, by its first word."""


def blocks(page: str) -> list[tuple[str, str]]:
    """The language and the text of each block of code."""
    text = (DOCS / f"{page}.md").read_text("utf-8")
    return re.findall(r"^```(\w+)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def commands(block: str) -> Iterator[tuple[str, str]]:
    """Each command of a console block, and the output shown below it."""
    for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
        command, _, shown = part.partition("\n")
        yield command, shown


def without_times(text: str) -> str:
    return re.sub(r"\d+\.\d\d s$", "0.00 s", text, flags=re.MULTILINE)


def output(command: str, capsys: pytest.CaptureFixture[str]) -> str:
    words = shlex.split(command)
    if words[0] == "smachac":
        main(words[1:])
        return capsys.readouterr().out
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    return done.stdout + done.stderr


def missing(command: str) -> bool:
    """Whether a command needs a compiler or a simulator that is not installed."""
    program = NEEDS.get(command.split()[0], "g++" if "cpp" in command else "")
    if re.match(r"smachac run (arm|lift|reach)\.yml", command):
        pytest.importorskip("pybullet")
    return bool(program) and shutil.which(program) is None


@pytest.mark.parametrize("page", [pytest.param(PAGES[0], marks=pytest.mark.slow), *PAGES[1:]])
def test_golden_page_prints_what_is_shown(
    page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    path = DOCS / f"{page}.md"
    for kind, text in blocks(page):
        if kind == "sh":
            continue
        if kind != "console":
            name = re.match(r"(?:#|<!--) (\S+)", text)
            assert name is not None, text
            (tmp_path / name[1]).write_text(text, "utf-8")
            continue
        for command, shown in commands(text):
            if missing(command):
                pytest.skip(f"no program for: {command}")
            found = output(command, capsys)
            if REWRITE and without_times(found) != without_times(shown):
                head = f"$ {command}\n"
                changed = path.read_text("utf-8").replace(head + shown, head + found, 1)
                path.write_text(changed, "utf-8")
                shown = found
            assert without_times(found) == without_times(shown), command


@pytest.mark.parametrize("page", PAGES)
def test_pages_have_files_and_commands(page: str) -> None:
    kinds = [kind for kind, _ in blocks(page)]
    assert {"yaml", "console"} <= set(kinds) <= {"yaml", "python", "xml", "console", "sh"}


@pytest.mark.slow
def test_a_shell_runs_the_tutorial_as_printed(tmp_path: Path) -> None:
    """All but its installation, which needs the network: bench/tutorial.py runs it as well."""
    pytest.importorskip("pybullet")
    if shutil.which("g++") is None:
        pytest.skip("no g++")
    program = tmp_path / "bin" / "smachac"
    program.parent.mkdir()
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m smachac "$@"\n')
    program.chmod(0o755)
    path = f"{program.parent}{os.pathsep}{os.environ['PATH']}"
    environment = {**os.environ, "PATH": path, "PYTHONPATH": str(tutorial.ROOT)}
    folder = tmp_path / "empty"
    folder.mkdir()
    done = list(tutorial.typed(folder, installed=True, environment=environment))
    page = tutorial.PAGE.read_text("utf-8")
    assert len(done) == page.count("\n$ ")
    assert [(item.step.command, item.printed) for item in done if not item.as_printed] == []


def test_the_tutorial_begins_with_the_installation() -> None:
    first = next(tutorial.steps(tutorial.PAGE.read_text("utf-8")))
    assert isinstance(first, tutorial.Step)
    assert first.section == tutorial.INSTALL
    assert first.command.startswith(f"git clone {tutorial.ADDRESS}")


@pytest.mark.parametrize(
    ("printed", "code", "right"),
    [("a 0.10 s\n", 1, True), ("b 0.10 s\n", 0, False), ("a 0.10\n", 0, False)],
)
def test_a_command_that_prints_something_else_is_found(
    printed: str, code: int, right: bool
) -> None:
    step = tutorial.Step(section="2", command="x", shown="a 0.25 s\n")
    done = tutorial.Done(step=step, printed=printed, code=code, seconds=1.0)
    assert done.as_printed is right
