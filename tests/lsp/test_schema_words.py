"""Completion, hover and findings in the files that are no scripts."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from smachac.frontend.text.file_kinds import FileKind
from smachac.lsp.completion import complete
from smachac.lsp.facts import Facts
from smachac.lsp.hover import hover_at
from smachac.lsp.session import Session

INTERFACE = """\
name: Grasp
doc: Close the gripper.
kind: state
variables:
  force: {type: "float<N>", min: 0.0}
input_keys:
  pose: {type: Pose, role: goal_pose}
outcomes:
  succeeded: {}
  lost: {failure: true}
"""

SCENARIO = """\
states:
  sm/PICK: [succeeded, {outcome: aborted, wait: true}]
  sm/PLACE: {set: {pose: 1}, outcome: succeeded}
"""

PROJECT = """\
scripts = ["parts"]
ros = 2

[severity]
SM301 = "warning"
SM302 = "off"
"""

ROBOT = """\
name: arm
urdf: arm.urdf
arms:
  left:
    joints: [a, b]
    tool: {link: hand}
    home: [0.0, 1.0]
    gripper: {joints: {f: {open: 0.04}}, width: {open: 0.08, closed: 0.0}, force: 30.0}
    limits: [[-1, 1], [-1, 1]]
"""

STATION = """\
name: two
parts:
  near: {robot: panda}
"""

SCENE = """\
bodies:
  table: {model: table, frame: world}
  cap: {size: [0.1, 0.1, 0.02], mass: 0.1}
"""

FAULTS = """\
faults:
  - {kind: gripper_slips, state: LIFT, probability: 0.3, each_time: true}
