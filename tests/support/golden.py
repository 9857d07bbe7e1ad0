"""Expected output in files: compared with what was found, or rewritten by `make golden`."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable, Mapping
from pathlib import Path

from smachac.diagnostics.diagnostic import Report
from smachac.driver import analyse, build
from smachac.frontend.files import disk_library, read_source
from smachac.report.text import render_text
from smachac.targets import load_target

REWRITE = os.environ.get("SMACHAC_GOLDEN") == "rewrite"


def compare_file(found: str, path: Path) -> None:
    """Compare a text with a file, or write it there."""
    if REWRITE:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(found.encode())
    assert found == path.read_bytes().decode(), f"{path} differs"


def compare_folder(found: Mapping[str, str], folder: Path) -> None:
    """Compare texts by file name with all files below a folder, or write them there."""
    if REWRITE:
        shutil.rmtree(folder, ignore_errors=True)
    for name, text in found.items():
        compare_file(text, folder / name)
    files = (path for path in folder.rglob("*") if path.is_file())
    assert sorted(found) == sorted(path.relative_to(folder).as_posix() for path in files)


def outputs(targets: Iterable[str]) -> dict[str, str]:
    """The report for `main.yml` in the current folder and the files of each target, by name."""
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
