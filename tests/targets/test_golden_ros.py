"""Programs for both versions of ROS from one script, and what either version lacks.

Each case has its report and its Python; `make golden` rewrites them.
"""

from __future__ import annotations

from pathlib import Path

import pytest

import smachac
from smachac.commands.cli import main
from smachac.diagnostics.diagnostic import Diagnostic, Severity
from tests.support.golden import compare_folder, outputs

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "tests" / "cases" / "ros"
CASES = sorted(path.parent for path in FOLDER.glob("*/main.yml"))


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_golden(case: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(case)
    found = outputs(("python",))
    compare_folder(found, case / "expected")
    assert ("python/report.txt" in found) == case.name.startswith("bad_")


def test_both_versions_are_made_from_one_script() -> None:
    texts = {(FOLDER / name / "main.yml").read_text("utf-8") for name in ("ros_1", "ros_2")}
    assert len(texts) == 1


@pytest.mark.parametrize("ros", [1, 2])
def test_the_option_outweighs_the_project_file(ros: int) -> None:
    found = smachac.compile(
        FOLDER / f"ros_{3 - ros}" / "main.yml", "python", options={"ros": str(ros)}
    )
    expected = (FOLDER / f"ros_{ros}" / "expected" / "python" / "patrol.py").read_text("utf-8")
    assert found == {"patrol.py": expected}


def test_ros_2_is_the_default(tmp_path: Path) -> None:
    text = (FOLDER / "ros_1" / "main.yml").read_text("utf-8")
    (tmp_path / "main.yml").write_text(text, encoding="utf-8")
    expected = (FOLDER / "ros_2" / "expected" / "python" / "patrol.py").read_text("utf-8")
    assert smachac.compile(tmp_path / "main.yml", "python") == {"patrol.py": expected}


@pytest.mark.parametrize("value", ["3", "true", '"2"', "[2]"])
def test_a_project_file_names_version_1_or_2(value: str, tmp_path: Path) -> None:
    (tmp_path / "main.yml").write_text("name: sm\noutcomes: [a]\nstates: []\n", encoding="utf-8")
    (tmp_path / "smachac.toml").write_text(f"ros = {value}\n", encoding="utf-8")
    found = [item.finding for item in smachac.check(tmp_path / "main.yml")]
    assert any(finding.message.startswith("`ros` must be 1 or 2") for finding in found)


def place(item: Diagnostic) -> tuple[object, ...]:
    span = item.span
    return span.source.name, span.start, span.end, item.finding.message, item.finding.help


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_check_warns_of_what_a_build_refuses(case: Path) -> None:
    found = [item for item in smachac.check(case / "main.yml") if item.code == "SM601"]
    assert all(item.severity is Severity.WARNING and item.finding.help for item in found)
    try:
        smachac.compile(case / "main.yml", "python")
        refused = []
    except smachac.ScriptError as error:
        refused = [item for item in error.report if item.code == "SM601"]
    assert [*map(place, found)] == [*map(place, refused)]
    assert bool(refused) == case.name.startswith("bad_")


def test_check_uses_the_version_of_the_project(tmp_path: Path) -> None:
    text = (FOLDER / "bad_ros_2" / "main.yml").read_text("utf-8")
    (tmp_path / "main.yml").write_text(text, encoding="utf-8")
    assert "SM601" in [item.code for item in smachac.check(tmp_path / "main.yml")]
    (tmp_path / "smachac.toml").write_text("ros = 1\n", encoding="utf-8")
    assert "SM601" not in [item.code for item in smachac.check(tmp_path / "main.yml")]


def test_check_reports_the_other_version_beside_errors(tmp_path: Path) -> None:
    text = (FOLDER / "bad_ros_2" / "main.yml").read_text("utf-8")
    (tmp_path / "main.yml").write_text(f"{text}  - SHOW: {{}}\n", encoding="utf-8")
    found = smachac.check(tmp_path / "main.yml")
    assert [item.code for item in found].count("SM601") == 2
    assert any(item.severity is Severity.ERROR for item in found)


def test_a_build_for_the_other_version_has_no_warning(tmp_path: Path) -> None:
    text = (FOLDER / "bad_ros_2" / "main.yml").read_text("utf-8")
    (tmp_path / "main.yml").write_text(text, encoding="utf-8")
    arguments = ["build", str(tmp_path / "main.yml"), "-t", "python", "-o", str(tmp_path)]
    assert main([*arguments, "--option", "ros=1"]) == 0
    assert main(arguments) == 1
