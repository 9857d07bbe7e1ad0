"""The library in memory searches the same folders as the one on disk."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.diagnostics.source import Source
from smachac.driver import analyse, analyse_script
from smachac.frontend.files import LONG_TEXT, Disk
from smachac.frontend.loader import memory_library
from tests.support.typed_machines import BUILT_IN

MAIN = """\
name: sm
template: Base
outcomes: [done]
states:
  - PICK: {script: parts/pick, transitions: {ok: done}}
"""
PICK = """\
- PICK:
    template: StateMachine
    outcomes: [ok]
    states:
      - OPEN: {script: open_gripper, transitions: {ok: ok}}
"""
OPEN = "- OPEN: {template: ScriptedState, outcomes: [ok]}\n"
OTHER = "- OPEN: {template: ScriptedState, outcomes: [other]}\n"

BESIDE = {"main.yml": MAIN, "parts/pick.yml": PICK, "parts/open_gripper.yaml": OPEN}


@pytest.mark.parametrize(
    "files",
    [
        BESIDE,
        {**BESIDE, "open_gripper.yml": OTHER},
        {"main.yml": MAIN, "parts/pick.yml": PICK, "open_gripper.yml": OPEN},
        {"main.yml": MAIN, "parts/pick.yml": PICK, "parts/open_griper.yml": OPEN},
        {"main.yml": MAIN, "parts/pik.yml": PICK, "pick.yml": PICK},
    ],
)
def test_scripts_are_searched_in_the_folder_of_the_calling_file(
    files: dict[str, str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name, text in files.items():
        Path(name).parent.mkdir(exist_ok=True)
        Path(name).write_text(text, "utf-8")
    found = [
        [(item.code, item.message, item.span.source.name, item.span.line) for item in one.report]
        for one in (
            analyse(Source("main.yml", MAIN), memory_library(files, BUILT_IN), []),
            analyse_script("main.yml"),
        )
    ]
    assert found[0] == found[1]


@pytest.mark.parametrize(
    ("in_pieces", "size", "kept"),
    [(False, 0, True), (False, LONG_TEXT, False), (True, LONG_TEXT, True)],
)
def test_the_tree_of_a_long_script_is_released_unless_an_editor_needs_it(
    in_pieces: bool, size: int, kept: bool, tmp_path: Path
) -> None:
    path = tmp_path / "main.yml"
    path.write_text(OPEN + "#" * size, "utf-8")
    disk = Disk(in_pieces=in_pieces)
    source = disk.read(path, [])
    assert source is not None
    tree = disk.parse(source, [])
    assert disk.parse(source, []) is tree
    disk.release(source)
    assert (disk.parse(source, []) is tree) is kept
    assert disk.parse(source, []) == tree
