"""Nothing follows from an unknown name: it is one finding, and faults elsewhere stay."""

from __future__ import annotations

import pytest

from smachac.repair.search import again, clusters
from tests.checks.test_first_scripts import reported
from tests.trust.project_text import analysed

TASK = """\
name: task
outcomes: [done, failed]
userdata: {place: 0.5}
states:
  - LOOK:
      template: ScriptedState
      outcomes: [seen, lost]
      output_keys: [pose]
      transitions: {seen: GRASP, lost: failed}
  - GRASP:
      template: PrintUserdataState
      input_keys: [target]
      remapping: {target: pose}
      transitions: {succeeded: MOVE}
  - MOVE:
      template: StateMachine
      outcomes: [there, stuck]
      input_keys: [goal]
      remapping: {goal: place}
      transitions: {there: done, stuck: failed}
      states:
        - DRIVE:
            template: ScriptedState
            outcomes: [arrived, blocked]
            input_keys: [goal]
            transitions: {arrived: there, blocked: stuck}
"""

SLIPS = [
    ("seen: GRASP", "seen: GRAPS", "SM101"),
    ("seen: GRASP", "seen: ELSEWHERE", "SM101"),
    ("arrived: there", "arrived: away", "SM101"),
    ("{succeeded: MOVE}", "{suceeded: MOVE}", "SM102"),
    ("{succeeded: MOVE}", "{finished: MOVE}", "SM102"),
    ("blocked: stuck", "bumped: stuck", "SM102"),
    ("{target: pose}", "{tagret: pose}", "SM302"),
    ("{target: pose}", "{thing: pose}", "SM302"),
    ("{goal: place}", "{gaol: place}", "SM302"),
]


@pytest.mark.parametrize(("right", "wrong", "code"), SLIPS)
def test_an_unknown_name_is_one_finding(right: str, wrong: str, code: str) -> None:
    assert reported({"main.yml": TASK}) == []
    assert TASK.count(right) == 1
    found = reported({"main.yml": TASK.replace(right, wrong)})
    assert [item[0] for item in found] == [code]


@pytest.mark.parametrize(("right", "wrong", "code"), SLIPS)
def test_its_repair_restores_the_script(right: str, wrong: str, code: str) -> None:
    analysis = analysed({"main.yml": TASK.replace(right, wrong)})
    found = clusters(analysis, analysis.report, again(analysis))
    edits = [(edit.span.text, edit.text) for item in found for edit in item.repair.edits]
    name = wrong.strip("{}").split(": ")
    meant = right.strip("{}").split(": ")
    ((old, new),) = [pair for pair in zip(name, meant, strict=True) if pair[0] != pair[1]]
    assert edits == [(old, new)]


@pytest.mark.parametrize(("right", "wrong", "code"), [SLIPS[0], SLIPS[3], SLIPS[6]])
def test_a_fault_in_another_container_stays(right: str, wrong: str, code: str) -> None:
    text = TASK.replace(right, wrong).replace("blocked: stuck", "blocked: there")
    assert [item[0] for item in reported({"main.yml": text})] == [code, "SM203"]


def test_an_unknown_target_can_be_every_state() -> None:
    """No state behind it is unreachable, no key unset, and no loop without an end."""
    text = TASK.replace("seen: GRASP, lost: failed", "seen: SOMEWHERE, lost: LOOK")
    assert [item[0] for item in reported({"main.yml": text})] == ["SM101"]


@pytest.mark.parametrize("field", ["timeout: 5s", "retry: {on: [lost], max: 2}"])
def test_an_unknown_type_with_a_time_limit_or_tries_is_one_finding(field: str) -> None:
    """Such a state is a container of the state, which has the remapping."""
    ends = "timeout: failed, preempted: failed"
    if field.startswith("retry"):
        ends = "exhausted: failed, preempted: failed"
    text = TASK.replace("PrintUserdataState", f"Grsap\n      {field}")
    text = text.replace("{succeeded: MOVE}", f"{{succeeded: MOVE, {ends}}}")
    assert [item[0] for item in reported({"main.yml": text})] == ["SM013"]
