"""Output keys of states with a service or an action that no field of a response or result sets."""

from __future__ import annotations

import pytest

from tests.checks.test_first_scripts import reported

CALL = """\
name: sm
template: ROSBase
outcomes: [done, failed]
userdata: {}
states:
  - CALL:
      template: TYPE
      output_keys: [KEYS]
      FIELDS
      transitions: {succeeded: CHECK, aborted: failed, preempted: failed}
  - CHECK:
      template: ConditionalOutcomeState
      outcomes: [ok]
      input_keys: [READ]
      callbacks: {ok: 'lambda ud: ud.READ'}
      default_outcome: refused
      transitions: {ok: done, refused: failed}
"""
SERVICE = (
    "service_namespace: light\n      service: std_srvs/srv/SetBool\n      request: {data: true}"
)
ACTION = (
    "action_server_namespace: fib\n      action: test_msgs/action/Fibonacci\n      goal: {order: 3}"
)
Row = tuple[str, str, str | None]


def found(type_: str, fields: str, keys: str, *more: str, read: str = "") -> list[Row]:
    every = "\n      ".join([fields, *more])
    text = CALL.replace("TYPE", type_).replace("FIELDS", every).replace("KEYS", keys)
    return reported({"main.yml": text.replace("READ", read or keys.split(",")[0])})


@pytest.mark.parametrize(
    ("keys", "more", "help"),
    [
        ("success, message", "doc: x", "add `response_slots: [success, message]` to `CALL`"),
        ("success", "doc: x", "add `response_slots: [success]` to `CALL`"),
        ("success", "response_slots: [message]",
         "add `success` to the `response_slots` of `CALL`"),
        ("success", "response_cb: 'lambda ud, r: \"succeeded\" if r.success else \"aborted\"'",
         "add `response_slots: [success]` to `CALL`"),
        ("enabled", "doc: x",
         "the response has no field `enabled`: set the key in `response_cb`, or list a field of the"
         " response in `response_slots`: `message`, `success`"),
    ],
)  # fmt: skip
def test_a_key_that_no_response_sets(keys: str, more: str, help: str) -> None:
    assert found("ServiceState", SERVICE, keys, more) == [("SM306", keys.split(",")[0], help)]


def test_a_key_that_no_result_sets() -> None:
    help = "add `result_slots: [sequence]` to `CALL`"
    assert found("SimpleActionState", ACTION, "sequence") == [("SM306", "sequence", help)]
    assert found("SimpleActionState", ACTION, "sequence", "result_slots: [sequence]") == []


@pytest.mark.parametrize(
    "more",
    [
        "response_slots: [success]",
        "response_slots: [success, message]",
        "response_cb: 'lambda ud, r: setattr(ud, \"success\", r.success)'",
        "response_cb: 'lambda ud, r: ud.update({\"success\": r.success})'",
        "response_cb: 'my_code.take'",
    ],
)
def test_a_key_that_is_set(more: str) -> None:
    assert [item for item in found("ServiceState", SERVICE, "success", more)
            if item[0] in ("SM301", "SM306")] == []  # fmt: skip


def test_a_key_that_another_state_sets() -> None:
    text = CALL.replace("TYPE", "ServiceState").replace("FIELDS", SERVICE)
    text = text.replace("KEYS", "success").replace("READ", "success")
    text = text.replace("userdata: {}", "userdata: {success: true}")
    help = "add `response_slots: [success]` to `CALL`"
    assert reported({"main.yml": text}) == [("SM306", "success", help)]
