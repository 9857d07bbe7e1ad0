"""Command lines with the script and another file in each other's place, and misspelt words."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.commands.cli import main

SCRIPT = """\
name: sm
template: Base
outcomes: [done]
states:
  - WORK: {template: ScriptedState, outcomes: [done], transitions: {done: done}}
"""


@pytest.fixture(autouse=True)
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("main.yml").write_text(SCRIPT)
    Path("s.yml").write_text("states: {WORK: [done]}\n")
    Path("empty.yml").write_text("")
    Path("run.jsonl").write_text('{"seq": 1, "event": "start", "path": "sm", "t": 0}\n')


@pytest.mark.parametrize(
    ("written", "right"),
    [
        ("run s.yml --mock main.yml", "run main.yml --mock s.yml"),
        ("run empty.yml --mock main.yml", "run main.yml --mock empty.yml"),
        ("run s.yml --faults main.yml", "run main.yml --faults s.yml"),
        ("sweep s.yml --mock main.yml --runs 2", "sweep main.yml --mock s.yml"),
        ("rename WORK DO main.yml", "rename main.yml WORK DO"),
        ("rename WORK main.yml DO", "rename main.yml WORK DO"),
        ("contain LOOP main.yml StateMachine WORK", "contain main.yml LOOP StateMachine WORK"),
        ("extract WORK main.yml", "extract main.yml WORK"),
        ("inline WORK main.yml", "inline main.yml WORK"),
        ("trace check run.jsonl main.yml", "trace check main.yml run.jsonl"),
        ("stats run.jsonl main.yml", "stats main.yml run.jsonl"),
        ("rename WORK DO ./main.yml", "rename ./main.yml WORK DO"),
        ("edit WORK transition main.yml done", "edit main.yml transition WORK done"),
        ("edit WORK remove main.yml", "edit main.yml remove WORK"),
        ("edit sm add NEW main.yml SleepState", "edit main.yml add sm NEW SleepState"),
    ],
)
def test_the_right_call_is_named(
    written: str, right: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(written.split()) == 2
    printed = capsys.readouterr()
    assert printed.err.endswith(f"is none: write `smachac {right}`\n")
    assert not printed.out
    assert Path("main.yml").read_text() == SCRIPT


@pytest.mark.parametrize(
    ("written", "right"),
    [
        ("edit transition main.yml WORK done", "edit main.yml transition WORK done"),
        ("edit main.yml WORK remove", "edit main.yml remove WORK"),
        ("edit remove WORK main.yml", "edit main.yml remove WORK"),
        ("trace main.yml check run.jsonl", "trace check main.yml run.jsonl"),
        ("trace run.jsonl main.yml stats", "trace stats main.yml run.jsonl"),
        ("contain main.yml LOOP WORK StateMachine", "contain main.yml LOOP StateMachine WORK"),
        ("main.yml check", "check main.yml"),
    ],
)
def test_a_word_in_place_of_a_choice(
    written: str, right: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(written.split())
    assert ended.value.code == 2
    assert capsys.readouterr().err.endswith(f"; write `smachac {right}`\n")
    assert Path("main.yml").read_text() == SCRIPT


@pytest.mark.parametrize(
    "written",
    ["edit transition WORK done", "edit s.yml WORK remove", "trace run.jsonl check --format json"],
)
def test_words_in_an_order_that_is_not_known(
    written: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        main(written.split())
    assert "; write" not in capsys.readouterr().err


@pytest.mark.parametrize("written", ["run main.yml --mock s.yml", "rename main.yml WORK DO"])
def test_the_right_call_is_not_swapped(written: str) -> None:
    assert main(written.split()) == 0


def test_two_scripts_are_not_swapped(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "main.yml", "--mock", "main.yml"]) == 1
    assert "a scenario is a mapping" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("written", "near"),
    [
        ("chekc main.yml", "check"),
        ("--vesion", "--version"),
        ("run main.yml --tarce t.jsonl", "--trace"),
        ("run --tarce t.jsonl main.yml", "--trace"),
        ("build main.yml --taget python", "--target"),
        ("build main.yml -t python --optoin=ros=2", "--option"),
        ("check --format jsno main.yml", "json"),
        ("trace chek main.yml run.jsonl", "check"),
    ],
)
def test_a_misspelt_word(written: str, near: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(written.split())
    assert ended.value.code == 2
    assert capsys.readouterr().err.endswith(f"; did you mean `{near}`?\n")


@pytest.mark.parametrize("written", ["zzzz", "run main.yml --zzzz"])
def test_a_word_that_is_like_no_other(written: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(written.split())
    assert "did you mean" not in capsys.readouterr().err


def test_what_follows_two_hyphens_or_ros_args_is_no_option(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["check", "--", "--tarce"]) == 1
    assert main(["run", "main.yml", "--ros", "--ros-args", "--tarce"]) == 2
    assert "unrecognized" not in capsys.readouterr().err


@pytest.mark.parametrize(
    "scenario",
    ["states: {WRK: [done]}", "states: {WORK: [don]}", "sates: {}", "", "states: {WORK: [", "[1]"],
)
def test_a_finding_in_a_scenario_is_about_the_scenario(
    scenario: str, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("s.yml").write_text(scenario)
    assert main(["run", "main.yml", "--mock", "s.yml"]) == 1
    printed = capsys.readouterr().err
    assert "note: the scenario cannot be played, so nothing is run" in printed
    assert "program is generated" not in printed
