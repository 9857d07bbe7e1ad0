"""Callbacks of ROS states in modules: fields of their messages, parameters, comparisons, results.
The same slips in a lambda of the script have the same findings."""

from __future__ import annotations

import pytest

from tests.trust.project_text import analysed

MAIN = """\
name: sm
template: LiftBase
outcomes: [done, failed, preempted]
userdata: {floor: 3}
states:
  - CALL:
      template: ServiceState
      service_namespace: lift
      service: lift_msgs/srv/Call
      request_slots: [floor]
      response_cb: lift_answer
      input_keys: [floor]
      transitions: {succeeded: DRIVE, aborted: failed, preempted: preempted}
  - DRIVE:
      template: SimpleActionState
      action_server_namespace: navigate
      action: lift_msgs/action/Drive
      goal_cb: set_speed
      result_cb: check_arrival
      input_keys: [floor]
      transitions: {succeeded: done, aborted: failed, preempted: preempted}
"""
BASE = """\
{% extends "ROSBase.tpl.py" %}
{% block imports %}
{{ super() }}
from lift.answers import lift_answer, set_speed, check_arrival
{% endblock imports %}
"""
ANSWERS = """\
def lift_answer(userdata, response):
    if not response.accepted:
        print("refused", response.reason)
        return "aborted"
    return "succeeded"


def set_speed(userdata, goal):
    goal.max_speed = 1.2 if userdata.floor == 0 else 0.6
    return goal


def check_arrival(userdata, status, result):
    if result.code == 1:
        return "aborted"
    return None
"""
PACKAGE = {
    "lift_msgs/srv/Call.srv": "int32 floor\n---\nbool accepted\nstring reason\n",
    "lift_msgs/action/Drive.action": "float32 max_speed\n---\nuint8 OK=0\nuint8 BLOCKED=1\n"
    "string NAME=here\nuint8 code\nstring place\n---\n",
}
AT = "lift/answers.py"


def findings(answers: str, main: str = MAIN) -> list[tuple[str, str, str]]:
    """Code, marked place and help of each finding above an info."""
    files = {
        "main.yml": main,
        "lift/__init__.py": "",
        AT: answers,
        "templates/LiftBase.tpl.py": BASE,
        **PACKAGE,
    }
    return [
        (item.code, f"{item.span.source.name}:{item.span.line} {item.span.text}", item.help or "")
        for item in analysed(files).report
        if item.severity.value != "info"
    ]


@pytest.mark.parametrize(
    ("old", "new", "code", "place", "help"),
    [
        ("not response.accepted", "not response.success", "SM512", "2 success",
         "use one of its fields: `accepted`, `reason`"),
        ('"refused", response.reason', 'f"no: {response.reasn}"', "SM512", "3 reasn",
         "did you mean `reason`?"),
        ("goal.max_speed", "goal.max_sped", "SM512", "9 max_sped", "did you mean `max_speed`?"),
        ("set_speed(userdata, goal)", "set_speed(goal, userdata)", "SM317", "8 goal, userdata",
         "write `def set_speed(userdata, goal):`"),
        ("result.code == 1", 'result.code == "BLOCKED"', "SM512", '14 result.code == "BLOCKED"',
         "write `result.code == 1`: `BLOCKED` is a constant of the message with the value 1"),
        ("result.code == 1", 'result.code == "late"', "SM512", '14 result.code == "late"',
         "compare it with a constant of the message: `OK=0`, `BLOCKED=1`"),
        ('"succeeded"', '"suceeded"', "SM318", '5 "suceeded"', "did you mean `succeeded`?"),
        ("return None", "return result.code", "SM318", "16 result.code",
         "return one of its outcomes: `aborted`, `preempted`, `succeeded`"),
        ("return None", "return result.code != 0", "SM318", "16 result.code != 0",
         "write `'succeeded' if result.code != 0 else 'aborted'`"),
        ("check_arrival(userdata, status, result)", "check_arrival(ud, result)", "SM317",
         "13 check_arrival", "write `def check_arrival(ud, status, result):`"),
    ],
)  # fmt: skip
def test_a_slip_in_a_callback(old: str, new: str, code: str, place: str, help: str) -> None:
    assert old in ANSWERS
    assert findings(ANSWERS.replace(old, new)) == [(code, f"{AT}:{place}", help)]


def test_truth_values_are_one_fault() -> None:
    answers = ANSWERS.replace('"aborted"', "False", 1).replace('"succeeded"', "True", 1)
    help = "return `'succeeded'` in place of `True`, `'aborted'` in place of `False`"
    assert findings(answers) == [("SM318", f"{AT}:4 False", help)]
    lambdas = MAIN.replace("lift_answer", "'lambda ud, r: True if r.accepted else False'")
    assert findings(ANSWERS, lambdas) == [("SM318", "main.yml:11 True", help)]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("", ""),
        ("    if not response.accepted", "    response = other()\n    if not response.ok"),
        ("not response.accepted", "hasattr(response, 'ok') and not response.ok"),
        ("not response.accepted", "isinstance(response, Old) and not response.ok"),
        ("        print(\"refused\", response.reason)",
         "        try:\n            print(response.text)\n        except AttributeError:\n"
         "            pass"),
        ("not response.accepted", "not [response.ok for response in userdata.floor]"),
        ("response.reason", "response.get_fields_and_field_types()"),
        ("def lift_answer", "@wrapped\ndef lift_answer"),
        ("result.code == 1", "result.code == result.BLOCKED"),
        ("result.code == 1", 'result.place == "door"'),
        ("return None", "return outcome_of(result)"),
        ("return None", "return OUTCOMES[result.code]"),
        ("set_speed(userdata, goal)", "set_speed(userdata, goal, faster=False)"),
        ("(userdata, status, result)", "(*given):\n    result = given[2]\n    given = (None"),
    ],
)  # fmt: skip
def test_callbacks_that_are_right_or_cannot_be_judged(old: str, new: str) -> None:
    assert old in ANSWERS
    found = findings(ANSWERS.replace(old, new))
    assert [item for item in found if item[0] in ("SM512", "SM317", "SM318")] == []


def test_constants_in_the_help_for_a_lambda() -> None:
    code = """'lambda ud, s, r: "aborted" if r.code == "x" else None'"""
    main = MAIN.replace("check_arrival", code)
    help = "compare it with a constant of the message: `OK=0`, `BLOCKED=1`"
    assert findings(ANSWERS, main) == [("SM512", 'main.yml:19 r.code == "x"', help)]


def test_a_call_in_place_of_a_callback() -> None:
    main = MAIN.replace("response_cb: lift_answer", "response_cb: lift_answer()")
    help = "write the function: `lift_answer`"
    assert findings(ANSWERS, main) == [("SM316", "main.yml:11 lift_answer()", help)]


@pytest.mark.parametrize(
    "body",
    ["def lift_answer(limit=1):\n    return lambda ud, response: None\n",
     "def lift_answer(limit=1):\n    return ANSWERS[limit]\n",
     "def lift_answer(limit=1):\n    def answer(ud, response): ...\n    return answer\n"],
)  # fmt: skip
def test_a_call_that_gives_a_callback(body: str) -> None:
    main = MAIN.replace("response_cb: lift_answer", "response_cb: lift_answer()")
    answers = ANSWERS[: ANSWERS.index("def lift_answer")] + body
    answers += ANSWERS[ANSWERS.index("\n\ndef set_speed") :]
    assert findings(answers, main) == []