"""

FILES: dict[FileKind, tuple[str, str]] = {
    "interface": ("templates/Grasp.yml", INTERFACE),
    "scenario": ("mock.yml", SCENARIO),
    "project": ("smachac.toml", PROJECT),
    "robot": ("arm.yml", ROBOT),
    "scene": ("table.yml", SCENE),
    "faults": ("faults.yml", FAULTS),
}


def opened(kind: FileKind, old: str, new: str, folder: Path) -> tuple[Session, str, str, int]:
    """A session with a file in which `new`, that has a `|`, replaces `old`; with the path, the text
    and the offset of `|`."""
    name, text = FILES[kind]
    assert old in text
    text = text.replace(old, new, 1)
    offset = text.index("|")
    text = text.replace("|", "", 1)
    path = os.path.realpath(folder / name)
    session = Session([folder])
    session.change(path, text)
    return session, path, text, offset


@pytest.mark.parametrize(
    ("kind", "old", "new", "words"),
    [
        ("interface", "doc: Close the gripper.", "|", ["doc", "claims", "blocking", "code"]),
        ("interface", "doc: Close", "do|: Close", ["doc"]),
        ("interface", "kind: state", "kind: |", ["state"]),
        ("interface", "{failure: true}", "{fai|}", ["failure", "doc"]),
        ("interface", "failure: true", "failure: |", ["true", "false"]),
        ("interface", "min: 0.0", "|", ["min", "max", "unit", "one_of", "names"]),
        ("interface", "type: Pose", "type: P|", ["Pose", "float", "bool"]),
        ("interface", "role: goal_pose", "role: |", ["goal_pose"]),
        ("interface", "lost: {failure: true}", "lost:\n    |", ["failure", "doc"]),
        ("scenario", "wait: true", "|", ["wait", "set", "error", "stop"]),
        ("scenario", "wait: true", "wait: |", ["true", "false"]),
        ("robot", "urdf: arm.urdf", "|", ["urdf", "base", "stand"]),
        ("robot", "joints: [a, b]", "|", ["joints", "efforts", "speeds"]),
        ("robot", "force: 30.0", "|", ["force", "pads", "anchored"]),
        ("robot", "force: 30.0", "anchored: |", ["true", "false"]),
        ("robot", "{open: 0.04}", "{|}", ["open", "closed"]),
        ("robot", "link: hand", "|", ["link", "offset"]),
        ("scene", "model: table", "model: |", ["table", "brick", "wall"]),
        ("scene", "mass: 0.1", "|", ["mass", "friction", "colour", "apart"]),
        ("faults", "each_time: true", "|", ["each_time", "at", "target", "value"]),
        ("faults", "gripper_slips", "|", ["move_body", "crash"]),
        ("project", "ros = 2", "|", ["ros", "templates", "code"]),
        ("project", 'SM301 = "warning"', "SM3|", ["SM301", "SM303"]),
        ("project", '"warning"', "|", ["error", "warning", "info", "off"]),
        ("project", '"warning"', '"w|"', ["error", "warning", "info", "off"]),
    ],
)
def test_words(kind: FileKind, old: str, new: str, words: list[str], tmp_path: Path) -> None:
    session, path, text, offset = opened(kind, old, new, tmp_path)
    view = session.view(path)
    assert view is not None
    assert view.kind == kind
    found = [item.word for item in complete(text, offset, path, view)]
    assert {*words} <= {*found}


@pytest.mark.parametrize(
    ("kind", "old", "new", "absent"),
    [
        ("interface", "doc: Close the gripper.", "|", ["name", "outcomes", "template"]),
        ("interface", "min: 0.0", "|", ["type", "callbacks"]),
        ("scenario", "wait: true", "|", ["outcome"]),
        ("project", "ros = 2", "|", ["scripts", "SM301"]),
        ("project", 'SM301 = "warning"', "|", ["SM302", "ros"]),
    ],
)
def test_what_is_there_or_elsewhere_is_not_offered(
    kind: FileKind, old: str, new: str, absent: list[str], tmp_path: Path
) -> None:
    session, path, text, offset = opened(kind, old, new, tmp_path)
    found = [item.word for item in complete(text, offset, path, session.view(path))]
    assert found
    assert not {*absent} & {*found}


def test_words_are_inserted_as_the_file_wants_them(tmp_path: Path) -> None:
    def inserted(kind: FileKind, old: str, new: str) -> set[str]:
        session, path, text, offset = opened(kind, old, new, tmp_path)
        return {item.text for item in complete(text, offset, path, session.view(path))}

    assert "doc: " in inserted("interface", "doc: Close the gripper.", "|")
    assert "templates = " in inserted("project", "ros = 2", "|")
    assert '"off"' in inserted("project", '"warning"', "|")
    assert "off" in inserted("project", '"warning"', '"|"')


@pytest.mark.parametrize(
    ("kind", "word", "parts"),
    [
        ("interface", "fail|ure", ["**failure**"]),
        ("interface", "ki|nd", ["**kind**", "`container`, `state`", "Default: `state`"]),
        ("interface", "goal_|pose", ["**role**", "`goal_pose`"]),
        ("scenario", "wa|it", ["**wait**"]),
        ("robot", "for|ce", ["**force**", "N m", "Default: `20.0`"]),
        ("robot", "lim|its", ["**limits**", "(rad)"]),
        ("scene", "fra|me", ["**frame**", "Default: `base`"]),
        ("scene", "mod|el", ["**model**", "`cafe_table`"]),
        ("faults", "ki|nd", ["**kind**", "`move_body`"]),
        ("project", "SM3|01", ["**SM301**", "read-before-write", "Default: `error`"]),
        ("project", "scri|pts", ["**scripts**"]),
    ],
)
def test_hover(kind: FileKind, word: str, parts: list[str], tmp_path: Path) -> None:
    plain = word.replace("|", "")
    session, path, _, offset = opened(kind, plain, word, tmp_path)
    view = session.view(path)
    assert view is not None
    found = hover_at(view, path, offset, Facts(view.library, path, {}))
    assert found is not None
    assert all(part in found[0] for part in parts), found[0]
    start = FILES[kind][1].index(plain)
    assert found[1:] == (start, start + len(plain))


@pytest.mark.parametrize(
    ("kind", "word"),
    [
        ("interface", "lo|st"),
        ("scenario", "PI|CK"),
        ("project", "par|ts"),
        ("robot", "le|ft"),
        ("scene", "ca|p"),
    ],
)
def test_names_of_the_user_have_no_meaning(kind: FileKind, word: str, tmp_path: Path) -> None:
    session, path, _, offset = opened(kind, word.replace("|", ""), word, tmp_path)
    view = session.view(path)
    assert view is not None
    found = hover_at(view, path, offset, Facts(view.library, path, {}))
    assert found is None


def test_findings_in_a_project_file(tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    session, path, _, _ = opened("project", "SM301", "SM999|", tmp_path)
    assert [item.code for item in session.check(path)[path]] == ["SM007"]


@pytest.mark.parametrize(
    ("kind", "old", "new", "message", "word"),
    [
        ("robot", "1.0]", "57]|", "robot: `b` is 57 rad, outside its limits -1 to 1", "57"),
        ("robot", "joints: [a", "joint: [a|", "robot: the key `joint` is unknown", "joint"),
        ("robot", "home:", "hom:|", "robot: the key `hom` is unknown", "hom"),
        ("scene", "model: table", "model: tabel|", "scene: there is no model `tabel`", "tabel"),
        ("scene", "frame: world", "frame: cap|",
         "scene: the frame `cap` is defined after `table`", "cap"),
        ("scene", "frame: world", "frame: lid|",
         "scene: there is no frame `lid` before `table` in the file", "lid"),
        ("faults", "0.3", "3|", "list of faults: a probability from 0 to 1 is expected, not 3",
         "3"),
    ],
)  # fmt: skip
def test_a_mistake_is_reported_in_its_file(
    kind: FileKind, old: str, new: str, message: str, word: str, tmp_path: Path
) -> None:
    session, path, text, _ = opened(kind, old, new, tmp_path)
    assert session.kind(path) == kind
    (found,) = session.check(path)[path]
    name = Path(path).name
    assert found.finding.message == in_file(name, message)
    assert found.finding.related == ()
    assert text[found.span.start : found.span.end].startswith(word)


@pytest.mark.parametrize("kind", ["robot", "scene", "faults"])
def test_a_file_of_data_without_mistakes_has_no_findings(kind: FileKind, tmp_path: Path) -> None:
    session, path, _, _ = opened(kind, "\n", "|\n", tmp_path)
    assert session.check(path) == {path: []}


def test_a_station_has_parts(tmp_path: Path) -> None:
    path = os.path.realpath(tmp_path / "two.yml")
    session = Session([tmp_path])
    session.change(path, STATION)
    assert (session.kind(path), session.check(path)) == ("robot", {path: []})
    session.change(path, STATION.replace("panda", "pandda"))
    (found,) = session.check(path)[path]
    assert found.finding.help == "did you mean `panda`?"


PYPROJECT = """\
[project]
name = "robot"

