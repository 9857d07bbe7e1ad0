"""Edits of the script of a view: POST /edit, /undo and /types, and what they refuse."""

from __future__ import annotations

import json
import re
import subprocess
from argparse import Namespace
from collections.abc import Callable, Iterator
from http.client import HTTPConnection
from pathlib import Path
from typing import Any

import pytest

from smachac.commands.view import ViewedScript, edits_of_script
from smachac.view.edits import Edits
from smachac.view.feed import Feed
from smachac.view.picture import Picture
from smachac.view.server import HOST, TOKEN, ActionError
from tests.support.viewed import Viewed, starter

SCRIPT = """\
# The line.
name: sm
outcomes: [done, stopped]
states:
  - WAIT:  # for the arm
      template: SleepState
      time: 0.0
      transitions: {succeeded: LAST, preempted: stopped}  # and then

  # The end.
  - LAST:
      template: SleepState
      time: 0.0
      transitions:
        succeeded: done  # good
        preempted: stopped
"""

RENAME: dict[str, Any] = {"operation": "rename", "path": "sm/LAST", "arguments": {"new": "FINAL"}}
MOVE: dict[str, Any] = {
    "operation": "transition",
    "path": "sm/WAIT",
    "arguments": {"outcome": "succeeded", "target": "done"},
}
ADD: dict[str, Any] = {
    "operation": "add",
    "path": "sm",
    "arguments": {
        "name": "MORE",
        "type": "SleepState",
        "after": "WAIT",
        "transitions": {"succeeded": "LAST"},
    },
}
REMOVE: dict[str, Any] = {"operation": "remove", "path": "sm/LAST", "arguments": {}}
CONTAIN: dict[str, Any] = {
    "operation": "contain",
    "path": "sm/LAST",
    "arguments": {"name": "END", "type": "StateMachine", "states": ["sm/LAST"]},
}
EDITS = {"rename": RENAME, "move": MOVE, "add": ADD, "remove": REMOVE, "contain": CONTAIN}

RENAMED = SCRIPT.replace("LAST", "FINAL")


