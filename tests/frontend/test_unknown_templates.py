"""Templates that were not found: one finding for all states, and the types with the same names."""

from __future__ import annotations

from dataclasses import replace

import pytest

from smachac.diagnostics.source import Source
from smachac.driver import analyse
from tests.trust.project_text import BUILT_IN, analysed

TWO = """
name: sm
template: PyBulletBase
outcomes: [done, lost]
userdata:
  spot: [[0.4, 0.0, 0.2], [1.0, 0.0, 0.0, 0.0]]
  above: [[0.0, 0.0, 0.1], [0.0, 0.0, 0.0, 1.0]]
states:
  - A: {template: NAME, FIELDS, transitions: {succeeded: B, aborted: lost}}
  - B: {template: NAME, FIELDS, transitions: {succeeded: done, aborted: lost}}
"""


def about(name: str, fields: str) -> list[tuple[str, str, int]]:
    """The text, the help and the number of other places of each SM013."""
    text = TWO.replace("NAME", name).replace("FIELDS", fields)
    found = [item for item in analysed({"main.yml": text}).report if item.code == "SM013"]
    return [(item.span.text, item.help or "", len(item.finding.related)) for item in found]


@pytest.mark.parametrize(
    ("name", "fields", "help"),
    [
        (
            "MoveToPoseState",
            "remapping: {pose: spot, offset: above}",
            "did you mean `MoveAlongState` or `PoseToJointPositionsState`, with `offset` and",
        ),
        (
            "HandState",
            "command: open",
            "did you mean `GripperInterfaceState` or `GripperState`, with `command`?",
        ),
        ("GriperState", "command: open", "did you mean `GripperState`? (searched in"),
        ("Wave", "times: 3", "put `Wave.yml` in one of the folders"),
        ("Wave", "tags: [arm]", "put `Wave.yml` in one of the folders"),
    ],
)
def test_one_finding_names_the_types_with_the_names_of_the_state(
    name: str, fields: str, help: str
) -> None:
    ((text, told, others),) = about(name, fields)
    assert (text, others) == (name, 1)
    assert told.startswith(help)


def test_two_unknown_templates_are_two_findings() -> None:
    text = TWO.replace("NAME", "Wave", 1).replace("NAME", "Nod").replace("FIELDS, ", "")
    report = analysed({"main.yml": text}).report
    assert [item.span.text for item in report if item.code == "SM013"] == ["Wave", "Nod"]


@pytest.mark.parametrize("fields", ["command: open"])
def test_built_in_types_that_cannot_be_meant_are_not_read(fields: str) -> None:
    """Those without an interface, whose classes take long, and those without the words."""
    read: list[str] = []

    def template(name: str) -> Source | None:
        read.append(name)
        return BUILT_IN.template(name)

    text = TWO.replace("template: NAME, FIELDS", fields)
    report = analyse(Source("main.yml", text), replace(BUILT_IN, template=template), []).report
    assert {item.code for item in report} & {"SM003", "SM005"}
    assert "GripperState.yml" in read
    assert not {"ParsePose.tpl.py", "WaitForMsg.tpl.py", "ParsePose.tpl"} & {*read}


@pytest.mark.parametrize(
    ("name", "fields", "help"),
    [
        (
            "WaitState",
            "wait_time: 5.0",
            "write `template: SleepState`, with `time` in place of `wait_time`",
        ),
        ("CBState", "callbacks: {n: f}", "write `template: CallbacksState`"),
        (
            "CheckConditionState",
            "predicate: f",
            "write `template: ConditionState`, with `cond_cb` in place of `predicate`",
        ),
        (
            "ActionState",
            "action_name: /go, action_type: a/action/Go",
            "write `template: SimpleActionState`, with `action_server_namespace` in place of"
            " `action_name`, `action` in place of `action_type`",
        ),
    ],
)
def test_the_name_of_a_type_in_another_framework_leads_to_the_type_here(
    name: str, fields: str, help: str
) -> None:
    ((_, told, others),) = about(name, fields)
    assert (told, others) == (help, 1)


def test_two_calls_of_one_sub_script_show_the_place_in_it_once() -> None:
    main = (
        "name: sm\ntemplate: Base\noutcomes: [succeeded]\nstates:\n"
        "  - A: {script: wait, transitions: {succeeded: B}}\n"
        "  - B: {script: wait, transitions: {succeeded: succeeded}}\n"
    )
    wait = "- WAIT: {template: CBState, outcomes: [succeeded]}\n"
    (item,) = analysed({"main.yml": main, "wait.yml": wait}).report
    assert (item.code, item.finding.related) == ("SM013", ())
