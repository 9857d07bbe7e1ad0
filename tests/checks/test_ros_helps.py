"""The places and helps of findings about states of ROS."""

from __future__ import annotations

import pytest

from tests.trust.project_text import analysed

WATCH = """\
name: sm
template: ROSBase
outcomes: [low, stopped]
states:
  - WATCH:
      template: MonitorState
      topic: battery
      msg_type: std_msgs/Float32
      cond_cb: 'lambda ud, msg: msg.data > 10.0'
      transitions: {invalid: low, valid: stopped, preempted: stopped}
"""
GRIP = """\
name: sm
template: ROSBase
outcomes: [done, failed, stopped]
states:
  - GRIP:
      template: ServiceState
      service_namespace: grip
      service: std_srvs/SetBool
      request: {data: true}
      response_cb: 'lambda ud, response: "succeeded" if response.success else "aborted"'
      transitions: {succeeded: done, aborted: failed, preempted: stopped}
"""


@pytest.mark.parametrize(
    ("script", "old", "new", "code", "marked", "help"),
    [
        (WATCH, "", "", "", "", ""),
        (GRIP, "", "", "", "", ""),
        (WATCH, "lambda ud, msg", "lambda msg", "SM317", "msg", "begin it with `lambda ud, msg:`"),
        (
            WATCH, "'lambda ud, msg: msg.data > 10.0'", "ud.n > 0", "SM316", "ud",
            "write `'lambda ud, message: ud.n > 0'`",
        ),
        (
            GRIP, "lambda ud, response", "lambda ud", "SM317", "ud",
            "begin it with `lambda ud, response:`",
        ),
        (
            WATCH, "      msg_type: std_msgs/Float32\n", "", "SM005", "WATCH",
            "add `msg_type` with the type of the messages, such as `msg_type: std_msgs/Float32`",
        ),
        (
            GRIP, "std_srvs/SetBool", "std_srvs", "SM019", "std_srvs",
            "write the type as well, as in `std_srvs/Trigger`",
        ),
    ],
)  # fmt: skip
def test_one_slip_is_one_finding(
    script: str, old: str, new: str, code: str, marked: str, help: str
) -> None:
    assert old in script
    report = analysed({"main.yml": script.replace(old, new, 1)}).report
    found = [(item.code, item.span.text, item.help) for item in report]
    found = [item for item in found if item[0] != "SM207"]  # a server without a limit
    assert found == ([(code, marked, help)] if code else [])


QOS = WATCH.replace("topic: battery", "topic: battery\n      qos: QOS")


@pytest.mark.parametrize(
    ("qos", "marked", "help"),
    [
        ("{reliability: relyable, depth: 1}", "relyable", "did you mean `reliable`?"),
        ("{depth: one}", "one", "write a whole number, such as `depth: 1`"),
        ("{durabilty: volatile}", "durabilty", "did you mean `durability`?"),
        ("{preset: sensor_dat}", "sensor_dat", "did you mean `sensor_data`?"),
        ("sensor_dat", "sensor_dat", "did you mean `sensor_data`?"),
    ],
)
def test_a_fault_of_a_policy_is_at_its_value(qos: str, marked: str, help: str) -> None:
    report = analysed({"main.yml": QOS.replace("QOS", qos)}).report
    found = [(item.span.text, item.help) for item in report if item.code == "SM004"]
    assert found == [(marked, help)]


STOPPED_OR_NOT = """
name: sm
template: ROSBase
outcomes: [done, failed]
states:
  - CALL:
      template: ServiceState
      service_namespace: /door
      service: std_srvs/SetBool
      request: {{data: true}}
      response_cb: 'lambda userdata, response: "succeeded" if response.success else "{word}"'
      transitions: {{succeeded: done, {word}: failed, preempted: failed}}
"""


@pytest.mark.parametrize(
    ("word", "help"),
    [
        ("rejected", "a service state ends with `succeeded`, `aborted` or `preempted`"),
        ("preemptd", "did you mean `preempted`?"),
    ],
)
def test_an_outcome_is_guessed_as_preempted_only_if_it_is_near(word: str, help: str) -> None:
    report = analysed({"main.yml": STOPPED_OR_NOT.format(word=word)}).report
    helps = {item.code: item.help for item in report if item.code in ("SM102", "SM318")}
    assert helps["SM318"] == help
    near = word != "rejected"
    assert ("did you mean `preempted`" in (helps["SM102"] or "")) == near
