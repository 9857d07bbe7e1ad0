"""Checks after changes: what is taken from the last check is what a fresh check would compute."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.analysis.context import Context
from smachac.diagnostics.diagnostic import Diagnostic
from smachac.driver.batch import check_scripts
from smachac.frontend.files import Disk
from smachac.ir.nodes import Container, Leaf
from smachac.lsp.session import Session
from tests.support.examples import examples
from tests.support.lsp_edits import Edit, edited, edits
from tests.support.lsp_projects import FAULTY, FILES, project


def identity_of(item: Diagnostic) -> tuple[Any, ...]:
    """All that a user sees of a finding, with its places."""
    finding = item.finding
    related = [
        (one.span.source.name, (one.span.start, one.span.end), one.message)
        for one in finding.related
    ]
    steps = [(step.node, step.label) for step in finding.path]
    return (
        *(
            item.code,
            item.severity.value,
            item.span.source.name,
            (item.span.start, item.span.end),
            item.message,
        ),
        *(finding.help, finding.node, finding.arguments, related, steps),
    )


def found(session: Session, main: str) -> list[str]:
    reports = session.check(main).values()
    return sorted(repr(identity_of(item)) for report in reports for item in report)


def fresh(main: str, texts: dict[str, str]) -> list[str]:
    report = check_scripts([Path(main)], Disk(texts)).report
    return sorted(repr(identity_of(item)) for item in report)


def compare_edits(files: Mapping[str, str], steps: list[tuple[int, Edit]], folder: Path) -> None:
    """Edit files of a project, and compare the findings with those of fresh checks."""
    texts = project(folder, files)
    main = str(folder / "main.yml")
    session = Session([folder])
    assert found(session, main) == fresh(main, texts)
    histories = {name: [text] for name, text in files.items()}
    for which, step in steps:
        name = sorted(files)[which % len(files)]
        path = str(folder / name)
        texts[path], _ = edited(histories[name], step)
        session.change(path, texts[path])
        assert found(session, main) == fresh(main, texts)


STEPS = st.lists(st.tuples(st.integers(0, 5), edits()), max_size=8)


@pytest.mark.parametrize("files", [FILES, FAULTY], ids=["sound", "faulty"])
@settings(max_examples=examples(10), deadline=None, derandomize=True)
@given(steps=STEPS)
def test_findings_after_edits_of_any_file_are_those_of_a_fresh_check(
    files: Mapping[str, str], steps: list[tuple[int, Edit]], tmp_path_factory: Any
) -> None:
    compare_edits(files, steps, Path(os.path.realpath(tmp_path_factory.mktemp("project"))))


KEPT = {"SM016", "SM019", "SM101", "SM102", "SM104", "SM302", "SM305", "SM306", "SM308", "SM310"}
"""Codes whose findings in a container are kept while it is the same object."""


def test_findings_in_a_sub_script_that_has_not_changed(tmp_path: Path) -> None:
    folder = Path(os.path.realpath(tmp_path))
    texts = project(folder, FAULTY)
    main, wait = str(folder / "main.yml"), str(folder / "wait.yml")
    session = Session([folder])
    first = fresh(main, texts)
    codes = {item.code for one in session.check(main).values() for item in one}
    assert codes >= KEPT
    faults = container(session, main, "FIRST")
    for seconds in ("2", "3"):
        texts[wait] = FAULTY["wait.yml"].replace("1", seconds)
        session.change(wait, texts[wait])
        assert found(session, main) == fresh(main, texts) == first
        assert container(session, main, "FIRST") is faults


def test_findings_that_depend_on_a_state_type_are_found_again(tmp_path: Path) -> None:
    folder = Path(os.path.realpath(tmp_path))
    texts = project(folder)
    main, interface = str(folder / "main.yml"), str(folder / "templates" / "Grasp.yml")
    session = Session([folder])
    assert found(session, main) == fresh(main, texts)
    for old, new in (("lost:", "dropped:"), ("width: float", "force: float"), ("cell:G", "cell:g")):
        texts[interface] = FILES["templates/Grasp.yml"].replace(old, new)
        session.change(interface, texts[interface])
        assert found(session, main) == fresh(main, texts) != []


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
    scopes = session.view(main).context.absorbed_flow.scopes  # type: ignore[union-attr]
    session.change(wait, texts[wait].replace("max: 2", "max: 3"))
    session.check(main)
    assert container(session, main, "FIRST") is part
    assert container(session, main, "LAST") is not grasp
    new = session.view(main).context.absorbed_flow.scopes  # type: ignore[union-attr]
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
    places = {item.span.start for one in session.check(main).values() for item in one}
    assert {at for at in range(len(ALIASED)) if ALIASED.startswith("-1", at)} <= places
    for _ in range(2):
        session.change(other, session.text(other).replace("1", "2") + "\n")
        assert found(session, main) == fresh(main, {other: session.text(other)})


PART = """\
- {name}:
    template: StateMachine
    outcomes: [done, bad]
    input_keys: [goal]
    transitions: {{done: {next}, bad: lost}}
    states:
    - PLAN:
        template: PoseToJointPositionsState
        remapping: {{pose: goal, joints: unread_{name}}}
        transitions: {{succeeded: WAIT, aborted: bad}}
    - WAIT: {{template: SleepState, time: 1.0, transitions: {{succeeded: done, preempted: bad}}}}
