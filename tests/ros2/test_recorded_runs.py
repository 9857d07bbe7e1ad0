"""Runs of generated nodes that are recorded in bags of rosbag2, and compared with their scripts."""

from __future__ import annotations

from pathlib import Path

import pytest

import smachac
from smachac.commands.cli import main
from tests.ros2.ros2_graph import Graph
from tests.support.bags import TEXT_TYPE, write_bag

pytestmark = pytest.mark.ros2

SCRIPT = """
name: patrol
template: ROSBase
outcomes: [done, lost, preempted]
states:
  - WAIT:
      template: WaitForMsgState
      topic: go
      qos: latched
      msg_type: std_msgs/String
      timeout: 100.0
      transitions: {succeeded: PREPARE, aborted: lost, preempted: preempted}
  - PREPARE:
      template: StateMachine
      outcomes: [ok]
      states:
        - FIRST: {template: CallbacksState, callbacks: {}, transitions: {succeeded: SECOND}}
        - SECOND: {template: CallbacksState, callbacks: {}, transitions: {succeeded: ok}}
      transitions: {ok: TRY}
  - TRY:
      template: ConditionalOutcomeState
      outcomes: [good, bad]
      callbacks: {bad: 'lambda ud: True'}
      default_outcome: good
      retry: {on: [bad], max: 2}
      transitions: {good: lost, exhausted: BOTH, preempted: preempted}
  - BOTH:
      template: Concurrence
      outcomes: [all, some]
      default_outcome: some
      outcome_map: {all: {LEFT: succeeded, RIGHT: succeeded}}
      states:
        - LEFT: {template: SleepState, time: 0.01}
        - RIGHT: {template: SleepState, time: 0.02}
      transitions: {all: done, some: lost}
"""
TOPIC = "/patrol/smach/container_status_json"
LAST = ("(['BOTH'], 'done')", "'RIGHT'], 'all')", "('TRY', 'exhausted')", "(['SECOND'], 'ok')")
"""In the last status of each container; those of different containers arrive in any order."""


def test_a_recorded_run_is_one_that_the_script_allows(
    graph2: Graph, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("rosbags")
    path = tmp_path / "patrol.yml"
    path.write_text(SCRIPT, encoding="utf-8")
    (text,) = smachac.compile(path, "python", options={"introspection": "yes"}).values()
    end = "            server.stop()\n"
    assert text.count(end) == 1
    recorder = graph2.node("recorder", TOPIC, *LAST)
    # The program ends when all statuses have arrived.
    program = graph2.start(text.replace(end, f"            input()\n{end}"))
    recorder.expect("all are there")
    program.say("")
    assert program.end() == 0, program.output
    lines = [line for line in recorder.output.splitlines() if line.startswith("message ")]
    messages = [bytes.fromhex(line.split()[1]) for line in lines]
    for storage in ("sqlite3", "mcap"):
        write_bag(tmp_path / storage, storage, {(TOPIC, TEXT_TYPE): messages})
        assert main(["trace", "check", str(path), str(tmp_path / storage)]) == 0
        shown = capsys.readouterr().out
        assert "ended with `done`\n1 trace, all allowed\n8 of " in shown
    other = tmp_path / "other.yml"
    changed = SCRIPT.replace("exhausted: BOTH", "exhausted: lost").replace(
        "good: lost", "good: BOTH"
    )
    other.write_text(changed, encoding="utf-8")
    assert main(["trace", "check", str(other), str(tmp_path / "mcap")]) == 1
    shown = capsys.readouterr().out
    assert "`exhausted` of the retry of `patrol/TRY` does not lead to `patrol/BOTH`" in shown
