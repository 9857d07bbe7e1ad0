"""What is known of Python files from the last run: the same report, and nothing after a change."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.commands.cli import main
from smachac.diagnostics.source import Source
from smachac.driver import batch, python_cache
from smachac.driver.python_cache import cache_folder, own_files
from smachac.driver.python_machines import PythonProject
from smachac.frontend.files import PACKAGE
from smachac.pysource.machines import evaluator

MACHINE = """\
import smach
from parts import Grip

sm = smach.StateMachine(outcomes=["done"])
with sm:
    smach.StateMachine.add("GRIP", Grip(), {"ok": "DONE"})
    smach.StateMachine.add("ASK", unknown(), {"yes": "done"})
"""
PARTS = """\
import smach

class Grip(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["ok"])

    def execute(self, userdata):
        return "ok"
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path / "cache"))
    place = tmp_path / "Roboter ü"
    place.mkdir()
    (place / "machine.py").write_text(MACHINE)
    (place / "parts.py").write_text(PARTS)
    monkeypatch.chdir(place)
    return place


def check(capsys: pytest.CaptureFixture[str], *options: str) -> str:
    main(["check", "machine.py", "--format", "json", *options])
    return capsys.readouterr().out


@pytest.fixture
def read(monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """The paths of the files that were evaluated."""
    found: list[Path] = []
    repository = PythonProject._repository

    def noted(self: PythonProject, path: Path, everything: bool) -> object:
        found.append(path)
        return repository(self, path, everything)

    monkeypatch.setattr(PythonProject, "_repository", noted)
    return found


def test_a_second_run_reads_nothing_and_reports_the_same(
    folder: Path, capsys: pytest.CaptureFixture[str], read: list[Path]
) -> None:
    first = check(capsys)
    assert read == [Path("machine.py")]
    assert "SM101" in first
    assert check(capsys) == first
    assert len(read) == 1
    assert check(capsys, "--no-cache") == first
    assert len(read) == 2


@pytest.mark.parametrize("name", ["machine.py", "parts.py", "other.py"])
def test_a_change_of_a_file_counts(
    name: str, folder: Path, capsys: pytest.CaptureFixture[str], read: list[Path]
) -> None:
    check(capsys)
    with (folder / name).open("a") as file:
        file.write("\n# changed\n")
    check(capsys)
    assert len(read) == 2


def test_severities_of_the_project_count(
    folder: Path, capsys: pytest.CaptureFixture[str], read: list[Path]
) -> None:
    check(capsys)
    (folder / "smachac.toml").write_text('[severity]\nSM201 = "warning"\n')
    check(capsys)
    assert len(read) == 2


@pytest.mark.parametrize("text", ["", "{", "[]", '{"digest": 1}', '{"digest": null, "files": 3}'])
def test_a_damaged_file_counts_as_empty(
    text: str, folder: Path, capsys: pytest.CaptureFixture[str], read: list[Path]
) -> None:
    first = check(capsys)
    place = cache_folder()
    assert place is not None
    (file,) = place.iterdir()
    file.write_text(text)
    assert check(capsys) == first
    assert len(read) == 2


def test_a_damaged_record_counts_as_none(
    folder: Path, capsys: pytest.CaptureFixture[str], read: list[Path]
) -> None:
    first = check(capsys)
    place = cache_folder()
    assert place is not None
    (file,) = place.iterdir()
    file.write_text(file.read_text().replace('"SM101"', '"SM999"'))
    assert check(capsys) == first
    assert len(read) == 2


def test_a_folder_that_cannot_be_written_is_no_fault(
    folder: Path, capsys: pytest.CaptureFixture[str], read: list[Path]
) -> None:
    (folder.parent / "cache").write_text("a file in place of the folder")
    first = check(capsys)
    assert check(capsys) == first
    assert len(read) == 2


def test_a_second_run_parses_no_file(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    before = check(capsys)
    parsed: list[str] = []

    def noted(self: PythonProject, source: Source, *, compiled: bool = True) -> None:
        parsed.append(source.name)

    monkeypatch.setattr(PythonProject, "_tree", noted)
    assert check(capsys) == before
    assert parsed == []


def test_a_python_file_is_never_read_as_a_script(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    scripts: list[Path] = []
    script = batch._Checker.script

    def noted(self: batch._Checker, path: Path) -> object:
        scripts.append(path)
        return script(self, path)

    monkeypatch.setattr(batch._Checker, "script", noted)
    assert '"SM101"' in check(capsys)
    assert scripts == []


def test_a_change_of_smachac_counts(
    folder: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    read: list[Path],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert evaluator.__file__ in own_files(PACKAGE)
    package = tmp_path / "smachac"
    (package / "pysource").mkdir(parents=True)
    (package / "pysource" / "evaluator.py").write_text("STEPS = 1\n")
    monkeypatch.setattr(python_cache, "PACKAGE", package)
    check(capsys)
    (package / "pysource" / "evaluator.py").write_text("STEPS = 100\n")
    check(capsys)
    assert len(read) == 2
