"""Terminals: whether a stream is one, its width, colours, links to files, a line of progress."""

from __future__ import annotations

import os
from argparse import Namespace
from time import monotonic

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from typing import Any


def wants_colour(arguments: Namespace, stream: Any) -> bool:
    """Whether reports are coloured: `--colour`, else the variables NO_COLOR and FORCE_COLOR, else
    on a terminal."""
    if arguments.colour != "auto":
        return bool(arguments.colour == "always")
    if os.environ.get("NO_COLOR"):
        return False
    return bool(os.environ.get("FORCE_COLOR")) or is_terminal(stream)


def is_terminal(stream: Any) -> bool:
    """Whether a stream is a terminal that understands control sequences."""
    return bool(stream.isatty()) and os.environ.get("TERM") != "dumb"


def terminal_width(stream: Any) -> int:
    """The columns of a terminal: the variable COLUMNS, else its size, else 80."""
    try:
        return int(os.environ.get("COLUMNS", "")) or 80
    except ValueError:
        try:
            return os.get_terminal_size(stream.fileno()).columns or 80
        except (OSError, ValueError):
            return 80


LINKING = ("WezTerm", "iTerm.app", "vscode", "ghostty", "Hyper", "rio")
"""Values of TERM_PROGRAM of terminals in which a text can be a link."""


def wants_links(stream: Any) -> bool:
    """Whether places of findings are links: the variable FORCE_HYPERLINK, else on a terminal whose
    variables name one that supports them (OSC 8)."""
    forced = os.environ.get("FORCE_HYPERLINK")
    if forced:
        return forced != "0"
    if not is_terminal(stream):
        return False
    vte, konsole = (os.environ.get(name, "") for name in ("VTE_VERSION", "KONSOLE_VERSION"))
    return (
        os.environ.get("TERM_PROGRAM") in LINKING
        or os.environ.get("TERM") in ("xterm-kitty", "foot", "alacritty")
        or "WT_SESSION" in os.environ
        or (vte.isdecimal() and int(vte) >= 5000)
        or (konsole.isdecimal() and int(konsole) >= 201200)
    )


def file_uri(name: str) -> str | None:
    """The URI of a file; None if there is no such file."""
    from pathlib import Path

    return Path(name).absolute().as_uri() if os.path.exists(name) else None  # noqa: PTH110


class ProgressLine:
    """A line that shows how far long work is, and is erased at the end. It changes at most ten
    times a second; nothing is printed if the stream is no terminal."""

    def __init__(self, stream: Any) -> None:
        self._stream = stream
        self._shows = is_terminal(stream)
        self._due = 0.0

    def __enter__(self) -> ProgressLine:
        return self

    def __call__(self, text: str) -> None:
        if self._shows and (now := monotonic()) >= self._due:
            self._due = now + 0.1
            self._put(text[: terminal_width(self._stream) - 1])

    def __exit__(self, *error: object) -> None:
        if self._shows:
            self._put("")

    def _put(self, text: str) -> None:
        self._stream.write(f"\r\x1b[2K{text}")
        self._stream.flush()
