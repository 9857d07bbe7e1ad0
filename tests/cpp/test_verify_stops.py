"""`smachac verify` of a mission with concurrences, a loop, retries and time limits: the generated
programs agree, and a request to stop comes at every position."""

from __future__ import annotations

from pathlib import Path

import pytest

import smachac
from smachac.commands.cli import main
from smachac.verify.generate import PathGenerator
from smachac.verify.players.cpp import compilers

MISSION = """\
name: mission
outcomes: [done, failed, stopped]
states:
  - SURVEY:
      template: Concurrence
      join: any
      outcomes: [found, none, stopped]
      default_outcome: none
      outcome_map: {found: {LOOK: found}, stopped: {LOOK: preempted, WATCH: preempted}}
      transitions: {found: VISIT, none: failed, stopped: TIDY}
      states:
        - LOOK:
            template: StateMachine
            outcomes: [found, lost, preempted]
            states:
              - TURN:
                  template: ScriptedState
                  outcomes: [succeeded, preempted]
                  transitions: {succeeded: SEE}
              - SEE: {template: ScriptedState, outcomes: [found, lost, preempted]}
        - WATCH: {template: ScriptedState, outcomes: [alarm, preempted]}
  - VISIT:
      template: StateMachine
      outcomes: [succeeded, aborted, preempted]
      for_each: {item: place, in: [1, 2, 3]}
      timeout: 60s
      transitions: {succeeded: CARRY, aborted: failed, timeout: failed, preempted: TIDY}
      states:
        - GO:
            template: ScriptedState
            outcomes: [succeeded, aborted, preempted]
            retry: {on: [aborted], max: 2}
            timeout: 5s
            transitions: {succeeded: REPORT, exhausted: aborted, timeout: aborted, preempted: PARK}
        - PARK:
            template: ScriptedState
            outcomes: [parked, preempted]
            transitions: {parked: preempted}
        - REPORT: {template: ScriptedState, outcomes: [succeeded]}
  - CARRY:
      template: Concurrence
      outcomes: [done, failed, stopped]
      default_outcome: failed
      outcome_map: {done: {LEFT: done, RIGHT: done}, stopped: {LEFT: preempted}}
      transitions: {done: done, failed: failed, stopped: TIDY}
      states:
        - LEFT: {template: ScriptedState, outcomes: [done, preempted]}
        - RIGHT: {template: ScriptedState, outcomes: [done, slipped, preempted]}
  - TIDY:
      template: ScriptedState
      outcomes: [succeeded, preempted]
      transitions: {succeeded: stopped, preempted: stopped}
"""


@pytest.fixture(name="mission")
def _mission(tmp_path: Path) -> Path:
    script = tmp_path / "main.yml"
    script.write_text(MISSION, "utf-8")
    return script


@pytest.mark.skipif(not compilers(), reason="no C++ compiler")
@pytest.mark.slow
def test_a_mission_with_stops_agrees(mission: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", str(mission), "--targets", "python,cpp"]) == 0
    assert "python: agrees\ncpp: agrees" in capsys.readouterr().out


def test_requests_come_at_every_position(mission: Path) -> None:
    """Before the start, in each leaf, twice on a path, and inside both concurrences."""
    paths = list(PathGenerator(smachac.load(mission)).paths())
    stops = [
        [
            place.rpartition("/")[2]
            for place, row in path.scenario.steps.items()
            for step in row
            if step.stop
        ]
        for path in paths
    ]
    everywhere = {"TURN", "SEE", "GO", "PARK", "REPORT", "LEFT", "TIDY"}
    assert everywhere <= {place for places in stops for place in places}
    assert any(path.stopped for path in paths)
    assert any(len(places) > 1 for places in stops)
