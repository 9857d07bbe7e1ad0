"""Unusual but correct projects, written by hand: each of `unusual/*.yml` is one, without a finding.

A file holds the files of a project, one after another: a line `# --- name` begins another one. Its
first line may permit notes: `# permitted: SM401`.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.diagnostics.diagnostic import Severity
from smachac.report.text import render_text
from tests.trust.project_text import MAIN, analysed

PROJECTS = sorted((Path(__file__).parent / "unusual").glob("*.yml"))
PERMITTED = "# permitted:"


def files_in(text: str) -> dict[str, str]:
    """The files of a project by name, with their texts."""
    first, *others = text.split("\n# --- ")
    files = {MAIN: first + "\n"}
    for each in others:
        name, _, content = each.partition("\n")
        files[name] = content + "\n"
    return files


@pytest.mark.parametrize("path", PROJECTS, ids=lambda path: path.stem)
def test_an_unusual_project_has_no_finding(path: Path) -> None:
    text = path.read_text("utf-8")
    head = text.partition("\n")[0]
    permitted = head.removeprefix(PERMITTED).split() if head.startswith(PERMITTED) else []
    report = [
        item
        for item in analysed(files_in(text)).report
        if item.severity is not Severity.INFO or item.code not in permitted
    ]
    assert render_text(report) == render_text([])


def test_there_are_many() -> None:
    assert len(PROJECTS) >= 80
