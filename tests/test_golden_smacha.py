"""What SMACHA's scripts may hold, feature by feature, and the table that lists it (docs/smacha.md).

Each case has its report, its graph and its Python; `make golden` rewrites them.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from test_golden import compare, outputs

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "tests" / "cases" / "smacha"
CASES = sorted(path.parent for path in FOLDER.glob("*/main.yml"))
TABLE = [
    line
    for line in (ROOT / "docs" / "smacha.md").read_text(encoding="utf-8").splitlines()
    if line.startswith("| ") and not line.startswith(("| SMACHA", "| ---"))
]
SECTIONS = [f"1.{number}" for number in range(1, 11)]


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_golden(case: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(case)
    found = outputs(("ir", "python"))
    compare(found, case / "expected")
    assert ("error[" in found["report.txt"]) == (len(found) == 1)
    assert (len(found["report.txt"]) > 0) >= case.name.startswith("bad_")


def named_by(row: str) -> list[str]:
    """What the last column of a row names."""
    return re.findall(r"`([^`]+)`", row.rstrip("| ").rpartition("|")[2])


def exists(name: str) -> bool:
    """Whether there is such a case, or such a test in such a file."""
    file, _, test = name.partition("::")
    if name.startswith("reworked/"):
        return (ROOT / "tests" / name / "command").is_file()
    if not test:
        return (ROOT / "tests" / "cases" / name / "main.yml").is_file()
    path = ROOT / "tests" / file
    return path.is_file() and f"def {test}(" in path.read_text(encoding="utf-8")


@pytest.mark.parametrize("row", TABLE, ids=lambda row: row.split("|")[1].strip()[:40])
def test_every_row_names_tests_that_are_there(row: str) -> None:
    named = named_by(row)
    assert named
    assert [name for name in named if not exists(name)] == []


def test_every_case_is_in_the_table() -> None:
    named = {name for row in TABLE for name in named_by(row)}
    assert [case.name for case in CASES if f"smacha/{case.name}" not in named] == []


def test_there_are_enough_cases_and_all_sections() -> None:
    assert len(CASES) >= 40
    text = (ROOT / "docs" / "smacha.md").read_text(encoding="utf-8")
    assert [number for number in SECTIONS if f"## {number} " not in text] == []
