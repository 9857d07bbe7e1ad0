"""Edits of machines as data: laws over random projects, JSON, and undoing.

tests/refactorings/edit_* has what the texts look like.
"""

from __future__ import annotations

import random
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from smachac.commands.files import rewrite_files
from smachac.diff.comparison import Change, compare
from smachac.driver import Analysis, analyse_script
from smachac.ir.nodes import Concurrence, Container, Leaf, Machine, Node, StateMachine
from smachac.ir.traversal import outcome_names, walk
from smachac.refactor.edited_script import EditedScript, HasErrorsError
from smachac.refactor.editor import RefusedError
from smachac.refactor.locate import NotFoundError
from smachac.view.graphical_edit import BadEditError, Edit, EditResult, edit_of, perform
from tests.refactor.test_refactorings import comments, project, texts
from tests.support.examples import seeds

__all__ = ["project"]

SEEDS = seeds(1, 3, 10)
ROUNDS = 4
MAIN = Path("main.yml")


def edit(operation: str, path: str, **arguments: Any) -> EditResult:
    data = {"operation": operation, "path": path, "arguments": arguments}
    return perform(EditedScript(MAIN), edit_of(data))


def apply(result: EditResult) -> None:
    rewrite_files(result.texts, result.sources)


def differences(before: Analysis) -> tuple[Change, ...]:
    return compare(before, analyse_script(MAIN)).changes


def machine_of(analysis: Analysis) -> Machine:
    assert analysis.machine is not None
    return analysis.machine


def connected(whole: Machine) -> list[tuple[str, Node, StateMachine]]:
    """The states without sugar whose container is a state machine, with their paths."""
    found = dict(walk(whole.root))
    places = []
    for path, node in found.items():
        parent = found.get(path.rpartition("/")[0])
        if isinstance(parent, StateMachine) and not parent.sugar and not getattr(node, "sugar", ""):
            places.append((path, node, parent))
    return places


@pytest.mark.parametrize("project", SEEDS, indirect=True)
def test_a_transition_leads_elsewhere_and_back(project: random.Random) -> None:
    for _ in range(ROUNDS):
        before, files, remarks = analyse_script(MAIN), texts(), comments()
        path, node, parent = project.choice(connected(machine_of(before)))
        steps = [step for step in node.transitions if step.origin == "written"]
        if not steps:
            continue
        step = project.choice(steps)
        others = {*(child.name for child in parent.children), *outcome_names(parent)}
        target = project.choice(sorted(others - {step.target}))
        try:
            result = edit("transition", path, outcome=step.outcome, target=target)
        except RefusedError:
            assert step.target_span.text.strip("'\"") != step.target
            continue
        apply(result)
        found = differences(before)
        assert {(item.kind, item.what, item.name) for item in found} == {
            ("changed", "transition", step.outcome)
        }
        assert path in {item.path for item in found}
        assert comments() == remarks
        apply(edit("transition", path, outcome=step.outcome, target=step.target))
        assert texts() == files


@pytest.mark.parametrize("project", SEEDS, indirect=True)
def test_a_transition_is_removed_and_added(project: random.Random) -> None:
    for _ in range(ROUNDS):
        before, remarks = analyse_script(MAIN), comments()
        path, node, _ = project.choice(connected(machine_of(before)))
        steps = [step for step in node.transitions if step.origin == "written"]
        if not steps:
            continue
        step = project.choice(steps)
        apply(edit("transition", path, outcome=step.outcome))
        names = {(difference.what, difference.name) for difference in differences(before)}
        assert names <= {("transition", step.outcome), ("outcome", step.outcome)}
        apply(edit("transition", path, outcome=step.outcome, target=step.target))
        assert differences(before) == ()
        assert comments() == remarks


@pytest.mark.parametrize("project", SEEDS, indirect=True)
def test_a_state_is_added_and_removed(project: random.Random) -> None:
    for _ in range(ROUNDS):
        before, files = analyse_script(MAIN), texts()
        containers: list[tuple[str, Container]] = [
            (path, node)
            for path, node in walk(machine_of(before).root)
            if isinstance(node, StateMachine | Concurrence) and not node.sugar
        ]
        path, node = project.choice(containers)
        after = project.choice([child.name for child in node.children])
        apply(edit("add", path, name="ADDED", type="SleepState", after=after))
        found = differences(before)
        assert {(item.kind, item.what) for item in found} == {("added", "state")}
        assert f"{path}/ADDED" in {item.path for item in found}
        to = {"to": node.children[0].name} if isinstance(node, StateMachine) else {}
        apply(edit("remove", f"{path}/ADDED", **to))
        assert texts() == files


