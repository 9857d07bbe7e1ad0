"""The unusual but correct projects of `unusual/`, as files with their texts.

Each of `unusual/*.yml` is one. It holds the files of a project, one after another: a line
`# --- name` begins another one.
"""

from __future__ import annotations

from pathlib import Path

from tests.trust.project_text import MAIN

PROJECTS = sorted((Path(__file__).parent / "unusual").glob("*.yml"))


def files_in(text: str) -> dict[str, str]:
    """The files of a project by name, with their texts."""
    first, *others = text.split("\n# --- ")
    files = {MAIN: first + "\n"}
    for other in others:
        name, _, content = other.partition("\n")
        files[name] = content + "\n"
    return files


def unusual_projects() -> dict[str, dict[str, str]]:
    """The files of each project, by the name of the project."""
    return {path.stem: files_in(path.read_bytes().decode("utf-8")) for path in PROJECTS}
