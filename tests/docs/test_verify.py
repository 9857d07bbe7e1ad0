"""docs/verify.md shows what is printed."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from smachac.commands.cli import main

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "verify.md").read_text("utf-8")


def test_the_report_is_the_one_that_is_printed(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Without C++, which agrees in tests/verify."""
    found = re.search(
        r"^\$ smachac (verify \S+) --targets python,cpp\n(.*?)^```$", PAGE, re.M | re.S
    )
    assert found is not None
    monkeypatch.chdir(ROOT)
    assert main(found[1].split()) == 0
    assert capsys.readouterr().out == found[2].replace("cpp: agrees\n", "")


def test_every_kind_of_path_is_described() -> None:
    (kinds,) = re.findall(r"^200 paths \((.*)\)$", PAGE, re.MULTILINE)
    described = re.findall(r"^\d\. \*\*(\w+)\*\* paths", PAGE, re.MULTILINE)
    assert re.findall(r"[a-z]+", kinds) == described
