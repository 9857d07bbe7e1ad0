"""Output keys of built-in state types: which ones their code sets, and on which outcomes."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.diagnostics.diagnostic import Severity
from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.files import disk_library
from smachac.frontend.loader import memory_library

SCRIPT = """
name: sm
template: {base}
outcomes: [done]
userdata: {{topic: /pose, level: 3}}
states:
  - FIRST:
      {fields}
  - SHOW:
      template: PrintUserdataState
      input_keys: [{key}]
      transitions: {{succeeded: done}}
"""
ENDS = "transitions: {succeeded: SHOW, aborted: AB, preempted: done}"
BUILT_IN = disk_library(Path("main.yml"), [])


@pytest.mark.parametrize(
    ("fields", "key", "unset"),
    [
        ("template: ConditionalOutcomeState\n      output_keys: [KEY]", "outcome", ""),
        ("template: ConditionalOutcomeState\n      output_keys: [KEY]", "level_seen", "every"),
        ("template: RandomOutcomeState\n      output_keys: [KEY]", "outcome", ""),
        ("template: RandomOutcomeState\n      output_keys: [KEY]", "drawn", "every"),
        ("template: RandomOutcomeState\n      output_keys: [KEY]\n"
         "      callbacks: {drawn: 'lambda ud: 1'}", "drawn", ""),
        ("template: WaitForMsgState\n      output_keys: [KEY]", "message", "every"),
        ("template: WaitForMsgState\n      output_keys: [KEY]\n"
         "      msg_cb: 'lambda message, ud: 1'",
         "message", ""),
        ("template: WaitForMsgState\n      output_keys: [KEY]\n"
         "      msg_cb: 'lambda message, ud: 1'",
         "AB", "some"),
        ("template: ReadTopicState\n      output_keys: [KEY]", "output", ""),
        ("template: ReadTopicState\n      output_keys: [KEY]", "output_msg", ""),
        ("template: ReadTopicState\n      output_keys: [KEY]", "AB", "every"),
        ("template: ReadTopicState\n      output_keys: [KEY]", "seen", "every"),
        ("template: TransformMsgState\n      output_keys: [KEY]", "transform", ""),
        ("template: TransformMsgState\n      output_keys: [KEY]", "AB", "every"),
    ],
)  # fmt: skip
def test_what_is_set_after_a_built_in_state(fields: str, key: str, unset: str) -> None:
    """`AB`: the key `output` is read after the outcome `aborted`."""
    waits = "Topic" in fields or "Msg" in fields
    if "Conditional" in fields:
        fields += "\n      input_keys: [level]\n      outcomes: [low]\n      default_outcome: high"
        fields += "\n      callbacks: {low: 'lambda ud: ud.level < 9'}"
    fields += "\n      outcomes: [a, b]" if "Random" in fields else ""
    fields += "\n      timeout: 2.0" if waits else ""
    fields += "\n      input_keys: [topic]" if "Topic" in fields else ""
    fields += "\n      remapping: {msg: level, frame_id: topic}" if "Transform" in fields else ""
    fields += "\n      topic: /a\n      msg_type: std_msgs/String" if "WaitForMsg" in fields else ""
    ends = ENDS.replace("AB", "SHOW" if key == "AB" else "done")
    ends = ends.replace("succeeded: SHOW", "succeeded: done") if key == "AB" else ends
    if not waits:
        ends = "transitions: {low: SHOW, high: SHOW, a: SHOW, b: SHOW}"
        gone = ("a: SHOW, b: SHOW", "low: SHOW, high: SHOW, ")["Random" in fields]
        ends = ends.replace(gone, "").replace(", }", "}")
    name = ("output_msg" if "Transform" in fields else "output") if key == "AB" else key
    fields = f"{fields}\n      {ends}".replace("KEY", name)
    base = "ROSBase" if waits else "Base"
    text = SCRIPT.format(base=base, fields=fields, key=name)
    report = analyse(Source("main.yml", text), memory_library({}, BUILT_IN), []).report
    found = [item.message for item in report if item.code == "SM301"]
    assert [item.code for item in report if item.severity is Severity.ERROR] == (
        ["SM301"] if unset == "every" else []
    )
    path = f"on {unset} path{'s' if unset == 'some' else ''}"
    assert found == ([f"`SHOW` reads `{name}`, which is unset {path}"] if unset else [])
