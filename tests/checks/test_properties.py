"""Rules over properties: paths that count, what is reported, and how it is replayed."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

import smachac
from smachac.commands.cli import main
from tests.trust.project_text import analysed

STATES = """\
  - PICK:
      template: ScriptedState
      outcomes: [done, lost, preempted]
      transitions: {done: CARRY, lost: aborted, preempted: aborted}
  - CARRY:
      template: ScriptedState
      outcomes: [done]
      transitions: {done: PLACE}
  - PLACE: {template: ScriptedState, outcomes: [done], transitions: {done: succeeded}}
  - LET_GO: {template: ScriptedState, outcomes: [done], transitions: {done: aborted}}
"""


def findings(folder: Path, properties: str, states: str = STATES, head: str = "") -> list[str]:
    """Code, message and path of each finding about properties."""
    text = f"name: sm\ntemplate: Base\noutcomes: [succeeded, aborted]\n{head}"
    script = folder / "main.yml"
    script.write_text(f"{text}properties:\n{properties}states:\n{states}", "utf-8")
    return [
        f"{item.code} {item.message.partition('hold: ')[2]} | {' '.join(item.finding.path_labels)}"
        for item in smachac.check(script)
        if item.code.startswith("SM7")
    ]


def test_stops_are_paths_unless_they_are_left_out(tmp_path: Path) -> None:
    states = STATES.replace("lost: aborted", "lost: LET_GO")
    given = "  - after: {PICK: [PLACE, LET_GO]}\n"
    assert findings(tmp_path, given, states) == [
        "SM701 the run ends without `PLACE` or `LET_GO` after `PICK`"
        " | PICK (stop request, preempted) aborted"
    ]
    assert findings(tmp_path, f"{given}    stops: false\n", states) == []


def test_exceptions_are_paths_where_they_are_caught(tmp_path: Path) -> None:
    states = STATES.replace("aborted, preempted: aborted", "LET_GO, preempted: LET_GO")
    given = "  - after: {PICK: [PLACE, LET_GO]}\n"
    assert findings(tmp_path, given, states) == []
    (crash,) = findings(tmp_path, f"{given}    exceptions: all\n", states)
    assert crash.endswith("| PICK (exception) the run ends")
    caught = states.replace("{done: PLACE}", "{done: PLACE, error: aborted}")
    (found,) = findings(tmp_path, given, caught)
    assert found.endswith("| PICK (done) CARRY (exception) aborted")
    assert findings(tmp_path, f"{given}    exceptions: none\n", caught) == []
    assert findings(tmp_path, given, states, head="on_error: LET_GO\n") == []


def test_time_limits_are_paths(tmp_path: Path) -> None:
    states = STATES.replace("aborted, preempted: aborted", "LET_GO, preempted: LET_GO")
    limited = states.replace("{done: PLACE}", "{done: PLACE, timeout: aborted, preempted: LET_GO}")
    limited = limited.replace("outcomes: [done]\n", "outcomes: [done]\n      timeout: 2s\n", 1)
    (found,) = findings(tmp_path, "  - after: {PICK: [PLACE, LET_GO]}\n", limited)
    assert found.endswith("CARRY (timeout) aborted")


def test_a_state_that_cannot_be_reached_is_one_fault(tmp_path: Path) -> None:
    assert findings(tmp_path, "  - after: {LET_GO: PLACE}\n") == []
    assert len(findings(tmp_path, "  - after: {'PICK:preempted': PLACE}\n    stops: false\n")) == 1


def test_each_property_is_reported(tmp_path: Path) -> None:
    """Two properties at one place differ in their arguments."""
    states = STATES.replace("lost: aborted", "lost: LET_GO")
    found = findings(tmp_path, "  - before: {CARRY: LET_GO, PLACE: LET_GO}\n", states)
    assert [item.partition(" |")[0] for item in found] == [
        "SM701 `CARRY` is entered before `LET_GO`",
        "SM701 `PLACE` is entered before `LET_GO`",
    ]


BRANCHES = """\
  - BOTH:
      template: Concurrence
      outcomes: [done]
      default_outcome: done
      states:
        - LEFT: {template: ScriptedState, outcomes: [done]}
        - RIGHT: {template: ScriptedState, outcomes: [done]}
      transitions: {done: succeeded}
