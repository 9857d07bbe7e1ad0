"""The project file: a value of any shape under any key is a finding or a setting."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import pytest

from smachac.commands.cli import main
from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.driver import CODES
from smachac.frontend.config import PROJECT_FILES, SETTINGS, read_project
from smachac.report.text import render_text

SCALARS = ("1", "1.5", "true", '""', '"x"', '"\\u0000"', "1979-05-27", "07:32:00", "nan", "-inf")
LISTS = ("[]", "[1]", '["off"]', '[["x"]]', "[{a = 1}]", '["x", 1]', '["*", "["]', '["../.."]')
TABLES = ("{}", "{a = 1}", "{a = {b = [1]}}", '{"" = ["off"]}', '{SM2 = ["off"]}')
KEYS = (
    *(*SETTINGS, "unknown", "tool", "tool.smachac", '""', '"a b"', '"\\u0000"'),
    *("severity.SM2", "severity.SM204", 'severity.""', "severity.x", 'severity."SM2 "'),
)


@pytest.mark.parametrize("name", PROJECT_FILES)
@pytest.mark.parametrize("table", ["", "tool.smachac."])
def test_every_shape_under_every_key(name: str, table: str, tmp_path: Path) -> None:
    for key, value in product(KEYS, (*SCALARS, *LISTS, *TABLES)):
        source = Source(name, f"{table}{key} = {value}\n")
        for codes in (CODES, None):
            report: Report = []
            read_project(source, tmp_path / name, report, codes)
            assert all(finding.finding.help for finding in report)
            assert len(render_text(report)) < 3000


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('[severity]\nSM2 = ["off"]', "a severity is a text, not a list"),
        ("[severity]\nSM2 = {x = 1}", "a severity is a text, not a table"),
        ("[severity.SM204]\nlevel = 1", "a severity is a text, not a table"),
        ("[severity]\nSM204 = 07:32:00", "a severity is a text, not a time"),
        ("[severity]\nSM204 = false", "a severity is a text, not a truth value"),
        ('[severity]\n"" = "off"', "no code begins with ``"),
        ('"" = 1', "`` is not a setting of smachac"),
        ("ros = [2]", "`ros` must be 1 or 2"),
    ],
)
def test_the_finding_for_a_wrong_shape(
    text: str, message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "smachac.toml").write_text(text)
    script = tmp_path / "main.yml"
    script.write_text(
        "name: sm\ntemplate: Base\noutcomes: [done]\nstates:\n"
        "- A: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}\n"
    )
    assert main(["check", str(script)]) == 1
    assert f"error[SM007]: {message}" in capsys.readouterr().out