[tool.smachac]
ros = 2

[tool.ruff]
line-length = 100
"""


def at_mark(folder: Path, name: str, marked: str) -> tuple[Session, str, str, int]:
    """A session with a text whose `|` is the cursor; with the path, the text and the offset."""
    offset = marked.index("|")
    text = marked.replace("|", "", 1)
    path = os.path.realpath(folder / name)
    session = Session([folder])
    session.change(path, text)
    return session, path, text, offset


@pytest.mark.parametrize(
    ("name", "text", "words", "absent"),
    [
        ("smachac.toml", "severity = {|}", ["SM301"], ["scripts"]),
        ("smachac.toml", 'severity = {SM301 = "off", SM3|}', ["SM302"], ["SM301"]),
        ("smachac.toml", 'severity = {SM3|, SM301 = "off"}', ["SM302"], ["SM301"]),
        ("smachac.toml", 'severity = {SM301 = "off", SM302 = "|"}', ["warning"], ["SM301"]),
        ("smachac.toml", "severity = {SM301 = |", ["warning"], ["scripts"]),
        ("smachac.toml", "severity.SM3|", ["SM301"], ["scripts"]),
        ("smachac.toml", 'severity.SM301 = "off"\nseverity.SM3|', ["SM302"], ["SM301"]),
        ("smachac.toml", 'severity.SM301 = "|"', ["off"], ["SM301"]),
        ("pyproject.toml", PYPROJECT.replace("ros = 2", "s|"), ["scripts", "ros"], ["name"]),
        ("pyproject.toml", PYPROJECT.replace("ros = 2", "ros = 2\n|"), ["scripts"], ["ros"]),
        ("pyproject.toml", '[tool.smachac.severity]\nSM301 = "|"', ["off"], ["scripts"]),
        ("pyproject.toml", '[tool]\nsmachac.severity = {SM301 = "|"}', ["off"], ["scripts"]),
    ],
)
def test_words_of_project_files(
    name: str, text: str, words: list[str], absent: list[str], tmp_path: Path
) -> None:
    session, path, plain, offset = at_mark(tmp_path, name, text)
    found = {item.word for item in complete(plain, offset, path, session.view(path))}
    assert {*words} <= found
    assert not {*absent} & found


@pytest.mark.parametrize("old", ['name = "robot"', "line-length = 100", "[project]"])
def test_other_tables_of_a_pyproject_have_no_words(old: str, tmp_path: Path) -> None:
    marked = PYPROJECT.replace(old, f"{old[:3]}|{old[3:]}")
    session, path, text, offset = at_mark(tmp_path, "pyproject.toml", marked)
    view = session.view(path)
    assert view is not None
    assert complete(text, offset, path, view) == []
    assert hover_at(view, path, offset, Facts(view.library, path, {})) is None


@pytest.mark.parametrize(
    ("name", "text", "part"),
    [
        ("smachac.toml", 'severity = {SM3|01 = "off"}', "read-before-write"),
        ("smachac.toml", 'seve|rity = {SM301 = "off"}', "Severities by code"),
        ("smachac.toml", 'severity.SM3|01 = "off"', "read-before-write"),
        ("pyproject.toml", PYPROJECT.replace("ros", "r|os"), "The version of ROS"),
    ],
)
def test_hover_in_project_files(name: str, text: str, part: str, tmp_path: Path) -> None:
    session, path, _, offset = at_mark(tmp_path, name, text)
    view = session.view(path)
    assert view is not None
    found = hover_at(view, path, offset, Facts(view.library, path, {}))
    assert found is not None
    assert part in found[0]


def test_findings_in_a_pyproject(tmp_path: Path) -> None:
    wrong = PYPROJECT.replace("ros = 2", "rso| = 2")
    session, path, text, _ = at_mark(tmp_path, "pyproject.toml", wrong)
    (found,) = session.check(path)[path]
    assert (found.code, text[found.span.start : found.span.end]) == ("SM007", "rso")
    session.change(path, PYPROJECT.replace("[tool.smachac]", "[tool.other]"))
    assert session.check(path) == {path: []}


def in_file(name: str, fault: str) -> str:
    """The message on a fault with its kind of file, such as `scene: there is no frame`."""
    what, _, message = fault.partition(": ")
    return f"the {what} file `{name}` has a mistake: {message}"