"""


@pytest.mark.parametrize(("first", "second"), [("LEFT", "RIGHT"), ("RIGHT", "LEFT")])
def test_the_help_of_a_finding_replays_it(
    first: str, second: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The branches end in the order that violates the property."""
    given = f"  - before: {{'{second}:done': '{first}:done'}}\n"
    assert len(findings(tmp_path, given, BRANCHES)) == 1
    script = tmp_path / "main.yml"
    (item,) = [one for one in smachac.check(script) if one.code == "SM701"]
    command = re.search(r"write `(\{.*\})` into .* --schedule (\S+)`$", item.help or "")
    assert command is not None
    scenario = tmp_path / "fails.yml"
    scenario.write_text(command[1], "utf-8")
    trace = tmp_path / "trace.jsonl"
    options = ["--mock", str(scenario), "--schedule", command[2], "--trace", str(trace)]
    assert main(["run", str(script), *options]) == 0
    events = [json.loads(line) for line in trace.read_text("utf-8").splitlines()]
    ends = [event["path"] for event in events if event["event"] == "exit"]
    assert ends[:2] == [f"sm/BOTH/{second}", f"sm/BOTH/{first}"]
    capsys.readouterr()
    assert main(["explain", str(script), "--properties", "--scenario", "1"]) == 0
    printed = capsys.readouterr().out
    assert f"--schedule {command[2]}" in printed.splitlines()[0]
    scenario.write_text(printed, "utf-8")
    assert main(["run", str(script), *options]) == 0


def test_other_errors_forbid_a_replay(tmp_path: Path) -> None:
    scenario = tmp_path / "fails.yml"
    scenario.write_text("states: {}\n", "utf-8")
    findings(tmp_path, "  - before: {PLACE: LET_GO}\n", STATES.replace("CARRY,", "CARY,"))
    assert main(["run", str(tmp_path / "main.yml"), "--mock", str(scenario)]) == 1


