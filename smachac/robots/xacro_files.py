"""xacro, the macro language of URDF: a file is expanded by the package `xacro`, in a process of its
own that is restricted (docs/robots.md, xacro).

The simulation and the checker expand files in the same way.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from smachac.robots.files import Packages
from smachac.robots.xml_tree import TextPlace, XmlError

SUFFIX = ".xacro"
"""The ending of macro files."""
EXPAND = "expand the file with `xacro`, and name the resulting file"
INSTALL = f"run `pip install 'smachac[xacro]'`, or {EXPAND}"
_LONGEST_PART = 120
"""In characters: the length of a part of an expanded text in a message."""
_LONGEST_RUN = 30.0
"""Time (s) in which the process has to end."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Expanded:
    """The URDF text of a macro file, and the files that were read for it."""

    text: str
    files: tuple[Path, ...]


class XacroError(XmlError):
    """A macro file that cannot be expanded; `place` is in `text`, the text of `file`."""

    def __init__(
        self, message: str, help: str, file: Path, text: str = "", place: TextPlace = (0, 0)
    ) -> None:
        super().__init__(message, place, help)
        self.file, self.text = file, text


def expand(path: Path, arguments: Mapping[str, str], packages: Packages) -> Expanded:
    """The URDF text that a macro file describes. Raises XacroError.

    `arguments` are the values of `<xacro:arg>`. `packages` are folders for `$(find PACKAGE)`, which
    `files.package_folders` completes.
    """
    import subprocess  # slow to load, and few scripts have macro files

    task = {
        "path": sys.path,
        "file": str(path),
        "arguments": dict(arguments),
        "packages": {name: str(folder) for name, folder in packages.items()},
    }
    program = Path(__file__).with_name("xacro_process.py")
    try:
        done = subprocess.run(
            [sys.executable, "-I", str(program)],
            input=json.dumps(task),
            capture_output=True,
            encoding="utf-8",
            timeout=_LONGEST_RUN,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise _too_long(path) from None
    try:
        answer = json.loads(done.stdout)
    except ValueError:
        if done.returncode < 0:  # a signal: it has reached a limit
            raise _too_long(path) from None
        reason = (done.stderr.strip().splitlines() or ["it has no output"])[-1]
        raise XacroError(f"xacro cannot run: {reason}", EXPAND, path) from None
    if "text" in answer:
        return Expanded(text=answer["text"], files=tuple(map(Path, answer["files"])))
    start, end = answer["place"]
    raise XacroError(
        answer["message"], answer["help"], Path(answer["file"]), answer["source"], (start, end)
    )


def located(error: XmlError, expanded: str, file: Path, text: str) -> XacroError:
    """The mistake in an expanded text, at the same text in its macro file, if that has it once."""
    if isinstance(error, XacroError):
        return error
    start, end = error.place
    part = expanded[start:end]
    place = (0, 0)
    if part and text.count(part) == 1:
        place = text.index(part), text.index(part) + len(part)
    element = " ".join(expanded[expanded.rfind("<", 0, start + 1) : end].split())
    message = f"{error.message} (in the expanded text: `{element[:_LONGEST_PART]}`)"
    return XacroError(message, error.help, file, text, place)


def _too_long(path: Path) -> XacroError:
    message = "the macro file takes more time or memory to expand than is allowed"
    return XacroError(message, f"look for a macro that calls itself, or {EXPAND}", path)
