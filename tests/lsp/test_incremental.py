"""Checks after changes: what is taken from the last check is what a fresh check would compute."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.analysis.context import Context
from smachac.batch import check_scripts
from smachac.diagnostics.diagnostic import Diagnostic
from smachac.frontend.files import Disk
from smachac.ir.nodes import Container, Leaf
from smachac.lsp.session import Session
from tests.support.lsp_edits import Edit, edited, edits

FILES = {
    "main.yml": """\
name: sm
template: Base
outcomes: [done, stuck]
types: {Joints: "float[7]"}
params: {seconds: 2}
userdata: {target: [[0.5, 0.0, 0.1], [0.0, 0.0, 0.0, 1.0]], tries: 0}
states:
- FIRST: {script: part, remapping: {pose: target}, transitions: {ok: SECOND, bad: stuck}}
- SECOND:
    script: part
    params: {seconds: 3}
    remapping: {pose: target}
    transitions: {ok: THIRD, bad: stuck}
- THIRD: {script: wait, transitions: {succeeded: LAST, preempted: stuck}}
- LAST: {script: grasp, transitions: {succeeded: done, lost: stuck}}
""",
    "part.yml": """\
- PART:
    template: StateMachine
    outcomes: [ok, bad]
    input_keys: [pose]
    states:
    - PLAN:
        template: PoseToJointPositionsState
        remapping: {joints: positions}
        transitions: {succeeded: MOVE, aborted: bad}
    - MOVE:
        template: MoveToJointPositionsState
        timeout: 5
        transitions: {succeeded: WAIT, aborted: bad, preempted: bad, timeout: bad}
    - WAIT: {script: wait, transitions: {succeeded: ok, preempted: bad}}
""",
    "wait.yml": """\
- WAIT:
    template: SleepState
    time: [params, seconds]
""",
    "grasp.yml": """\
- GRASP:
    template: Grasp
    outcomes: [succeeded, lost]
    retry: {on: [lost], max: 2}
    transitions: {exhausted: lost}
""",
    "templates/Grasp.yml": """\
name: Grasp
output_keys: {width: float}
outcomes: {succeeded: {}, lost: {failure: true}}
code: {python: "cell:Grasp"}
""",
    "cell.py": """\
import smach


class Grasp(smach.State):
    def __init__(self):
        super().__init__(outcomes=["succeeded", "lost"], output_keys=["width"])

    def execute(self, userdata):
        userdata.width = 0.1
        return "succeeded" if userdata.width else "lost"
""",
}
"""A project in which sub-scripts call others, with params, a state type and a class of its own."""


def project(folder: Path) -> dict[str, str]:
    """Write the project; its texts by real path."""
    texts = {}
    for name, text in FILES.items():
        path = folder / name
        path.parent.mkdir(exist_ok=True, parents=True)
        path.write_text(text, "utf-8")
        texts[os.path.realpath(path)] = text
    return texts


def identity_of(item: Diagnostic) -> tuple[Any, ...]:
    """All that a user sees of a finding, with its places."""
    finding = item.finding
    related = [(each.span.source.name, each.span[1:], each.message) for each in finding.related]
    steps = [(step.node, step.label) for step in finding.path]
    return (
        *(item.code, item.severity.value, item.span.source.name, item.span[1:], item.message),
        *(finding.help, finding.node, finding.arguments, related, steps),
    )


def found(session: Session, main: str) -> list[str]:
    reports = session.check(main).values()
    return sorted(repr(identity_of(item)) for each in reports for item in each)


def fresh(main: str, texts: dict[str, str]) -> list[str]:
    report = check_scripts([Path(main)], Disk(texts)).report
    return sorted(repr(identity_of(item)) for item in report)


@settings(max_examples=15, deadline=None, derandomize=True)
@given(steps=st.lists(st.tuples(st.sampled_from(sorted(FILES)), edits()), max_size=8))
def test_findings_after_edits_of_any_file_are_those_of_a_fresh_check(
    steps: list[tuple[str, Edit]], tmp_path_factory: Any
) -> None:
    folder = Path(os.path.realpath(tmp_path_factory.mktemp("project")))
    texts = project(folder)
    main = str(folder / "main.yml")
    session = Session([folder])
    assert found(session, main) == fresh(main, texts)
    histories = {name: [text] for name, text in FILES.items()}
    for name, step in steps:
        path = str(folder / name)
        texts[path], _ = edited(histories[name], step)
        session.change(path, texts[path])
        assert found(session, main) == fresh(main, texts)


def container(session: Session, main: str, name: str) -> Container:
    context = session.view(main).context  # type: ignore[union-attr]
    assert isinstance(context, Context)
    found = next(child for child in context.machine.root.children if child.name == name)
    assert not isinstance(found, Leaf)
    return found


def test_a_sub_script_that_has_not_changed_keeps_its_nodes_and_scopes(tmp_path: Path) -> None:
    folder = Path(os.path.realpath(tmp_path))
    texts = project(folder)
    main, wait = str(folder / "main.yml"), str(folder / "grasp.yml")
    session = Session([folder])
    session.check(main)
    part, grasp = (container(session, main, name) for name in ("FIRST", "LAST"))
    scopes = session.view(main).context.corrected_flow.scopes  # type: ignore[union-attr]
    session.change(wait, texts[wait].replace("max: 2", "max: 3"))
    session.check(main)
    assert container(session, main, "FIRST") is part
    assert container(session, main, "LAST") is not grasp
    new = session.view(main).context.corrected_flow.scopes  # type: ignore[union-attr]
    assert new["sm/FIRST"] is scopes["sm/FIRST"]
    assert new["sm"] is not scopes["sm"]


ALIASED = """\
name: sm
template: Base
outcomes: [succeeded, preempted]
states:
- FIRST:
    template: StateMachine
    outcomes: [succeeded, preempted]
    params: {seconds: -1}
    states:
    - &wait {WAIT: {script: wait}}
    transitions: {succeeded: SECOND}
- SECOND:
    template: StateMachine
    outcomes: [succeeded, preempted]
    params: {seconds: -1}
    states:
    - *wait
    transitions: {succeeded: THIRD}
- THIRD: {script: rest}
"""
"""One call in two containers: its params have the same values at two places."""


def test_a_call_that_is_used_twice_by_an_alias_keeps_the_places_of_both(tmp_path: Path) -> None:
    folder = Path(os.path.realpath(tmp_path))
    rest = "- REST: {template: SleepState, time: 1}\n"
    texts = {"main.yml": ALIASED, "wait.yml": FILES["wait.yml"], "rest.yml": rest}
    for name, text in texts.items():
        (folder / name).write_text(text, "utf-8")
    main, other = str(folder / "main.yml"), str(folder / "rest.yml")
    session = Session([folder])
    places = {item.span.start for each in session.check(main).values() for item in each}
    assert {at for at in range(len(ALIASED)) if ALIASED.startswith("-1", at)} <= places
    for _ in range(2):
        session.change(other, session.text(other).replace("1", "2") + "\n")
        assert found(session, main) == fresh(main, {other: session.text(other)})
