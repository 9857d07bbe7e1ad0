"""A built-in state type in place of the one whose variables and outcomes a state has."""

from __future__ import annotations

import pytest

from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.loader import memory_library
from tests.support.typed_machines import BUILT_IN

SCRIPT = """\
name: sm
template: ROSBase
outcomes: [done, failed]
states:
  - WATCH:
      template: {template}
      topic: /battery
      msg_type: std_msgs/Float32
      {code}: 'lambda {arguments}: message.data > 0.25'
      {more}
      transitions: {{{transitions}}}
"""
MONITOR = "valid: failed, invalid: done, preempted: failed"
WAIT = "succeeded: done, aborted: failed, preempted: failed"


def findings(
    template: str, code: str, transitions: str, more: str = "qos: 5"
) -> list[tuple[str, str, str]]:
    """Code, marked text and help of each finding above an info."""
    arguments = "ud, message" if code.startswith("cond") else "message, ud"
    script = SCRIPT.format(
        template=template, code=code, arguments=arguments, transitions=transitions, more=more
    )
    report = analyse(Source("main.yml", script), memory_library({}, BUILT_IN), []).report
    return [
        (each.code, each.span.text, each.finding.help or "")
        for each in report
        if each.severity.value != "info"
    ]


def test_the_variables_and_outcomes_of_another_type() -> None:
    help = "`cond_cb` is a variable of `MonitorState`: write `template: MonitorState`"
    assert findings("WaitForMsgState", "cond_cb", MONITOR) == [("SM003", "cond_cb", help)]
    help = "`msg_cb` is a variable of `WaitForMsgState`: write `template: WaitForMsgState`"
    assert findings("MonitorState", "msg_cb", WAIT) == [("SM003", "msg_cb", help)]


@pytest.mark.parametrize(
    ("template", "code", "transitions", "more"),
    [
        ("WaitForMsgState", "cond_cb", WAIT, "qos: 5"),
        ("WaitForMsgState", "cond_cb", MONITOR, "latch: true"),
        ("MonitorState", "conds_cb", MONITOR, "qos: 5"),
        ("WaitForMsgState", "msg_cbs", WAIT, "qos: 5"),
    ],
)
def test_a_type_that_cannot_be_another_one(
    template: str, code: str, transitions: str, more: str
) -> None:
    found = findings(template, code, transitions, more)
    assert found
    assert not any("template:" in help for _, _, help in found)


def test_the_list_of_variables_has_those_that_are_also_fields_of_the_language() -> None:
    found = findings("WaitForMsgState", "cond_cb", WAIT)
    help = "its variables are `latch`, `msg_cb`, `msg_type`, `qos`, `timeout`, `topic`"
    assert found == [("SM003", "cond_cb", help)]
