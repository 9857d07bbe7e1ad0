"""What generated programs use of `smachac.runtime.additions`: imported, or as their own text."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import smachac
from smachac.runtime import smach
from smachac.runtime.additions import SleepState, with_retries, with_timeout
from smachac.targets import OptionError
from tests.verify.test_verify import judged

TOUR = """\
name: tour
doc: Drive to a shelf, look at it and wait for a person.
template: ROSBase
outcomes: [succeeded, aborted, preempted]
params: {drive_server: drive}
userdata:
  shelf: 3
states:
  - BATTERY:
      template: WaitForMsgState
      topic: battery
      msg_type: sensor_msgs/msg/BatteryState
      qos: sensor_data
      msg_cb: 'lambda message, userdata: message.percentage > 0.3'
      timeout: 5.0
      transitions: {succeeded: UNDOCK, aborted: aborted, preempted: preempted}
  - UNDOCK:
      template: ServiceState
      service_namespace: undock
      service: std_srvs/srv/Trigger
      response_slots: [success]
      output_keys: [success]
      remapping: {success: undocked}
      retry: {on: [aborted], max: 3, delay: 1.0}
      transitions: {succeeded: DRIVE, exhausted: aborted, preempted: preempted}
  - DRIVE:
      template: SimpleActionState
      action_server_namespace: [params, drive_server]
      action: test_msgs/action/Fibonacci
      goal_slots: [order]
      input_keys: [order]
      remapping: {order: shelf}
      timeout: 300
      transitions: {succeeded: LOOK, aborted: aborted, preempted: preempted, timeout: aborted}
  - LOOK:
      template: Concurrence
      outcomes: [seen, missed, preempted]
      default_outcome: missed
      outcome_map: {seen: {SCAN: succeeded, LIGHT: succeeded}, preempted: {SCAN: preempted}}
      states:
        - SCAN:
            template: ServiceState
            service_namespace: scan
            service: std_srvs/srv/Trigger
        - LIGHT:
            template: SleepState
            time: 2.0
      transitions: {seen: STAY, missed: aborted, preempted: preempted}
  - STAY:
      template: SleepState
      time: 10.0
      transitions: {succeeded: succeeded, preempted: preempted}
"""

WAIT = """\
name: sm
outcomes: [good, bad, preempted]
states:
  - {0}:
      template: ScriptedState
      outcomes: [a, b]
      timeout: 5s
      retry: {{on: [b, timeout], max: 3, delay: 0.01}}
      transitions: {{a: NEXT, exhausted: bad, preempted: preempted}}
  - NEXT:
      template: SleepState
      time: 0.01
      transitions: {{succeeded: good, preempted: preempted}}
"""


def written(folder: Path, text: str) -> Path:
    path = folder / "main.yml"
    path.write_text(text, "utf-8")
    return path


def test_a_node_has_at_most_twice_the_lines_of_its_script(tmp_path: Path) -> None:
    (text,) = smachac.compile(written(tmp_path, TOUR), "python").values()
    assert text.count("\n") <= 2 * TOUR.count("\n")
    assert "def " not in text.replace("def build(", "").replace("def main(", "")


@pytest.mark.parametrize("name", ["WAIT", "TIMER", "TRY", "PAUSE", "TIMED"])
def test_the_containers_of_calls_are_those_of_the_script(name: str, tmp_path: Path) -> None:
    path = written(tmp_path, WAIT.format(name))
    verdict = judged(path)
    assert verdict.disagreements == []
    assert verdict.taken == verdict.total


def test_the_functions_take_any_state() -> None:
    """By hand, without a label, and with keys of the names that the functions use."""
    steps = iter(["lost", "lost", "found"])

    @smach.cb_interface(
        input_keys=["attempt", "pause"], output_keys=["n"], outcomes=["lost", "found"]
    )
    def look(userdata: Any) -> str:
        userdata.n = userdata.attempt + userdata.pause
        return next(steps)

    machine = smach.StateMachine(outcomes=["found", "exhausted", "preempted", "timeout"])
    machine.userdata.attempt, machine.userdata.pause = 20, 3
    state = smach.CBState(look)
    with machine:
        smach.StateMachine.add("A", with_retries(with_timeout(state, 9.0), 3, ["lost"], 0.01))
    assert machine.execute() == "found"
    assert machine.userdata.n == 23
    late = with_timeout(SleepState(60.0), 0.01)
    assert late.execute() == "timeout"


def test_a_run_prints_no_debug_lines(tmp_path: Path) -> None:
    (text,) = smachac.compile(written(tmp_path, WAIT.format("WAIT")), "python").values()
    done = subprocess.run(
        [sys.executable, "-c", text], capture_output=True, encoding="utf-8", check=True
    )
    assert "DEBUG" not in done.stdout
    assert done.stdout.endswith("outcome: good\n")


def test_the_option_has_two_values(tmp_path: Path) -> None:
    with pytest.raises(OptionError, match="`standalone` must be `true` or `false`, not `yes`"):
        smachac.compile(
            written(tmp_path, WAIT.format("A")), "python", options={"standalone": "yes"}
        )
