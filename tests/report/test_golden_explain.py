"""What `explain` says, as tests/explained has it. `make golden` rewrites it."""

from __future__ import annotations

import shlex
from pathlib import Path

import pytest

from smachac.commands.cli import main
from tests.support.golden import compare_file

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "explained"
EXAMPLES = ROOT.parent / "examples"

PICK = EXAMPLES / "08_pick_and_place"
ASKED = {
    "key.txt": (PICK, "block_pose"),
    "key.json": (PICK, "hover_joints --format json"),
    "key_counted.txt": (EXAMPLES / "06_callbacks", "tries"),
    "key_items.txt": (EXAMPLES / "07_iterator", "waypoint"),
    "key_unset.txt": (FOLDER, "grasp"),
    "keys_of_one_name.txt": (PICK, "hover_offset"),
    "key_in_a_container.txt": (PICK, "PLACE_BLOCK/hover_joints"),
    "state.txt": (PICK, "PICK_BLOCK/MOVE_DOWN"),
    "state.json": (PICK, "LET_GO --format json"),
    "state_container.txt": (PICK, "PLACE_BLOCK"),
    "state_machine.txt": (PICK, "pick_and_place"),
    "state_in_a_concurrence.txt": (EXAMPLES / "03_concurrence", "FIND_PART"),
    "state_with_findings.txt": (FOLDER, "GRASP"),
    "state_never_entered.txt": (FOLDER, "LOST"),
    "state_and_key.txt": (FOLDER, "same"),
    "failures.txt": (PICK, "--failures"),
    "failures.md": (PICK, "--failures --format md"),
    "failures.csv": (PICK, "--failures --format csv"),
    "failures.json": (EXAMPLES / "03_concurrence", "--failures --format json"),
    "failures_of_sugar.txt": (ROOT / "cases" / "sugar", "--failures"),
    "failures_broken.txt": (FOLDER, "--failures"),
}


@pytest.mark.parametrize("name", ASKED)
def test_golden_explanation(
    name: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    folder, words = ASKED[name]
    monkeypatch.chdir(folder)
    assert main(["explain", "main.yml", *shlex.split(words)]) == 0
    found = capsys.readouterr().out
    compare_file(found, FOLDER / name)