def test_a_counterexample_is_a_code_flow(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    findings(tmp_path, "  - before: {PLACE: LET_GO}\n")
    main(["check", str(tmp_path / "main.yml"), "--format", "sarif"])
    (run,) = json.loads(capsys.readouterr().out)["runs"]
    (result,) = [item for item in run["results"] if item["ruleId"] == "SM701"]
    (flow,) = result["codeFlows"][0]["threadFlows"]
    texts = [item["location"]["message"]["text"] for item in flow["locations"]]
    assert texts == ["PICK -(done)->", "CARRY -(done)->", "PLACE"]


def test_explain_lists_the_properties(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    findings(tmp_path, "  - {name: a, before: {PLACE: CARRY}}\n  - at_most: {PICK: 1}\n")
    script = str(tmp_path / "main.yml")
    assert main(["explain", script, "--properties", "--format", "json"]) == 0
    data = json.loads(capsys.readouterr().out)["properties"]
    assert [(item["name"], item["verdict"]) for item in data] == [
        ("a", "holds"),
        ("`PICK` at most 1 time", "holds"),
    ]
    assert main(["explain", script, "--properties", "--scenario", "a"]) == 2
    assert "all properties hold" in capsys.readouterr().err
    assert main(["explain", script, "PICK", "--scenario", "a"]) == 2


TURN = """
name: carry
template: Base
outcomes: [succeeded, aborted]
properties:
  - after: {LIFT: STOP}
states:
  - CLOSE: {template: ScriptedState, outcomes: [done], transitions: {done: LIFT}}
  - LIFT:
      template: ScriptedState
      outcomes: [done, slipped]
      transitions: {done: STOP, slipped: HOME}
  - STOP: {template: ScriptedState, outcomes: [done], transitions: {done: succeeded}}
  - HOME: {template: ScriptedState, outcomes: [done], transitions: {done: aborted}}
"""


def test_the_transition_that_leads_past_the_required_state() -> None:
    """It is marked, also where the path ends later, and the help corrects it. A state to which no
    transition leads because of it is no second finding."""
    for text in (TURN, TURN.replace("done: STOP", "done: HOME")):
        (item,) = analysed({"main.yml": text}).report
        assert item.code == "SM701"
        (place,) = item.related
        if text == TURN:
            assert place.span.text == "HOME"
            assert place.message == "this transition leads to `HOME`, not to `STOP`"
        else:  # no transition leads to STOP
            assert (item.span.text, place.span.text) == ("HOME", "after")
            assert item.message.startswith("this transition leads past `STOP`: the run ends")
        outcome = "slipped" if text == TURN else "done"
        assert item.help is not None
        assert item.help.startswith(
            f"write `{outcome}: STOP` in `LIFT`, or correct the property if this path is right\n"
        )


def test_a_path_has_no_pause_and_no_stopped_timer() -> None:
    text = TURN.replace("- LIFT:\n", "- LIFT:\n      retry: {on: [done], max: 2, delay: 1s}\n")
    text = text.replace("{done: STOP, slip", "{exhausted: STOP, preempted: STOP, slip")
    (item,) = analysed({"main.yml": text}).report
    shown = [step.label for step in item.finding.path]
    assert "PAUSE" not in shown
    assert "LIFT" in shown


@pytest.mark.parametrize("wrong", ["timeout", "slipped"])
def test_the_transition_of_a_state_with_a_time_limit(wrong: str) -> None:
    """It is the one that the run takes, whatever the timer beside the state ends with."""
    right = "timeout" if wrong == "slipped" else "slipped"
    steps = f"{{done: STOP, {wrong}: HOME, {right}: STOP, preempted: STOP}}"
    text = TURN.replace("{done: STOP, slipped: HOME}", steps)
    text = text.replace("- LIFT:\n", "- LIFT:\n      timeout: 5s\n")
    (item,) = [one for one in analysed({"main.yml": text}).report if one.code == "SM701"]
    (place,) = item.related
    assert place.message == "this transition leads to `HOME`, not to `STOP`"
    assert (item.help or "").startswith(f"write `{wrong}: STOP` in `LIFT`, or correct")


UNLOCK = """
name: courier
template: Base
outcomes: [delivered, stopped]
properties:
  - after: {UNLOCK: [LOCK, "courier:stopped", "UNLOCK:preempted"]}
states:
  - UNLOCK:
      template: SleepState
      time: 2.0
      transitions: {succeeded: REPORT, preempted: BACK}
  - LOCK:
      template: SleepState
      time: 1.0
      transitions: {succeeded: REPORT, preempted: stopped}
  - REPORT: {template: ScriptedState, outcomes: [done], transitions: {done: delivered}}
  - BACK: {template: ScriptedState, outcomes: [done], transitions: {done: delivered}}
"""


def test_an_answer_with_outcomes_has_a_turn_and_the_event_is_no_answer_to_itself() -> None:
    for text in (UNLOCK, UNLOCK.replace("time: 2.0", "time: 1.0")):
        first, *_ = analysed({"main.yml": text}).report
        assert first.code == "SM701"
        assert (first.help or "").startswith("write `succeeded: LOCK` in `UNLOCK`, or correct the")
    right = UNLOCK.replace(
        "{succeeded: REPORT, preempted: BACK", "{succeeded: LOCK, preempted: BACK"
    )
    assert not [item for item in analysed({"main.yml": right}).report if item.code == "SM701"]


@pytest.mark.parametrize(
    ("limit", "help"),
    [
        ("30s", "write a number of states: `within: 3 states`"),
        ("2 min", "write a number of states: `within: 3 states`"),
        ("many", "write it like `3 states`"),
        ("3 states", None),
    ],
)
def test_a_time_as_the_limit_of_states(limit: str, help: str | None) -> None:
    """The property is not checked without its limit: a finding about it would be a second one."""
    text = TURN.replace("after: {LIFT: STOP}", f"whenever: {{CLOSE: LIFT, within: {limit}}}")
    report = analysed({"main.yml": text}).report
    found = [(item.code, item.help) for item in report if item.span.text == limit]
    assert found == ([("SM004", help)] if help else [])
    assert not [item for item in report if item.code == "SM701"]


def test_the_guess_for_a_state_by_its_first_words() -> None:
    for name, guess in (("LIFT_ARM", True), ("RAISE_ARM", False)):
        text = TURN.replace("after: {LIFT: STOP}", f"before: {{HOME: {name}}}")
        (help,) = [
            item.help for item in analysed({"main.yml": text}).report if item.code == "SM703"
        ]
        assert ((help or "") == "did you mean `LIFT`?") == guess


@pytest.mark.parametrize(
    "sugar",
    [
        "retry: {on: [lost], max: 2}",
        "retry: {on: [lost], max: 2, delay: 1s}",
        "retry: {on: [lost], max: 2, delay: 1s}\n      timeout: 5s",
    ],
)
def test_the_state_inside_its_retry(tmp_path: Path, sugar: str) -> None:
    states = STATES.replace("- PICK:\n", f"- PICK:\n      {sugar}\n", 1)
    more = "exhausted: aborted, timeout: aborted" if "timeout" in sugar else "exhausted: aborted"
    states = states.replace("lost: aborted", more, 1)
    assert findings(tmp_path, "  - at_most: {PICK: 1, PICK/PICK: 2}\n", states) == []
    assert len(findings(tmp_path, "  - at_most: {PICK/PICK: 1}\n", states)) == 1
    (wrong,) = findings(tmp_path, "  - at_most: {CARRY/CARRY: 1}\n", states)
    assert wrong.startswith("SM703")


def test_a_timer_is_shown_as_its_state(tmp_path: Path) -> None:
    states = STATES.replace("aborted, preempted: aborted", "LET_GO, timeout: LET_GO", 1)
    states = states.replace("- PICK:\n", "- PICK:\n      timeout: 2s\n", 1)
    given = "  - after: {PICK: [PLACE, LET_GO]}\n"
    stopped = states.replace("timeout: LET_GO", "timeout: LET_GO, preempted: aborted", 1)
    (found,) = findings(tmp_path, given, stopped)
    assert found.endswith(" | PICK (stop request, preempted) aborted")
    timed = states.replace("timeout: LET_GO", "timeout: aborted, preempted: LET_GO", 1)
    (found,) = findings(tmp_path, given, timed)
    assert found.endswith(" | PICK (timeout) aborted")
