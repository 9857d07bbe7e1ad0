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
        ("template: ConditionalOutcomeState\n      output_keys: [KEY]", "level_seen", "never"),
        ("template: RandomOutcomeState\n      output_keys: [KEY]", "outcome", ""),
        ("template: RandomOutcomeState\n      output_keys: [KEY]", "drawn", "never"),
        ("template: RandomOutcomeState\n      output_keys: [KEY]\n"
         "      callbacks: {drawn: 'lambda ud: 1'}", "drawn", ""),
        ("template: WaitForMsgState\n      output_keys: [KEY]", "message", "never"),
        ("template: WaitForMsgState\n      output_keys: [KEY]\n"
         "      msg_cb: 'lambda message, ud: 1'",
         "message", ""),
        ("template: WaitForMsgState\n      output_keys: [KEY]\n"
         "      msg_cb: 'lambda message, ud: 1'",
         "AB", "some"),
        ("template: ReadTopicState\n      output_keys: [KEY]", "output", ""),
        ("template: ReadTopicState\n      output_keys: [KEY]", "output_msg", ""),
        ("template: ReadTopicState\n      output_keys: [KEY]", "AB", "every"),
        ("template: ReadTopicState\n      output_keys: [KEY]", "seen", "never"),
        ("template: TransformMsgState\n      output_keys: [KEY]", "transform", ""),
        ("template: TransformMsgState\n      output_keys: [KEY]", "AB", "every"),
    ],
)  # fmt: skip
def test_what_is_set_after_a_built_in_state(fields: str, key: str, unset: str) -> None:
    """`never`: the state never writes the key. `AB`: `output` is read after `aborted`."""
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
    errors = [item.code for item in report if item.severity is Severity.ERROR]
    if unset == "never":
        assert errors == ["SM306"]
        assert not found
        return
    assert errors == (["SM301"] if unset == "every" else [])
    path = f"on {unset} path{'s' if unset == 'some' else ''}"
    assert found == ([f"`SHOW` reads `{name}`, which is unset {path}"] if unset else [])


NEVER = """
name: sm
template: ROSBase
outcomes: [done, failed]
OUT
userdata: {topic: /pose}
states:
  - SEE:
      template: ReadTopicState
      timeout: 2.0
      input_keys: [topic]
      output_keys: [KEYS]
      MORE
      transitions: {succeeded: done, aborted: failed, preempted: failed}
"""


def seen(keys: str, more: str = "doc: x", out: str = "") -> list[tuple[str, str, str | None]]:
    text = NEVER.replace("KEYS", keys).replace("MORE", more).replace("OUT", out)
    report = analyse(Source("main.yml", text), memory_library({}, BUILT_IN), []).report
    return [
        (item.code, item.span.text, item.help)
        for item in report
        if item.severity is not Severity.INFO and item.code.startswith("SM3")
    ]


def test_a_key_that_a_state_never_writes() -> None:
    help = "write `output_keys: [msg]` and `remapping: {msg: piece}`"
    remapped = "remapping: {message: piece}"
    assert seen("message", remapped, "output_keys: [piece]") == [("SM306", "message", help)]


def test_keys_that_a_state_writes() -> None:
    for key in ("msg", "output", "output_msg", "msg_output"):
        assert seen(key, out=f"output_keys: [{key}]") == []
    call = "callbacks: {message: 'lambda ud: ud.topic'}"
    assert seen("message", call, "output_keys: [message]") == []


PUBLISH = """
name: sm
template: ROSBase
outcomes: [done, failed]
userdata: {msg: hello, msg_type: std_msgs/String}
states:
  - SAY:
      template: PublishMsgState
      action: start
      topic: /alarm
      KEYS
      transitions: {succeeded: done, aborted: failed}
"""


@pytest.mark.parametrize(
    ("keys", "more"),
    [
        ("input_keys: [msg, msg_type]", " and add `topic` to its `input_keys`"),
        ("input_keys: [msg, msg_type, topic]", ""),
        ("doc: x", ""),
    ],
)
def test_an_input_key_that_is_written_as_a_variable(keys: str, more: str) -> None:
    text = PUBLISH.replace("KEYS", keys)
    report = analyse(Source("main.yml", text), memory_library({}, BUILT_IN), []).report
    (found,) = [item for item in report if item.code == "SM003"]
    help = f"`topic` is an input key: write `userdata: {{topic: /alarm}}`{more}"
    assert (found.span.text, found.help) == ("topic", help)
