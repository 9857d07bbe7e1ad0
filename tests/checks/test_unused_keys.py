"""Input keys that a goal or a request is sent without, and classes in place of their messages."""

from __future__ import annotations

import pytest

from smachac.diagnostics.diagnostic import Diagnostic
from tests.trust.project_text import analysed

GRASP = """
name: sm
template: ROSBase
outcomes: [done, failed]
userdata: {{order: 3, data: true, level: 1}}
states:
  - GRASP:
      template: {type}
      input_keys: {inputs}
      {fields}
      transitions: {{succeeded: done, aborted: failed, preempted: failed}}
"""
ACTION = "action_server_namespace: grasp\n      action: test_msgs/action/Fibonacci\n      "
SERVICE = "service_namespace: light\n      service: {}\n      "


def findings(code: str, type: str, fields: str, inputs: str = "[order]") -> list[Diagnostic]:
    text = GRASP.format(type=type, inputs=inputs, fields=fields)
    return [item for item in analysed({"main.yml": text}).report if item.code == code]


@pytest.mark.parametrize(
    ("fields", "keys"),
    [
        ("", ["order"]),
        ("goal: {order: 5}", ["order"]),
        ("result_cb: 'lambda ud, status, result: \"succeeded\"'", ["order"]),
        ("goal_cb: 'lambda ud, goal: None'", ["order"]),
        ("goal_slots: [order]", []),
        ("goal_cb: 'lambda ud, goal: setattr(goal, \"order\", ud.order)'", []),
        ("goal_cb: 'lambda ud, goal: fill(ud, goal)'", []),
        ("goal_cb: 'my_code.fill'", []),
        ("goal_slots: [ordre]", []),
        ("goal_cb: 'lambda u, goal: fill(ud.order)'", []),
    ],
)
def test_a_key_that_no_goal_has(fields: str, keys: list[str]) -> None:
    found = findings("SM306", "SimpleActionState", ACTION + fields)
    assert [item.finding.arguments[1] for item in found] == keys
    assert all("write `goal_slots: [order]`" in (item.help or "") for item in found)


def test_a_key_that_no_request_has() -> None:
    fields = SERVICE.format("std_srvs/SetBool")
    (found,) = findings("SM306", "ServiceState", fields, "[data]")
    assert "write `request_slots: [data]`" in (found.help or "")
    (found,) = findings("SM306", "ServiceState", fields + "request: {data: true}", "[level]")
    assert "the request has no field `level`" in (found.help or "")


@pytest.mark.parametrize(
    ("type", "code", "new"),
    [
        ("std_srvs/SetBool", "SetBool(data=True)", "SetBoolRequest(data=True)"),
        ("std_srvs/srv/SetBool", "SetBool(data=True)", "SetBool.Request(data=True)"),
        ("other_srvs/srv/Turn", "Turn()", "Turn.Request()"),
        ("std_srvs/SetBool", "SetBoolRequest(data=True)", ""),
        ("std_srvs/srv/SetBool", "SetBool.Request(data=True)", ""),
        ("SetBool", "SetBool(data=True)", ""),
        ("std_srvs/SetBool", "{data: true}", ""),
    ],
)
def test_the_class_of_a_service_in_place_of_its_request(type: str, code: str, new: str) -> None:
    found = findings("SM512", "ServiceState", f"{SERVICE.format(type)}request: {code}", "[]")
    assert [item.help for item in found] == ([f"write `{new}`"] if new else [])


LISTEN = """
name: sm
template: ROSBase
{robot}
outcomes: [done, failed]
userdata: {{base: base_link, tag: {tag}}}
states:
  - LOOK:
      template: TF2ListenerState
      remapping: {{target: base, source: tag, output: seen}}
      transitions: {{succeeded: done, aborted: failed, preempted: failed}}
"""


@pytest.mark.parametrize("robot", ["", "robot: panda"])
@pytest.mark.parametrize(("tag", "help"), [("/odom", "write `odom`"), ("odom", ""), ("a/odom", "")])
def test_tf2_refuses_frames_with_a_slash(robot: str, tag: str, help: str) -> None:
    report = analysed({"main.yml": LISTEN.format(robot=robot, tag=tag)}).report
    found = [item.help for item in report if item.code == "SM505"]
    if help or not robot:
        assert found == ([help] if help else [])
