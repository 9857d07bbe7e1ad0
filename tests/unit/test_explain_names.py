"""`smachac explain SCRIPT NAME`: which names mean something, and what else is said of them."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.cli import main

ROOT = Path(__file__).parents[2]
PICK = str(ROOT / "examples" / "08_pick_and_place" / "main.yml")
BROKEN = str(ROOT / "tests" / "explained" / "main.yml")


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ([PICK, "blok_pose"], "did you mean `block_pose`?"),
        ([PICK, "PICK_BLOCK/MOVE_DWN"], "did you mean `MOVE_DOWN`?"),
        ([PICK, "xyzzy"], "states: `CHECK_GRASP`, "),
        ([PICK, "CHECK_GRASP"], "  pick_and_place/PLACE_BLOCK/CHECK_GRASP ("),
        ([PICK, "pose"], "  pick_and_place/PICK_BLOCK/pick_pose"),
        ([PICK], "name a state or a key of"),
        ([PICK, "home", "more"], "name a code such as SM201"),
        ([PICK, "home", "--failures"], "name a code such as SM201"),
        ([PICK, "home", "--format", "md"], "--format md is for --failures"),
        ([], "name a code such as SM201"),
    ],
)
def test_what_is_asked_wrongly(
    words: list[str], says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["explain", *words]) == 2
    shown = capsys.readouterr()
    assert says in shown.err
    assert not shown.out


def test_a_part_of_a_name_is_not_the_name(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", PICK, "BLOCK/CHECK_GRASP"]) == 2
    assert "there is no state" in capsys.readouterr().err


def test_a_script_with_errors_is_explained(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", BROKEN, "LOOK"]) == 0
    shown = capsys.readouterr()
    assert "state sm/LOOK" in shown.out
    assert "the script has errors" in shown.err


@pytest.mark.parametrize("text", ["name: [", "- A: {}", None])
def test_an_unreadable_script_is_reported(
    text: str | None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "main.yml"
    if text is not None:
        path.write_text(text)
    assert main(["explain", str(path), "A"]) == 1
    assert "error[SM0" in capsys.readouterr().err


def test_nothing_of_a_script_steers_the_terminal(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    script = tmp_path / "main.yml"
    script.write_text(
        "name: sm\ntemplate: Base\noutcomes: [done]\nstates:\n"
        '  - "A\\e[31m":\n      template: ScriptedState\n      doc: "x\\ay"\n'
        '      outcomes: [done, "a|b\\e_failed"]\n      transitions: {"a|b\\e_failed": done}\n'
    )
    for words in (["A\x1b[31m"], ["--failures"], ["--failures", "--format", "md"]):
        assert main(["explain", str(script), *words]) == 0
        shown = capsys.readouterr().out
        assert "\x1b" not in shown
        assert "A\u241b" in shown
