"""States past which a transition leads, and keys of one slip: one finding with the text."""

from __future__ import annotations

import pytest

from tests.checks.test_first_scripts import reported
from tests.trust.judged_repairs import printed

Row = tuple[str, str, str | None]

PATH = """\
name: sm
outcomes: [held, lost]
PROPERTY
states:
  - OPEN: {template: ScriptedState, outcomes: [ok, failed], transitions: {ok: LIFT, failed: lost}}
  - LIFT: {template: ScriptedState, outcomes: [ok, failed], transitions: {ok: TARGET, failed: lost}}
  - CHECK: {template: ScriptedState, outcomes: [ok, failed], transitions: {ok: END, failed: lost}}
"""


@pytest.mark.parametrize(
    "form", ["never: {after: OPEN, until: CHECK, enter: MOVE}", "before: {MOVE: CHECK}"]
)
def test_a_transition_past_a_state_that_a_property_requires(form: str) -> None:
    text = PATH.replace("PROPERTY", f"properties: [{{{form}}}]").replace("TARGET", "MOVE")
    text = text.replace("END", "MOVE")
    text += "  - MOVE: {template: ScriptedState, outcomes: [ok], transitions: {ok: held}}\n"
    ((code, place, help),) = reported({"main.yml": text})
    assert (code, place) == ("SM701", "MOVE")
    assert help is not None
    assert help.startswith("write `ok: CHECK` in `LIFT`, or correct the property")


def test_a_target_that_lacks_a_word_of_a_state() -> None:
    text = """\
name: sm
outcomes: [done, lost]
states:
  - MOVE: {template: ScriptedState, outcomes: [ok, bad], transitions: {ok: PARK_ARM, bad: PARK}}
  - PARK_ARM: {template: ScriptedState, outcomes: [ok, bad], transitions: {ok: done, bad: lost}}
"""
    assert reported({"main.yml": text}) == [("SM101", "PARK", "did you mean `PARK_ARM`?")]


def test_the_state_after_a_stop_is_that_after_a_failure_without_a_transition() -> None:
    text = """\
name: sm
outcomes: [done, failed, preempted]
states:
  - WELD:
      template: ScriptedState
      outcomes: [welded, weld_failed, preempted]
      transitions: {welded: RELEASE, preempted: LET_GO}
  - RELEASE: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}
  - LET_GO: {template: ScriptedState, outcomes: [ok], transitions: {ok: preempted}}
"""
    found = [row for row in reported({"main.yml": text}) if row[0] == "SM104"]
    assert found == [("SM104", "WELD", "add `weld_failed: LET_GO` to the transitions of `WELD`")]


def test_the_bracket_of_a_look_up_is_closed_after_its_param() -> None:
    text = """\
name: sm
template: ROSBase
outcomes: [done, lost]
params: {camera: left}
states:
  - LOOK:
      template: WaitForMsgState
      topic: ['/', [params, camera, /image]
      msg_type: std_msgs/Empty
      transitions: {succeeded: done, aborted: lost, preempted: lost}
"""
    found = [row for row in reported({"main.yml": text}) if row[0] == "SM001"]
    assert found == [("SM001", "camera", "write `topic: ['/', [params, camera], /image]`")]


def test_an_initial_value_around_a_container_that_lacks_its_input() -> None:
    text = """\
name: sm
outcomes: [done]
userdata: {served: 0}
states:
  - SERVE:
      template: StateMachine
      outcomes: [done]
      output_keys: [served]
      transitions: {done: done}
      states:
        - COUNT:
            template: CallbacksState
            input_keys: [served]
            output_keys: [served]
            callbacks: {served: "lambda ud: ud.served + 1"}
            transitions: {succeeded: done}
"""
    ((code, place, help),) = printed({"main.yml": text})
    assert (code, place) == ("SM301", "served")
    assert help.startswith("write `input_keys: [served]` in `SERVE`, or give")


@pytest.mark.parametrize("timeout", ["", "timeout: 5s, "])
def test_the_only_unread_value_of_the_type(timeout: str) -> None:
    text = f"""\
name: sm
outcomes: [done, lost]
userdata: {{cruise: {{type: float<m/s>, value: 0.8}}, count: 0}}
states:
  - A:
      template: Drive
      {timeout and "timeout: 5s"}
      transitions: {{done: B{", timeout: lost, preempted: lost" if timeout else ""}}}
  - B:
      template: CallbacksState
      input_keys: [count]
      output_keys: [count]
      callbacks: {{count: "lambda ud: ud.count + 1"}}
      transitions: {{succeeded: C}}
  - C: {{template: PrintUserdataState, input_keys: [count], transitions: {{succeeded: done}}}}
"""
    interface = "input_keys: {{speed: float<m/s>}}\noutcomes: {{done: {{}}}}\n".replace("{{", "{")
    files = {"main.yml": text, "templates/Drive.yml": interface.replace("}}", "}")}
    found = [row for row in printed(files) if row[0] in ("SM301", "SM305")]
    ((code, place, help),) = found
    assert (code, place) == ("SM301", "A")
    assert help is not None
    assert "write `remapping: {speed: cruise}` in `A`" in help