@pytest.fixture
def script(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    path = Path("main.yml")
    path.write_text(SCRIPT)
    return path


@pytest.fixture
def start() -> Iterator[Callable[..., Viewed]]:
    with starter() as start:
        yield start


@pytest.fixture
def view(script: Path, start: Callable[..., Viewed]) -> Viewed:
    return start("view", script, "--no-browser")


def edits_of(script: Path) -> Edits:
    picture = Picture(Feed(), script.stem, editable=True)
    return edits_of_script(
        ViewedScript(Namespace(script=script, scripts=[], templates=[]), picture)
    )


def applied(view: Viewed, edit: dict[str, Any], **more: object) -> Any:
    status, answer = view.post("/edit", {**edit, "apply": True, **more})
    assert status == 200, answer
    assert answer["applied"]
    return answer


def patched(diff: str, text: str) -> str:
    """A text after a patch, by the program `patch`."""
    Path("patched.yml").write_text(text)
    subprocess.run(["patch", "-s", "patched.yml"], input=diff, text=True, check=True)
    return Path("patched.yml").read_text()


def test_every_edit_is_previewed_written_as_shown_and_undone(script: Path, view: Viewed) -> None:
    for edit in EDITS.values():
        status, preview = view.post("/edit", edit)
        assert status == 200, preview
        assert script.read_text() == SCRIPT
        assert preview["files"] == ["main.yml"]
        assert preview["proof"].startswith("Proven: ")
        assert not preview["applied"]
        assert applied(view, edit, diff=preview["diff"])["diff"] == preview["diff"]
        after = script.read_text()
        assert after != SCRIPT
        assert after == patched(preview["diff"], SCRIPT)
        kept = ["# The line.", "# for the arm", "# and then"]
        assert [comment for comment in kept if comment not in after] == []
        assert view.post("/undo", {})[0] == 200
        assert script.read_text() == SCRIPT


def test_the_answer_has_the_machine_that_is_shown_from_then_on(view: Viewed) -> None:
    for edit in EDITS.values():
        written = applied(view, edit)["model"]
        assert model_in(view.page()) == written
        undone = view.post("/undo", {})[1]["model"]
        assert model_in(view.page()) == undone
        assert written["edges"] != undone["edges"]
        assert written["revision"] < undone["revision"]


def model_in(page: str) -> Any:
    """The model of a page."""
    found = re.search(r'<script[^>]*id="smachac-model"[^>]*>(.*?)</script>', page, re.DOTALL)
    assert found is not None
    return json.loads(found[1])


def test_edits_are_undone_in_reverse_order(script: Path, view: Viewed) -> None:
    applied(view, RENAME)
    assert script.read_text() == RENAMED
    applied(view, MOVE)
    assert script.read_text() == RENAMED.replace("succeeded: FINAL", "succeeded: done")
    assert view.post("/undo", {})[0] == 200
    assert script.read_text() == RENAMED
    status, answer = view.post("/undo", {})
    assert status == 200
    assert answer["files"] == ["main.yml"]
    assert patched(answer["diff"], RENAMED) == SCRIPT
    assert script.read_text() == SCRIPT
    assert view.post("/undo", {}) == (409, {"error": "there is nothing to undo"})


def test_line_ends_and_encoding_stay(script: Path, view: Viewed) -> None:
    before = b"\xef\xbb\xbf" + SCRIPT.replace("\n", "\r\n").encode()
    script.write_bytes(before)
    applied(view, RENAME)
    assert script.read_bytes() == b"\xef\xbb\xbf" + RENAMED.replace("\n", "\r\n").encode()
    assert view.post("/undo", {})[0] == 200
    assert script.read_bytes() == before


def test_findings_that_appear_and_disappear_are_shown(script: Path, view: Viewed) -> None:
    status, answer = view.post("/edit", MOVE)
    assert status == 200
    assert "`LAST`" in " ".join(each["message"] for each in answer["added"])
    assert answer["removed"] == []
    applied(view, MOVE)
    back = {**MOVE, "arguments": {"outcome": "succeeded", "target": "LAST"}}
    status, again = view.post("/edit", back)
    assert status == 200
    assert again["added"] == []
    messages = [each["message"] for each in answer["added"]]
    assert [each["message"] for each in again["removed"]] == messages


def test_a_foreign_change_is_not_overwritten(script: Path, view: Viewed) -> None:
    applied(view, RENAME)
    other = RENAMED.replace("# The line.", "# Another line.")
    script.write_text(other)
    status, answer = view.post("/undo", {})
    assert status == 409
    assert "main.yml was changed by another program in the meantime" in answer["error"]
    assert script.read_text() == other
    script.write_text(RENAMED)
    assert view.post("/undo", {})[0] == 200
    assert script.read_text() == SCRIPT


def test_an_edit_that_differs_from_its_preview_is_not_written(script: Path, view: Viewed) -> None:
    diff = view.post("/edit", RENAME)[1]["diff"]
    other = SCRIPT.replace("time: 0.0", "time: 1.0")
    script.write_text(other)
    status, answer = view.post("/edit", {**RENAME, "apply": True, "diff": diff})
    assert status == 409
    assert "changed since the preview" in answer["error"]
    assert script.read_text() == other
    assert view.post("/undo", {})[0] == 409


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ({}, "`operation` must be one of"),
        ({"operation": "write", "path": "/etc/passwd"}, "`operation` must be one of"),
        ({"operation": "rename", "path": 3, "arguments": {"new": "X"}}, "`path` must be a text"),
        ({"operation": "rename", "path": "sm/WAIT", "arguments": {}}, "missing or wrong"),
        ({"operation": "rename", "path": "sm/WAIT", "arguments": {"new": "LAST"}}, "LAST"),
        ({"operation": "rename", "path": "sm/NONE", "arguments": {"new": "X"}}, "no state"),
        ({**MOVE, "arguments": {"outcome": "succeeded", "target": "NONE"}}, "NONE"),
        ({**MOVE, "arguments": {"outcome": "won", "target": "LAST"}}, "no outcome `won`"),
        ({**ADD, "arguments": {"name": "LAST", "type": "SleepState"}}, "another state `LAST`"),
        ({**ADD, "arguments": {"name": "X", "type": "../../x"}}, "no state type"),
        ({**CONTAIN, "arguments": {**CONTAIN["arguments"], "states": [1]}}, "must be texts"),
        ({**CONTAIN, "arguments": {**CONTAIN["arguments"], "states": []}}, "of some states"),
        ({"operation": "remove", "path": "sm"}, "whole script"),
    ],
)
def test_what_cannot_be_done_is_refused(script: Path, body: dict[str, Any], words: str) -> None:
    edits = edits_of(script)
    with pytest.raises(ActionError, match=re.escape(words)):
        edits.edit({**body, "apply": True})
    assert script.read_text() == SCRIPT
    with pytest.raises(ActionError, match="nothing to undo"):
        edits.undo({})


