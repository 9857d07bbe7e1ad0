"""One report in every form, as tests/reports/expected has it. `make golden` rewrites it."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from smachac.commands.cli import FORMATS, main
from smachac.version import __version__

FOLDER = Path(__file__).parent / "reports"
ENDINGS = {"text": "txt", "github": "txt", "json": "json", "sarif": "sarif", "junit": "xml"}
REWRITE = os.environ.get("SMACHAC_GOLDEN") == "rewrite"


@pytest.mark.parametrize("form", FORMATS)
def test_golden_report(
    form: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(FOLDER)
    assert main(["check", "main.yml", "clean.yml", "--format", form]) == 1
    found = capsys.readouterr().out.replace(f'"{__version__}"', '"VERSION"')
    path = FOLDER / "expected" / f"{form}.{ENDINGS[form]}"
    if REWRITE:
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(found.encode())
    assert found == path.read_bytes().decode(), f"{path} differs"
