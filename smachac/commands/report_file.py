"""A report in a file: the option `-o FILE` of the commands with a report."""

from __future__ import annotations

import contextlib
import io
import sys
from collections.abc import Callable
from pathlib import Path

from smachac.commands.files import foreign_files, not_written, write_files
from smachac.commands.output import FINDINGS, USAGE, usage
from smachac.commands.writing import PartlyWrittenError

INPUTS = (
    ".yml",
    ".yaml",
    ".py",
    ".toml",
    ".msg",
    ".srv",
    ".action",
    ".urdf",
    ".xacro",
    ".hpp",
    ".h",
)
"""Suffixes of files that people write: a report replaces none of them."""


def to_file(path: Path, command: Callable[[], int]) -> int:
    """Run a command with its standard output in a file, which is written as a whole after the
    command has ended; the exit code."""
    if path.is_dir():
        return usage(f"--output {path} is a folder")
    if path.suffix.lower() in INPUTS and foreign_files(path.parent, [path.name]):
        return usage(f"--output {path} exists and is no report: it was not overwritten")
    with contextlib.redirect_stdout(io.StringIO()) as text:
        code = command()
    if code == USAGE:
        return code
    try:
        write_files(path.parent, {path.name: text.getvalue()})
    except (OSError, PartlyWrittenError) as error:
        print(not_written(error), file=sys.stderr)
        return FINDINGS
    return code
