"""Scripts with what is expected of them: report, IR, every target. `make golden` rewrites it."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable
from pathlib import Path

import pytest

from smachac.diagnostics.diagnostic import Report
from smachac.driver import analyse, build
from smachac.frontend.files import disk_library, read_source
from smachac.report.text import render_text
from smachac.targets import load_target, target_names

ROOT = Path(__file__).parent
CASES = sorted(path.parent for path in (ROOT / "cases").glob("*/main.yml"))
EXAMPLES = sorted(path.parent for path in (ROOT.parent / "examples").glob("*/main.yml"))
REWRITE = os.environ.get("SMACHAC_GOLDEN") == "rewrite"


def expected_folder(case: Path) -> Path:
    """Beside the script; for examples, which users read, among the cases."""
    if case in EXAMPLES:
        return ROOT / "cases" / "examples" / case.name / "expected"
    return case / "expected"


def outputs(targets: Iterable[str]) -> dict[str, str]:
    """What smachac says of `main.yml` in the current folder, and prints of it, by file name."""
    report: Report = []
    source = read_source(Path("main.yml"), report)
    assert source is not None
    library = disk_library(Path("main.yml"), report)
    analysis = analyse(source, library, report)
    files = {"report.txt": render_text(analysis.report)}
    for name in targets if analysis.checked is not None else []:
        target = load_target(name)
        assert target is not None
        problems: Report = []
        assert analysis.checked is not None
        made = build(analysis.checked, target, library, problems)
        files.update({f"{name}/{file}": text for file, text in made.items()})
        if problems:
            files[f"{name}/report.txt"] = render_text(problems)
    return files


def compare(found: dict[str, str], folder: Path) -> None:
    """Hold what was found against a folder, or rewrite that."""
    if REWRITE:
        shutil.rmtree(folder, ignore_errors=True)
        for name, text in found.items():
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(text.encode())
    expected = {
        path.relative_to(folder).as_posix(): path.read_bytes().decode()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }
    assert sorted(found) == sorted(expected)
    for name, text in found.items():
        assert text == expected[name], f"{folder / name} differs"


@pytest.mark.parametrize("case", [*CASES, *EXAMPLES], ids=lambda case: case.name)
def test_golden(case: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(case)
    compare(outputs(target_names()), expected_folder(case))
