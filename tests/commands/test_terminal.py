"""Commands on a pseudo-terminal and in a pipe: colours, width, links, progress."""

from __future__ import annotations

import fcntl
import io
import os
import pty
import re
import struct
import subprocess
import sys
import termios
from argparse import Namespace
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TextIO

import pytest

from smachac.commands.terminal import file_uri, terminal_width, wants_colour, wants_links

ROOT = Path(__file__).parents[2]
SCRIPT = """\
name: fetch
template: Base
outcomes: [succeeded, aborted]
states:
  - FIND:
      template: ScriptedState
      outcomes: [found, nothing]
      transitions: {found: GRAPS, nothing: aborted}
  - GRASP:
      template: ScriptedState
      outcomes: [held, lost]
      transitions: {held: succeeded, lost: aborted}
"""
SETTINGS = (
    *("NO_COLOR", "FORCE_COLOR", "FORCE_HYPERLINK", "COLUMNS", "TERM_PROGRAM", "WT_SESSION"),
    *("VTE_VERSION", "KONSOLE_VERSION"),
)
"""Variables that change what a terminal gets; the tests start without them."""

ERASE = "\r\x1b[2K"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "main.yml").write_text(SCRIPT, "utf-8")
    (tmp_path / "right.yml").write_text(SCRIPT.replace("GRAPS", "GRASP"), "utf-8")
    return tmp_path


def environment(changes: Mapping[str, str]) -> dict[str, str]:
    kept = {name: value for name, value in os.environ.items() if name not in SETTINGS}
    return {**kept, "TERM": "xterm-256color", "PYTHONPATH": str(ROOT), **changes}


def on_terminal(folder: Path, *words: str, width: int, changes: Mapping[str, str]) -> str:
    """What a command prints to a terminal of a width."""
    master, slave = pty.openpty()
    fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 24, width, 0, 0))
    with subprocess.Popen(
        [sys.executable, "-m", "smachac", *words],
        cwd=folder,
        env=environment(changes),
        stdin=slave,
        stdout=slave,
        stderr=slave,
    ):
        os.close(slave)
        parts = []
        try:
            while part := os.read(master, 4096):
                parts.append(part)
        except OSError:  # Linux: the last writer has closed the terminal
            pass
    os.close(master)
    return b"".join(parts).decode().replace("\r\n", "\n")


def in_pipe(folder: Path, *words: str, changes: Mapping[str, str]) -> str:
    done = subprocess.run(
        [sys.executable, "-m", "smachac", *words],
        cwd=folder,
        env=environment(changes),
        capture_output=True,
        text=True,
        check=False,
    )
    return done.stdout + done.stderr


def test_a_terminal_gets_colours_links_and_lines_that_fit(folder: Path) -> None:
    text = on_terminal(folder, "check", "main.yml", width=60, changes={"TERM_PROGRAM": "vscode"})
    assert text.startswith("\x1b[1;31merror[SM101]\x1b[0m")
    link = re.search(r"\x1b]8;;(.*?)\x1b\\(.*?)\x1b]8;;\x1b\\", text)
    assert link is not None
    assert link[1] == (folder / "main.yml").as_uri()
    assert link[2] == "main.yml:8:28"
    bare = re.sub(r"\x1b]8;;.*?\x1b\\|\x1b\[[0-9;]*m", "", text).split("\n")
    assert max(map(len, bare)) <= 60
    assert bare[:2] == [
        "error[SM101]: `GRAPS` is neither a state nor an outcome of",
        "              `fetch`",
    ]
    assert "8 |       transitions: {found: GRAPS, nothing: aborted}" in bare


def test_a_pipe_gets_plain_text(folder: Path) -> None:
    plain = in_pipe(folder, "check", "main.yml", changes={"TERM_PROGRAM": "vscode"})
    assert plain.startswith("error[SM101]: `GRAPS` is neither a state nor an outcome of `fetch`\n")
    assert "\x1b" not in plain


@pytest.mark.slow
def test_verify_shows_progress_on_a_terminal_and_erases_it(folder: Path) -> None:
    text = on_terminal(folder, "verify", "right.yml", width=80, changes={})
    before, _, after = text.rpartition(ERASE)
    assert f"{ERASE}paths found: 1" in before
    assert after == in_pipe(folder, "verify", "right.yml", changes={})
    assert "paths found" not in after


def test_help_fits_the_terminal(folder: Path) -> None:
    text = on_terminal(folder, "check", "--help", width=60, changes={})
    options = text[text.index("options:") : text.index("examples:")]
    assert max(map(len, options.split("\n"))) <= 60


@pytest.fixture
def terminal(monkeypatch: pytest.MonkeyPatch) -> Iterator[TextIO]:
    """A stream to a terminal of 72 columns, and an environment without settings."""
    for name in SETTINGS:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("TERM", "xterm-256color")
    master, slave = pty.openpty()
    fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 72, 0, 0))
    with os.fdopen(slave, "w") as stream:
        yield stream
    os.close(master)


@pytest.mark.parametrize(
    ("changes", "option", "on_terminal", "elsewhere"),
    [
        ({}, "auto", True, False),
        ({"NO_COLOR": "1"}, "auto", False, False),
        ({"NO_COLOR": ""}, "auto", True, False),
        ({"FORCE_COLOR": "1"}, "auto", True, True),
        ({"FORCE_COLOR": ""}, "auto", True, False),
        ({"FORCE_COLOR": "1", "NO_COLOR": "1"}, "auto", False, False),
        ({"TERM": "dumb"}, "auto", False, False),
        ({"NO_COLOR": "1"}, "always", True, True),
        ({"FORCE_COLOR": "1"}, "never", False, False),
    ],
)
def test_colours(
    changes: dict[str, str],
    option: str,
    on_terminal: bool,
    elsewhere: bool,
    terminal: TextIO,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for name, value in changes.items():
        monkeypatch.setenv(name, value)
    assert wants_colour(Namespace(colour=option), terminal) is on_terminal
    assert wants_colour(Namespace(colour=option), io.StringIO()) is elsewhere


@pytest.mark.parametrize(
    ("changes", "links"),
    [
        ({}, False),
        ({"TERM_PROGRAM": "vscode"}, True),
        ({"TERM_PROGRAM": "Apple_Terminal"}, False),
        ({"TERM": "xterm-kitty"}, True),
        ({"WT_SESSION": "1"}, True),
        ({"VTE_VERSION": "7200"}, True),
        ({"VTE_VERSION": "4999"}, False),
        ({"KONSOLE_VERSION": "220401"}, True),
        ({"FORCE_HYPERLINK": "1"}, True),
        ({"TERM_PROGRAM": "vscode", "FORCE_HYPERLINK": "0"}, False),
    ],
)
def test_links(
    changes: dict[str, str], links: bool, terminal: TextIO, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, value in changes.items():
        monkeypatch.setenv(name, value)
    assert wants_links(terminal) is links
    assert wants_links(io.StringIO()) is (changes == {"FORCE_HYPERLINK": "1"})


def test_width(terminal: TextIO, monkeypatch: pytest.MonkeyPatch) -> None:
    assert terminal_width(terminal) == 72
    assert terminal_width(io.StringIO()) == 80
    monkeypatch.setenv("COLUMNS", "50")
    assert terminal_width(terminal) == 50


def test_only_files_have_a_uri(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)
    assert file_uri("main.yml") == (folder / "main.yml").as_uri()
    assert file_uri("no.yml") is None