def test_a_script_with_errors_is_not_renamed_but_can_be_repaired(script: Path) -> None:
    """A transition to nowhere: a rename proves nothing then, another target repairs it."""
    script.write_text(SCRIPT.replace("succeeded: LAST", "succeeded: NOWHERE"))
    edits = edits_of(script)
    with pytest.raises(ActionError, match=r"errors, which must be fixed first: main\.yml:8.*NOWH"):
        edits.edit({**RENAME, "apply": True})
    edits.edit({**MOVE, "arguments": {**MOVE["arguments"], "target": "LAST"}, "apply": True})
    assert script.read_text() == SCRIPT


def test_a_file_that_cannot_be_written_stays(script: Path) -> None:
    script.chmod(0o444)
    edits = edits_of(script)
    with pytest.raises(ActionError, match=r"nothing was written: main\.yml"):
        edits.edit({**RENAME, "apply": True})
    with pytest.raises(ActionError, match="nothing to undo"):
        edits.undo({})
    assert script.read_text() == SCRIPT


def test_an_edit_without_effect_writes_nothing(script: Path) -> None:
    edits = edits_of(script)
    same = {**RENAME, "arguments": {"new": "LAST"}, "apply": True}
    assert edits.edit(same)["diff"] == ""  # type: ignore[index]
    with pytest.raises(ActionError, match="nothing to undo"):
        edits.undo({})


def test_a_state_of_a_sub_script_is_edited_in_its_file(script: Path) -> None:
    script.write_text("name: sm\noutcomes: [done, stopped]\nstates:\n  - CALL: {script: sub}\n")
    sub = Path("sub.yml")
    inner = "".join(f"    {line}\n" if line else "\n" for line in SCRIPT.splitlines()[2:])
    sub.write_text(f"- SUB:\n    template: StateMachine\n{inner}")
    before = sub.read_text()
    edits = edits_of(script)
    edit = {"operation": "rename", "path": "sm/CALL/LAST", "arguments": {"new": "FINAL"}}
    assert edits.edit({**edit, "apply": True})["files"] == ["sub.yml"]  # type: ignore[index]
    assert sub.read_text() == before.replace("LAST", "FINAL")


def test_the_types_of_new_states_are_those_of_the_library(script: Path) -> None:
    Path("templates").mkdir()
    own = "kind: state\ndoc: My own.\noutcomes: {succeeded: }\n"
    Path("templates/OwnState.yml").write_text(own)
    types = edits_of(script).types({})["types"]  # type: ignore[index]
    docs = {each["name"]: each["doc"] for each in types}
    assert docs["OwnState"] == "My own."
    assert {"SleepState", "ScriptedState"} <= docs.keys()
    assert not {"StateMachine", "Concurrence", "Base"} & docs.keys()