"""

ONE_FILE = (
    "name: sm\ntemplate: Base\noutcomes: [succeeded, lost]\ntypes: {Seconds: float}\n"
    "params: {seconds: 2.0}\nuserdata: {goal: [[0.5, 0.0, 0.1], [0.0, 0.0, 0.0, 1.0]]}\nstates:\n"
    + PART.format(name="FIRST", next="SECOND")
    + PART.format(name="SECOND", next="THIRD")
    + PART.format(name="THIRD", next="succeeded")
)

EDITS = [
    ("name: SECOND", "name: SECOND"),
    ("- SECOND:\n", "- SECOND:  # the middle one\n"),
    ("unread_SECOND", "joints_of_the_second"),
    ("done: THIRD", "done: THRID"),
    ("done: THRID", "done: [THIRD"),
    ("done: [THIRD", "done: THIRD"),
    ("outcomes: [succeeded, lost]\n", "outcomes: [succeeded, lost]\n# a note\n"),
    ("time: 1.0, transitions: {succeeded: done, preempted: bad}}\n- T", "time: [[seconds]]}\n- T"),
    ("{seconds: 2.0}", "{seconds: -2.0}"),
    ("{Seconds: float}", "{Seconds: int}"),
    ("- THIRD:", "- SECOND:"),
]


def test_edits_of_one_file_have_the_findings_of_a_fresh_check(tmp_path: Path) -> None:
    main = os.path.realpath(tmp_path / "main.yml")
    session, text = Session([tmp_path]), ONE_FILE
    for old, new in EDITS:
        text = text.replace(old, new, 1)
        session.change(main, text)
        assert found(session, main) == fresh(main, {main: text})


def test_a_state_of_an_edited_file_that_has_not_changed_keeps_its_node(tmp_path: Path) -> None:
    main = os.path.realpath(tmp_path / "main.yml")
    session = Session([tmp_path])
    session.change(main, ONE_FILE)
    session.check(main)
    first, second, third = (container(session, main, name) for name in ("FIRST", "SECOND", "THIRD"))
    place = third.children[0].span.start
    text = ONE_FILE.replace("unread_SECOND", "joints_of_the_second")
    session.change(main, text)
    assert found(session, main) == fresh(main, {main: text})
    assert container(session, main, "FIRST") is first
    assert container(session, main, "SECOND") is not second
    assert container(session, main, "THIRD") is third
    assert third.children[0].span.start == place + len("joints_of_the_second") - len(
        "unread_SECOND"
    )
    assert third.children[0].span.source is session.source(main)


ROW = "name: sm\ntemplate: Base\noutcomes: [done, bad]\nuserdata: {goal: 1.0}\nstates:\n" + "".join(
    f"- {name}:\n    template: PoseToJointPositionsState\n"
    f"    remapping: {{pose: goal, joints: joints_{name}}}\n"
    f"    transitions: {{succeeded: {after}, aborted: bad}}\n"
    for name, after in (("A", "B"), ("B", "C"), ("C", "done"))
)


def test_states_in_no_container_keep_their_nodes(tmp_path: Path) -> None:
    main = os.path.realpath(tmp_path / "main.yml")
    session = Session([tmp_path])
    session.change(main, ROW)
    session.check(main)
    kept = {node.name: node for node in session.machines(main)[0].root.children}
    for old, new in (("succeeded: B", "succeeded: C"), ("joints: joints_A", "joints: goal")):
        text = ROW.replace(old, new)
        session.change(main, text)
        assert found(session, main) == fresh(main, {main: text})
        first, *others = session.machines(main)[0].root.children
        assert first is not kept["A"]
        assert all(node is kept[node.name] for node in others)


NODE = """\
name: node
template: ROSBase
outcomes: [done, late]
params: {limit: 5.0}
states:
- A:
    template: SleepState
    time: 1.0
    timeout: [params, limit]
    transitions: {succeeded: B, preempted: late, timeout: late}
- B: {template: SleepState, time: 1.0, transitions: {succeeded: done, preempted: late}}
"""


def test_a_param_that_is_fixed_in_a_state_that_has_not_changed_is_found_again(
    tmp_path: Path,
) -> None:
    (tmp_path / "smachac.toml").write_text("ros = 2\n", "utf-8")
    main = os.path.realpath(tmp_path / "main.yml")
    session = Session([tmp_path])
    for time in ("1.0", "2.0", "3"):
        text = NODE.replace("time: 1.0, ", f"time: {time}, ")
        session.change(main, text)
        assert found(session, main) == fresh(main, {main: text})
        codes = [item.code for one in session.check(main).values() for item in one]
        assert "SM610" in codes, codes
