"""SM203: an outcome that a state never ends with because a variable has no value."""

from __future__ import annotations

import pytest

from tests.checks.test_first_scripts import reported

MAIN = """\
name: watch
template: ROSBase
outcomes: [charged, empty, preempted]
states:
  - WATCH:
      template: MonitorState
      topic: battery
      msg_type: std_msgs/Float32
      cond_cb: 'lambda userdata, message: message.data > 0.2'
      transitions: {valid: GOOD, invalid: LOW, preempted: preempted}
  - CHARGE:
      template: ScriptedState
      outcomes: [done]
      transitions: {done: charged}
"""
HELP = "add `max_checks: 3` to `WATCH`, or use another of its outcomes here"
LIMITED = ("cond_cb:", "max_checks: 3\n      cond_cb:")


def found(valid: str, invalid: str, *pairs: tuple[str, str]) -> list[tuple[str, str, str | None]]:
    text = MAIN.replace("GOOD", valid).replace("LOW", invalid)
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    return [item for item in reported({"main.yml": text}) if item[0] in ("SM201", "SM203")]


@pytest.mark.parametrize(("valid", "invalid"), [("CHARGE", "empty"), ("empty", "CHARGE")])
def test_the_only_way_to_a_state_or_an_end(valid: str, invalid: str) -> None:
    assert found(valid, invalid) == [("SM203", "valid", HELP)]
    assert found(valid, invalid, LIMITED) == []


@pytest.mark.parametrize("null", ["null", "[params, most]"])
def test_a_variable_that_is_null_has_no_value(null: str) -> None:
    limit = ("cond_cb:", f"max_checks: {null}\n      cond_cb:")
    params = ("template: ROSBase", "template: ROSBase\nparams: {most: null}")
    assert found("CHARGE", "empty", limit, params) == [("SM203", "valid", HELP)]


def test_a_state_with_another_way_to_it() -> None:
    assert found("CHARGE", "CHARGE", ("[charged, empty,", "[charged,")) == []
    assert found("charged", "CHARGE", ("[charged, empty,", "[charged,")) == []


def test_states_with_one_name_are_not_judged() -> None:
    second = (
        "  - WATCH: {template: ScriptedState, outcomes: [valid], transitions: {valid: empty}}\n"
    )
    text = MAIN.replace("GOOD", "CHARGE").replace("LOW", "empty")
    codes = {item[0] for item in reported({"main.yml": text + second})}
    assert "SM106" in codes
    assert "SM203" not in codes


BOTH = """\
name: watch
template: ROSBase
outcomes: [ok, low, preempted]
states:
  - BOTH:
      template: Concurrence
      outcomes: [ok, low, preempted]
      default_outcome: ok
      outcome_map: {low: {WAIT: aborted}}
      states:
        - WORK: {template: ScriptedState, outcomes: [done]}
        - WAIT:
            template: WaitForMsgState
            topic: battery
            msg_type: std_msgs/Float32
      transitions: {ok: ok, low: low, preempted: preempted}
"""


@pytest.mark.parametrize(
    ("variable", "expected"),
    [
        ("latch: true", 1),
        ("timeout: 5", 0),
        ("msg_cb: 'lambda message, userdata: message.data > 0.2'", 0),
    ],
)
def test_a_rule_of_a_concurrence(variable: str, expected: int) -> None:
    text = BOTH.replace("topic: battery", f"topic: battery\n            {variable}")
    findings = [item for item in reported({"main.yml": text}) if item[0] == "SM203"]
    help = "add `timeout: 1.5` or `msg_cb: ...` to `WAIT`, or use another of its outcomes here"
    assert findings == [("SM203", "WAIT", help)] * expected


WEIGH = """\
variables:
  limit: {type: float<kg>, default: null}
outcomes: {light: {}, heavy: {needs: NEEDS}}
"""
SCRIPT = """\
name: scale
template: Base
outcomes: [light, heavy]
states:
  - WEIGH:
      template: Weigh
      transitions: {light: light, heavy: heavy}
"""


def test_an_interface_of_the_user() -> None:
    files = {"main.yml": SCRIPT, "templates/Weigh.yml": WEIGH.replace("NEEDS", "limit")}
    help = "add `limit: 1.5` to `WEIGH`, or use another of its outcomes here"
    assert reported(files) == [("SM203", "heavy", help)]


@pytest.mark.parametrize(
    ("needs", "mark"), [("limt", "limt"), ("[limt]", "limt"), ("{a: b}", "{a: b}")]
)
def test_needs_of_something_else(needs: str, mark: str) -> None:
    files = {"main.yml": SCRIPT, "templates/Weigh.yml": WEIGH.replace("NEEDS", needs)}
    assert [item[:2] for item in reported(files) if item[0] == "SM004"] == [("SM004", mark)]