FRAGMENTS = {
    "a helper class": ("{% block class_defs %}\nclass Part:\n    x = 1\n{% endblock %}\n", False),
    "macros": ("{% macro part(a) %}{{ a }}{% endmacro %}\n", False),
    "imports": ("{% block imports %}\nimport math\n{% endblock %}\n", False),
    "a class of a state": (
        "{% block class_defs %}\nclass Part(smach.State):\n    def execute(self, userdata):\n"
        "        return 'done'\n{% endblock %}\n",
        True,
    ),
    "a state": ("{% block body %}\nsmach.StateMachine.add('{{ name }}')\n{% endblock %}\n", True),
    "a state of another template": ('{% extends "SleepState.tpl.py" %}\n', True),
}


@pytest.mark.parametrize("kind", FRAGMENTS)
def test_a_template_that_makes_no_state_is_no_type_of_a_new_state(script: Path, kind: str) -> None:
    text, is_state = FRAGMENTS[kind]
    Path("templates").mkdir()
    Path("templates/Part.tpl.py").write_text(text)
    types = edits_of(script).types({})["types"]  # type: ignore[index]
    assert ("Part" in {each["name"] for each in types}) is is_state


def test_edits_need_the_token_and_the_own_origin(script: Path, view: Viewed) -> None:
    own, foreign = f"http://{HOST}:{view.port}", "http://evil.example"
    body = json.dumps({**RENAME, "apply": True})
    for path in ("/edit", "/undo", "/types"):
        for headers in (
            {},
            {TOKEN: "wrong"},
            {TOKEN: view.token, "Origin": foreign},
            {TOKEN: view.token, "Host": "evil.example"},
            {"Origin": own},
        ):
            connection = HTTPConnection(HOST, view.port, timeout=60)
            connection.request("POST", path, body, headers)
            with connection.getresponse() as answer:
                assert answer.status == 403
            connection.close()
    assert script.read_text() == SCRIPT


def test_only_the_view_of_a_script_is_editable(script: Path, start: Callable[..., Viewed]) -> None:
    trace = Path("run.jsonl")
    trace.write_text("")
    views = [
        start("view", script, "--attach", trace, "--no-browser"),
        start("run", script, "--view", "--view-paused", "-q"),
    ]
    for view in views:
        assert "editable" not in view.until(lambda each: each["kind"] == "model")["model"]
        assert view.post("/edit", {**RENAME, "apply": True})[0] == 404
        assert view.post("/undo", {})[0] == 404
    assert script.read_text() == SCRIPT


def test_the_picture_follows_an_edit(view: Viewed) -> None:
    assert view.message()["model"]["editable"]
    applied(view, RENAME)
    model = view.until(lambda each: each["kind"] == "model")["model"]
    assert [node["path"] for node in model["nodes"]] == ["sm", "sm/WAIT", "sm/FINAL"]


def test_the_picture_follows_an_edit_that_leaves_an_error(script: Path, view: Viewed) -> None:
    """A new state cannot be reached yet; the next edit lets a transition lead to it. Errors from
    elsewhere leave the picture as it is."""
    view.until(lambda each: each["kind"] == "report")
    applied(view, ADD)
    model = view.until(lambda each: each["kind"] == "model")["model"]
    assert "sm/MORE" in [node["path"] for node in model["nodes"]]
    report = view.until(lambda each: each["kind"] == "report")
    assert (report["broken"], report["outdated"]) == (True, False)
    applied(view, {**MOVE, "arguments": {"outcome": "succeeded", "target": "MORE"}})
    view.until(lambda each: each["kind"] == "report" and not each["broken"])
    script.write_text(script.read_text().replace("succeeded: MORE", "succeeded: NOWHERE"))
    report = view.until(lambda each: each["kind"] == "report" and each["broken"])
    assert report["outdated"]
