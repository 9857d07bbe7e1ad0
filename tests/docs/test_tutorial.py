"""docs/tutorial.md and docs/robots.md: every command, in order, in an empty folder."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from smachac.commands.cli import main

DOCS = Path(__file__).parents[2] / "docs"
PAGES = ("tutorial", "robots")
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


@pytest.mark.parametrize("page", PAGES)
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
