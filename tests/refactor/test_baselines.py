"""Baselines after a refactoring: the recorded findings of a state that was renamed or moved stay
known, and no new finding becomes known."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from smachac.commands.cli import main

SCRIPT = """\
name: sm
outcomes: [done, lost]
states:
  - FIND: {template: ScriptedState, outcomes: [found, lost], transitions: {found: BOX}}
  - BOX:
      template: StateMachine
      outcomes: [done, late]
      transitions: {done: done, late: FIND}
      states:
        - WAIT: {template: SleepState, time: 0, transitions: {succeeded: LIFT, preempted: late}}
        - LIFT: {template: ScriptedState, outcomes: [done], transitions: {done: done}}
        - HIDDEN: {template: ScriptedState, outcomes: [done], transitions: {done: done}}
  - ALONE: {template: ScriptedState, outcomes: [done], transitions: {done: done}}
  - TOO: {template: ScriptedState, outcomes: [done], transitions: {done: done}}
"""


@pytest.fixture(name="project")
def _project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("smachac.toml").write_text("[severity]\nSM201 = 'warning'\n")
    Path("robot").mkdir()
    Path("robot/main.yml").write_text(SCRIPT, "utf-8")
    assert main(["check", "robot", "--baseline", "known.json", "--write-baseline", "-q"]) == 0
    assert json.loads(Path("known.json").read_text())["findings"]
    return tmp_path


def news(capsys: pytest.CaptureFixture[str]) -> str:
    """What `check` prints with the baseline, with all notes."""
    capsys.readouterr()
    main(["check", "robot", "--baseline", "known.json", "--notes", "--strict"])
    shown = capsys.readouterr()
    return shown.out + shown.err


@pytest.mark.parametrize(
    "command",
    [
        ["rename", "robot/main.yml", "ALONE", "ALSO"],
        ["rename", "robot/main.yml", "FIND", "SEEK"],
        ["rename", "robot/main.yml", "BOX", "WORK"],
        ["rename", "robot/main.yml", "sm/BOX/WAIT", "PAUSE"],
        ["rename", "robot/main.yml", "BOX/late", "slow"],
        ["contain", "robot/main.yml", "WORK", "StateMachine", "FIND", "BOX"],
        ["extract", "robot/main.yml", "BOX"],
    ],
    ids=lambda command: "-".join([command[0], *command[2:]]),
)
def test_known_findings_stay_known(
    command: list[str], project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before = news(capsys)
    assert "in the baseline" in before
    assert main(command) == 0, capsys.readouterr().err
    after = news(capsys)
    assert "no longer found" not in after
    assert [line for line in after.splitlines() if line.startswith(("error", "warning"))] == []


def test_extract_and_inline_lead_back(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    known = Path("known.json").read_text("utf-8")
    assert main(["extract", "robot/main.yml", "BOX"]) == 0
    assert Path("known.json").read_text("utf-8") != known
    assert main(["inline", "robot/main.yml", "BOX"]) == 0
    assert json.loads(Path("known.json").read_text("utf-8")) == json.loads(known)


def test_only_the_findings_in_a_baseline_follow(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = json.loads(Path("known.json").read_text("utf-8"))
    rows["findings"] = [row for row in rows["findings"] if "TOO" not in row["message"]]
    Path("known.json").write_text(json.dumps(rows), "utf-8")
    assert "`TOO`" in news(capsys)
    assert main(["rename", "robot/main.yml", "TOO", "TWO"]) == 0
    assert "`TWO`" in news(capsys)
    other = {"version": 3, "findings": [], "notes": "not touched"}
    Path("other.json").write_text(json.dumps(other), "utf-8")
    bad = ['{"version": 3, "findings": [{"fingerprint": 1}]}', '{"version": 3, "findings": 7}',
           '["fingerprint"]', '"fingerprint']  # fmt: skip
    for number, text in enumerate(bad):
        Path(f"bad_{number}.json").write_text(text, "utf-8")
    assert main(["rename", "robot/main.yml", "TWO", "TOO"]) == 0
    assert [Path(f"bad_{number}.json").read_text("utf-8") for number in range(4)] == bad
    assert json.loads(Path("other.json").read_text("utf-8")) == other


def test_a_new_finding_of_an_edit_is_not_known(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """LIFT becomes unreachable, and HIDDEN reachable: two findings of one code."""
    assert main(["edit", "robot/main.yml", "transition", "sm/BOX/WAIT", "succeeded", "HIDDEN"]) == 0
    assert "`LIFT`" in news(capsys)


def test_a_name_elsewhere_is_proposed_with_its_path(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["rename", "robot/main.yml", "late", "slow"]) == 2
    assert "did you mean `sm/BOX/late`?" in capsys.readouterr().err
