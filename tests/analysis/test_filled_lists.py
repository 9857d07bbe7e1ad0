"""Loops over a preset list: they run at least once unless a state can change the list."""

from __future__ import annotations

import pytest

from tests.trust.project_text import analysed

SCRIPT = """
name: sm
outcomes: [done]
userdata: {pads: PADS}
states:
  - BEFORE: {STATE, transitions: {succeeded: LOOP}}
  - LOOP:
      template: Dispense
      for_each: {item: pad, in: pads, on: [succeeded]}
      output_keys: [used]
      transitions: {succeeded: LOG}
  - LOG: {template: Log, remapping: {litres: used}, transitions: {succeeded: done}}
"""
PRINT = "template: PrintUserdataState, input_keys: [pads]"


def callback(code: str) -> str:
    called = f"callbacks: {{total: 'lambda ud: {code}'}}"
    return f"template: CallbacksState, input_keys: [pads], output_keys: [total], {called}"


def unset(state: str, pads: str = "[1, 2]", reader: str = "") -> list[str]:
    """The texts that SM301 marks."""
    files = {
        "main.yml": SCRIPT.replace("STATE", state).replace("PADS", pads),
        "templates/Dispense.yml": "{input_keys: [pad], output_keys: {used: float}, outcomes:"
        " {succeeded: {}}, code: {python: 'states:Dispense'}}",
        "templates/Log.yml": "{input_keys: {litres: float}, outcomes: {succeeded: {}}}",
        "templates/Own.yml": "{input_keys: [pads], outcomes: {succeeded: {}},"
        " code: {python: 'states:Own'}}",
        "states.py": STATES.replace("BODY", reader or "len(userdata.pads)"),
    }
    return [item.span.text for item in analysed(files).report if item.code == "SM301"]


STATES = """
import smach

class Dispense(smach.State):
    def __init__(self):
        super().__init__(outcomes=["succeeded"], input_keys=["pad"], output_keys=["used"])

    def execute(self, userdata):
        userdata.used = userdata.pad
        return "succeeded"

class Own(smach.State):
    def __init__(self):
        super().__init__(outcomes=["succeeded"], input_keys=["pads"])

    def execute(self, userdata):
        print(BODY)
        return "succeeded"
"""


@pytest.mark.parametrize(
    "state",
    [
        PRINT,
        callback("sum([p * 2 for p in ud.pads])"),
        callback("len(ud.pads) if ud.pads else 0"),
        callback('ud["pads"][0]'),
        "template: Own",
    ],
)
def test_the_loop_runs_at_least_once(state: str) -> None:
    assert unset(state) == []


@pytest.mark.parametrize(
    ("state", "pads"),
    [
        (PRINT, "[]"),
        (PRINT, "null"),
        (callback("ud.pads.pop()"), "[1]"),
        (callback("ud.pads"), "[1]"),
        (callback("other(ud.pads)"), "[1]"),
        (callback("[p for p in ud.pads]").replace("total", "pads"), "[1]"),
        ("template: ReadTopicState, output_keys: [pads], remapping: {output: pads}", "[1]"),
    ],
)
def test_the_list_can_be_empty(state: str, pads: str) -> None:
    assert unset(state, pads)[-1:] == ["litres"]


def test_a_class_can_empty_the_list() -> None:
    assert unset("template: Own", reader="userdata.pads.pop()") == ["litres"]