@pytest.mark.parametrize("project", SEEDS, indirect=True)
def test_what_led_to_a_removed_state_leads_on(project: random.Random) -> None:
    refused = 0
    for _ in range(ROUNDS):
        before, files = analyse_script(MAIN), texts()
        path, node, parent = project.choice(connected(machine_of(before)))
        others = [child.name for child in parent.children if child.name != node.name]
        if not others:
            continue
        to = project.choice(others)
        try:
            result = edit("remove", path, to=to)
        except RefusedError:
            refused += 1
            continue
        assert (
            result.undo.items()
            <= {str(Path(name).resolve()): text for name, text in files.items()}.items()
        )
        apply(result)
        found = differences(before)
        assert ("removed", path) in {(item.kind, item.path) for item in found}
        led = [item for item in found if item.what == "transition"]
        assert {(item.before, item.after) for item in led} <= {(node.name, to)}
        rewrite_files(result.undo, {path: source_of(text) for path, text in result.texts.items()})
        assert texts() == files
    assert refused < ROUNDS


def source_of(text: str) -> Any:
    from smachac.diagnostics.source import Source

    return Source("main.yml", text)


SCRIPT = """\
# The first line.
name: sm
template: Base
outcomes: [done, failed]
states:
  - PICK:  # picks
      template: ScriptedState
      outcomes: [ok, lost]
      transitions:
        ok: PLACE  # then place it
        lost: failed

  - PLACE: {template: ScriptedState, outcomes: [ok, lost], transitions: {ok: done, lost: PICK}}
"""


