"""The examples of problems and rules: Wrong gives exactly its code, Right nothing."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from smachac.analysis import properties
from smachac.checks.robot.workspace import unreachable
from smachac.diagnostics.diagnostic import Code, Diagnostic, Report, Severity
from smachac.driver import CODES, analyse, build
from smachac.driver.python_machines import PythonProject
from smachac.frontend.files import Disk, disk_library, read_source
from smachac.report.explain_code import MAIN, MAIN_IN_PYTHON, explanation
from smachac.targets import load_target
from smachac.targets.hiding_files import hiding_files

EVERY = [pytest.param(CODES[name], id=name) for name in sorted(CODES)]


TARGETS = {"SM601": "cpp", "SM602": "cpp", "SM604": "cpp"}
"""What the examples of a code are built for, where that is not Python."""


IN_THE_MESSAGE = {
    "SM105", "SM204", "SM207", "SM210", "SM402",
    "SM606", "SM610", "SM701", "SM704", "SM804",
}  # fmt: skip
"""Codes whose messages contain what happens if the fault is left."""


def judged(files: Mapping[str, str], folder: Path, target_name: str = "python") -> Report:
    """What check and then build say of a script with the files around it."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")
    if MAIN_IN_PYTHON in files:
        return PythonProject(Disk()).read(folder / MAIN_IN_PYTHON).report
    main = folder / MAIN
    report: Report = []
    library = disk_library(main, report)
    source = read_source(main, report)
    assert source is not None
    analysis = analyse(source, library, report, unreachable)
    target = load_target(target_name)
    assert target is not None
    found = analysis.report
    if analysis.checked is not None:
        files = build(analysis.checked, target, library, found)
        found.extend(hiding_files(files, analysis.checked))
    return found


def above_info(report: Report) -> list[Diagnostic]:
    return [item for item in report if item.severity is not Severity.INFO]


def shown(report: Report) -> list[str]:
    return [f"{item.span}: {item.code} {item.finding.message}" for item in report]


@pytest.mark.parametrize("code", EVERY)
def test_wrong_gives_exactly_its_code(
    code: Code, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(properties, "MOST_PAIRS", 2_000)  # the limit of SM704, which takes seconds
    report = above_info(judged(explanation(code).wrong, tmp_path, TARGETS.get(code.code, "python")))
    assert {item.code for item in report} == {code.code}, shown(report)
    assert all(item.help for item in report), shown(report)
    assert (code.code in IN_THE_MESSAGE) != all(item.effect for item in report), shown(report)


@pytest.mark.slow
def test_the_example_of_a_limit_exceeds_the_documented_limit(tmp_path: Path) -> None:
    code = CODES["SM704"]
    assert f"{properties.MOST_PAIRS:,}" in code.explanation
    report = above_info(judged(explanation(code).wrong, tmp_path))
    assert {item.code for item in report} == {code.code}, shown(report)


@pytest.mark.parametrize("code", EVERY)
def test_right_gives_nothing_above_an_info(code: Code, tmp_path: Path) -> None:
    report = above_info(judged(explanation(code).right, tmp_path, TARGETS.get(code.code, "python")))
    assert shown(report) == []


@pytest.mark.parametrize("code", EVERY)
def test_docstrings_have_all_parts(code: Code) -> None:
    parts = explanation(code)
    assert parts.summary.endswith(".")
    assert parts.reason
    assert parts.wrong
    assert parts.right
    assert parts.wrong != parts.right
