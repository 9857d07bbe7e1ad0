"""Unusual but correct projects, written by hand: each of `unusual/*.yml` is one, without a finding.

A file holds the files of a project, one after another: a line `# --- name` begins another one. Its
first line may permit notes: `# permitted: SM401`.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.diagnostics.diagnostic import Severity
from smachac.driver import compile_script
from smachac.report.text import render_text
from smachac.targets.python import TARGET
from smachac.verify import verify
from smachac.verify.players.python import player
from tests.trust.project_text import MAIN, ROOT, analysed

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


def with_code(files: dict[str, str]) -> dict[str, str]:
    """The project where each state type without code names a class of a package not there."""
    return {
        name: f'{text}\ncode: {{python: "stand_ins.states:{Path(name).stem}"}}\n'
        if name.startswith("templates/") and name.endswith(".yml") and "code:" not in text
        else text
        for name, text in files.items()
    }


@pytest.mark.slow
@pytest.mark.parametrize("path", PROJECTS, ids=lambda path: path.stem)
def test_an_unusual_project_runs_in_python_as_in_the_interpreter(path: Path) -> None:
    analysis = analysed(with_code(files_in(path.read_text("utf-8"))))
    compiled = compile_script(analysis, TARGET)
    errors = [item for item in compiled.report if item.severity is Severity.ERROR]
    assert render_text(errors) == render_text([])
    assert analysis.machine is not None
    name, text = next(iter(compiled.files.items()))
    played = player(name, text, analysis.machine, folders=[ROOT])
    verdict = verify(analysis.machine, {"python": played}, script=MAIN, most=20)
    assert verdict.disagreements == []


def test_there_are_many() -> None:
    assert len(PROJECTS) >= 160
