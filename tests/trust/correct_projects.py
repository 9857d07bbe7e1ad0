"""Correct projects: the examples, the cases without an error, and random ones by their seeds."""

from __future__ import annotations

import re
from collections.abc import Iterator

from smachac.frontend.files import find_project
from tests.trust.project_text import MAIN, ROOT, Project, read
from tests.trust.random_projects import correct_project

ALLOWED = "allowances"
"""A case with faults that comments allow; data has no comments."""


def texts_by_hand() -> Iterator[tuple[str, dict[str, str]]]:
    """Examples and cases as texts by file, with the sub-scripts that they share."""
    for folder in ("examples", "tests/cases"):
        for main in sorted((ROOT / folder).glob("*/main.yml")):
            here = main.parent
            if here.name.startswith("bad_") or here.name == ALLOWED:
                continue
            shared = [
                path for script in find_project(main, []).scripts for path in script.glob("*.yml")
            ]
            paths = sorted(path for path in shared if path.name != MAIN)
            paths += [*sorted(here.glob("*.yml")), *sorted(here.glob("templates/*"))]
            name = {path: path.name for path in paths}
            name |= {path: f"templates/{path.name}" for path in here.glob("templates/*")}
            yield here.name, {name[path]: path.read_text("utf-8") for path in paths}


def written_by_hand() -> Iterator[tuple[str, Project]]:
    """The same as projects. Templates stay texts; what nobody calls is left out."""
    for name, files in texts_by_hand():
        yield (
            name,
            {
                file: text if "/" in file else read(text)
                for file, text in files.items()
                if file == MAIN or "/" in file or called(file, files)
            },
        )


def called(file: str, files: dict[str, str]) -> bool:
    stem = file.removesuffix(".yml")
    return any(
        re.search(rf"\b(script|S): {re.escape(stem)}\b|\bscene: {re.escape(file)}\b", text)
        for other, text in files.items()
        if other != file
    )


def projects(count: int) -> Iterator[tuple[str, Project]]:
    """All of them, with so many random ones."""
    yield from written_by_hand()
    for seed in range(count):
        yield str(seed), correct_project(seed)
