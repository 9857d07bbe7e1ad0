"""A run of states with sugar: progress, traces, failures and turns have the paths of the script."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from smachac.commands.cli import main

SCRIPT = """\
name: sm
template: Base
outcomes: [done, failed, stopped]
states:
  - DRIVE:
      template: ScriptedState
      outcomes: [succeeded, aborted, preempted]
      steps: [{outcome: aborted}, {outcome: succeeded}]
      timeout: 5s
      retry: {on: [aborted], max: 3, delay: 10ms}
      for_each: {item: one, in: [1, 2]}
      transitions: {succeeded: REST, timeout: failed, exhausted: failed, preempted: stopped}
  - REST:
      template: SleepState
      time: 3.0
      timeout: 10ms
      transitions: {succeeded: failed, timeout: done, preempted: stopped}
"""

MOCK = """\
states:
  sm/DRIVE: [aborted, succeeded, aborted, aborted, succeeded]
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "main.yml").write_text(SCRIPT, "utf-8")
    (tmp_path / "mock.yml").write_text(MOCK, "utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_progress_shows_attempts_items_and_time_limits(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", "main.yml", "--mock", "mock.yml"]) == 0
    lines = [" ".join(line.split()) for line in capsys.readouterr().out.splitlines()]
    assert lines == [
        "sm",
        "DRIVE: item 1 of 2",
        "DRIVE aborted 0.00 s",
        "DRIVE: attempt 2 of 3",
        "DRIVE succeeded 0.00 s",
        "DRIVE: item 2 of 2",
        "DRIVE aborted 0.00 s",
        "DRIVE: attempt 2 of 3",
        "DRIVE aborted 0.00 s",
        "DRIVE: attempt 3 of 3",
        "DRIVE succeeded 0.00 s",
        "REST preempted 0.01 s",
        "REST timeout 0.01 s (time limit of 10 ms)",
        "sm done 0.04 s",
        "outcome: done",
    ]


def traced(*words: str) -> list[dict[str, str]]:
    """The events of a run, without times; those of one concurrence in order of their paths."""
    assert main(["run", "main.yml", "--quiet", "--trace", "trace.jsonl", *words]) == 0
    lines = Path("trace.jsonl").read_text("utf-8").splitlines()
    Path("trace.jsonl").unlink()
    events = [json.loads(line) for line in lines]
    kept = [{key: event[key] for key in event if key not in ("seq", "t")} for event in events]
    return [event for event in kept if "TIMER" not in event["path"]]


def test_the_traces_of_interpreter_and_program_are_the_same(folder: Path) -> None:
    script = SCRIPT.replace("[{outcome: aborted}, {outcome: succeeded}]", "[{outcome: succeeded}]")
    (folder / "main.yml").write_text(script, "utf-8")
    (folder / "mock.yml").write_text("states: {sm/DRIVE: succeeded}\n", "utf-8")
    events = traced()
    assert events == traced("--mock", "mock.yml")
    assert {event["path"] for event in events} == {
        *("sm", "sm/DRIVE (for_each)", "sm/DRIVE (retry)", "sm/DRIVE (try)"),
        *("sm/DRIVE (try)/PAUSE", "sm/DRIVE (timeout)", "sm/DRIVE", "sm/REST (timeout)", "sm/REST"),
    }
    assert {event["to"] for event in events if event["path"] == "sm/DRIVE (for_each)"
            and "to" in event} == {"sm/REST (timeout)"}  # fmt: skip


def test_a_failure_has_the_path_of_the_script(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("mock.yml").write_text("states: {DRIVE: [{error: stuck}]}\n", "utf-8")
    assert main(["run", "main.yml", "--mock", "mock.yml", "--quiet"]) == 1
    assert "the run failed in sm/DRIVE (main.yml:5)\nsm/DRIVE: stuck" in capsys.readouterr().err
    assert main(["run", "main.yml", "--mock", "mock.yml", "--orders", "3"]) in (0, 1)
    assert "error: sm/DRIVE: stuck" in capsys.readouterr().out
