"""Standard output and standard error of the program: a write to them never raises an error."""

from __future__ import annotations

import os
import sys
from io import BufferedWriter, FileIO, TextIOWrapper

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from typing import Any


class _Raw(FileIO):
    """A stream without buffer. The first error of a write is kept in `failure`, and from then on
    all text is dropped: a command could confuse the error with one of the files that it writes."""

    failure: OSError | None = None

    def write(self, data: Any) -> int:
        try:
            while self.failure is None:
                if (written := super().write(data)) is not None:
                    return written
                import select  # the pipe is full, and its reader made it non-blocking

                select.select([], [self], [])
        except OSError as error:
            self.failure = error
        return len(data)


class _Stream(TextIOWrapper):
    raw: _Raw


def open_streams() -> None:
    """Replace standard output and standard error; text to a closed one is dropped.

    A closed one, and closed standard input, is opened on the null device, also for the processes
    that this one starts: the next file or pipe would have its number otherwise.
    """
    if sys.stdin is None:
        os.set_inheritable(os.open(os.devnull, os.O_RDONLY), True)
    for name in ("stdout", "stderr"):
        old = getattr(sys, name)
        if old is None:
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.set_inheritable(nowhere, True)
            setattr(sys, name, open(nowhere, "w", encoding="utf-8"))  # noqa: PTH123, SIM115
            continue
        raw = _Raw(old.fileno(), "w", closefd=False)
        new = _Stream(
            raw if old.write_through else BufferedWriter(raw),
            encoding=old.encoding,
            errors=old.errors,
            line_buffering=old.line_buffering,
            write_through=old.write_through,
        )
        new.raw = raw
        setattr(sys, name, new)


def print_failure() -> OSError | None:
    """The error because of which standard output accepts no more text."""
    return sys.stdout.raw.failure if isinstance(sys.stdout, _Stream) else None


def escape_unknown_characters() -> None:
    """Streams that cannot show a character show an escape instead."""
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)
        if reconfigure is not None:
            reconfigure(errors="backslashreplace")
