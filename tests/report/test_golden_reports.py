"""One report in every form, as tests/reports/expected has it. `make golden` rewrites it."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.commands.check import FORMATS
from smachac.commands.cli import main
from smachac.version import __version__
from tests.support.golden import compare_file

FOLDER = Path(__file__).parents[1] / "reports"
ENDINGS = {
    "text": "txt",
    "concise": "txt",
    "github": "txt",
    "json": "json",
    "sarif": "sarif",
    "junit": "xml",
}


@pytest.mark.parametrize("form", FORMATS)
def test_golden_report(
    form: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(FOLDER)
    assert main(["check", "main.yml", "clean.yml", "--format", form]) == 1
    found = capsys.readouterr().out.replace(f'"{__version__}"', '"VERSION"')
    compare_file(found, FOLDER / "expected" / f"{form}.{ENDINGS[form]}")
