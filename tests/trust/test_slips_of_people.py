"""Slips of people: in projects by somebody who had read only the documentation.

`people/*.yml` are correct projects, in the form of `unusual/`. Each row of `people/slips.json` is a
slip in one of them: `old` becomes `new` in `file`. `places` are the lines at which a finding helps,
`lost` the words that were meant. `found` and `named` are what was measured: 185 and 185 of the 193
rows, and nothing in the correct projects; 177 and 170 before any rule was repaired with them.
Neither may be lost; a row that gains one is changed.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from smachac.commands.cli import main
from tests.support.examples import every
from tests.trust.unusual_projects import files_in

PEOPLE = Path(__file__).parent / "people"
PROJECTS = [path.stem for path in sorted(PEOPLE.glob("*.yml"))]
SLIPS: list[dict[str, Any]] = json.loads((PEOPLE / "slips.json").read_text("utf-8"))


def files_of(project: str) -> dict[str, str]:
    return files_in((PEOPLE / f"{project}.yml").read_text("utf-8"))


def report_of(
    files: Mapping[str, str], folder: Path, capsys: pytest.CaptureFixture[str]
) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """The errors and warnings of a project in a new folder, and the edits of proven repairs."""
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, "utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        main(["check", "main.yml", "--format", "json", "--strict"])
    found = json.loads(capsys.readouterr().out)
    repairs = (cluster["repair"] for cluster in found["clusters"])
    edits = [edit for repair in repairs if repair for edit in repair["edits"]]
    return [item for item in found["diagnostics"] if item["severity"] != "info"], edits


@pytest.mark.parametrize("project", every(4, PROJECTS))
def test_the_projects_are_correct(
    project: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert report_of(files_of(project), tmp_path, capsys) == ([], [])


@pytest.mark.parametrize("slip", every(6, SLIPS), ids=lambda slip: slip["name"])
def test_a_slip_is_found_and_named(
    slip: dict[str, Any], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = files_of(slip["project"])
    assert files[slip["file"]].count(slip["old"]) == 1
    files[slip["file"]] = files[slip["file"]].replace(slip["old"], slip["new"])
    report, edits = report_of(files, tmp_path, capsys)
    places = [(place["file"], place["line"]) for item in (*report, *edits)
              if (place := item["place"])]  # fmt: skip
    found = any((file, line) in places for file, line in slip["places"])
    meant = re.compile(rf"(?<!\w){re.escape(slip['lost'])}(?!\w)")
    words = [
        *(edit["text"] for edit in edits),
        *(f"{item['message']} {item['help']}" for item in report),
    ]
    named = any(map(meant.search, words))
    assert (found, named) == (slip["found"], slip["named"]), report