@pytest.fixture
def script(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    MAIN.write_text(SCRIPT)
    return MAIN


@pytest.mark.usefixtures("script")
def test_the_patch_and_the_findings() -> None:
    result = edit("transition", "PICK", outcome="ok", target="failed")
    assert result.diff == (
        "--- main.yml\n+++ main.yml\n@@ -7,7 +7,7 @@\n"
        "       template: ScriptedState\n       outcomes: [ok, lost]\n       transitions:\n"
        "-        ok: PLACE  # then place it\n+        ok: failed  # then place it\n"
        "         lost: failed\n \n"
        "   - PLACE: {template: ScriptedState, outcomes: [ok, lost],"
        " transitions: {ok: done, lost: PICK}}\n"
    )
    assert "SM201" in {item.code for item in result.findings_added}
    assert result.undo == {str(MAIN.resolve()): SCRIPT}
    assert MAIN.read_text() == SCRIPT
    apply(result)
    corrected = edit("transition", "PICK", outcome="ok", target="PLACE")
    assert "SM201" in {item.code for item in corrected.findings_removed}
    assert list(corrected.texts.values()) == [SCRIPT]


@pytest.mark.usefixtures("script")
def test_line_ends_and_a_byte_order_mark_stay() -> None:
    data = b"\xef\xbb\xbf" + SCRIPT.replace("\n", "\r\n").encode()
    MAIN.write_bytes(data)
    result = edit("transition", "PLACE", outcome="lost", target="failed")
    apply(result)
    assert MAIN.read_bytes() == data.replace(b"lost: PICK", b"lost: failed")


@pytest.mark.usefixtures("script")
def test_a_rename_and_a_container_are_edits_too() -> None:
    apply(edit("rename", "PICK", new="GRASP"))
    assert "- GRASP:  # picks" in MAIN.read_text()
    MAIN.write_text(
        SCRIPT.replace("- PLACE: {", "- PLACE: {").replace("lost: PICK", "lost: failed")
    )
    result = edit("contain", "", name="BOTH", type="StateMachine", states=["PICK"])
    assert "+  - BOTH:" in result.diff


@pytest.mark.usefixtures("script")
@pytest.mark.parametrize(
    ("words", "error"),
    [
        ({"operation": "transition", "path": "NO", "arguments": {"outcome": "ok"}}, NotFoundError),
        ({"operation": "transition", "path": "PICK", "arguments": {"outcome": "x"}}, NotFoundError),
        (
            {"operation": "transition", "path": "sm", "arguments": {"outcome": "done"}},
            RefusedError,
        ),
        (
            {"operation": "add", "path": "sm", "arguments": {"name": "PICK", "type": "SleepState"}},
            RefusedError,
        ),
        (
            {"operation": "add", "path": "sm", "arguments": {"name": "A", "type": "No"}},
            NotFoundError,
        ),
        ({"operation": "remove", "path": "PICK", "arguments": {"to": "done"}}, RefusedError),
        ({"operation": "remove", "path": "PICK", "arguments": {"to": "NO"}}, NotFoundError),
        ({"operation": "rename", "path": "PICK", "arguments": {"new": "a: b"}}, BadEditError),
        (
            {"operation": "contain", "arguments": {"name": "A", "type": "X", "states": ["PICK"]}},
            BadEditError,
        ),
    ],
)
def test_what_is_refused(words: dict[str, Any], error: type[Exception]) -> None:
    with pytest.raises(error):
        perform(EditedScript(MAIN), edit_of(words))
    assert MAIN.read_text() == SCRIPT


@pytest.mark.parametrize(
    "data",
    [
        None,
        [],
        {},
        {"operation": "burn"},
        {"operation": "rename", "path": 1, "arguments": {"new": "A"}},
        {"operation": "rename", "path": "A", "arguments": {}},
        {"operation": "rename", "path": "A", "arguments": {"new": 1}},
        {"operation": "rename", "path": "A", "arguments": {"new": "B", "old": "A"}},
        {"operation": "rename", "path": "A", "arguments": []},
        {"operation": "contain", "arguments": {"name": "A", "type": "X", "states": [1]}},
        {"operation": "add", "arguments": {"name": "A", "type": "B", "transitions": {"a": 1}}},
        {"operation": ["add"]},
    ],
)
def test_what_is_no_edit(data: object) -> None:
    with pytest.raises(BadEditError):
        edit_of(data)


def test_an_edit_is_data() -> None:
    data = {"operation": "transition", "path": "A", "arguments": {"outcome": "ok", "target": None}}
    assert edit_of(data) == Edit(
        operation="transition", path="A", arguments={"outcome": "ok", "target": None}
    )


@pytest.mark.usefixtures("script")
def test_a_script_that_cannot_be_read() -> None:
    MAIN.write_text("name: [")
    with pytest.raises(HasErrorsError):
        edit("transition", "PICK", outcome="ok", target="done")


@pytest.mark.usefixtures("script")
def test_a_new_state_between_two() -> None:
    apply(edit("add", "sm", name="WAIT", type="SleepState", after="PICK", on="ok"))
    whole = dict(walk(machine_of(analyse_script(MAIN)).root))
    assert {step.outcome: step.target for step in whole["sm/PICK"].transitions}["ok"] == "WAIT"
    led = {step.outcome: step.target for step in whole["sm/WAIT"].transitions}
    assert led == {"succeeded": "PLACE"}
    apply(edit("remove", "WAIT"))
    assert MAIN.read_text() == SCRIPT


ODD = {"on": "'on'", "a b": '"a b"', "größe": "größe"}


@pytest.mark.usefixtures("script")
@pytest.mark.parametrize("name", ODD)
def test_names_in_quotes(name: str) -> None:
    apply(edit("add", "sm", name=name, type="SleepState", variables={"time": 1.5}))
    apply(edit("transition", "PICK", outcome="ok", target=name))
    whole = machine_of(analyse_script(MAIN))
    states = dict(walk(whole.root))
    added = states[f"sm/{name}"]
    assert isinstance(added, Leaf)
    assert [variable.value.data for variable in added.variables] == [1.5]
    assert {step.outcome: step.target for step in states["sm/PICK"].transitions}["ok"] == name
    assert Counter(SCRIPT.splitlines()) - Counter(MAIN.read_text().splitlines()) == Counter(
        ["        ok: PLACE  # then place it"]
    )
