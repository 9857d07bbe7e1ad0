"""Documents of SCXML: their form, their names, and what is refused at its place."""

from __future__ import annotations

import re
import shutil
from pathlib import Path
from xml.etree import ElementTree

import pytest

import smachac
from smachac.commands.cli import main
from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.files import disk_library
from smachac.targets.scxml import document
from smachac.targets.scxml.document import functions, functions_in
from tests.scxml.scion import played

ROOT = Path(__file__).parents[2]
LIBRARY = disk_library(ROOT / "main.yml", [])
SPACE = "{http://www.w3.org/2005/07/scxml}"


def built(text: str, *, traced: bool = False) -> tuple[str, Report]:
    checked = analyse(Source("main.yml", text), LIBRARY, []).checked
    assert checked is not None
    report: Report = []
    return document(checked, report, traced=traced), report


def counter(code: str) -> str:
    return f"""\
name: sm
outcomes: [done]
userdata: {{n: 1, x: 0.5, s: a, xs: [1]}}
states:
  - COUNT:
      template: CallbacksState
      input_keys: [n, x, s, xs]
      output_keys: [n]
      callbacks: {{n: 'lambda ud: {code}'}}
      transitions: {{succeeded: done}}
"""


@pytest.mark.parametrize(
    "path", sorted(ROOT.glob("tests/cases/**/expected/scxml/*.scxml")), ids=str
)
def test_documents_are_valid(path: Path) -> None:
    """Every state that is named exists, once."""
    root = ElementTree.parse(path).getroot()
    states = [
        node
        for node in root.iter()
        if node.tag.removeprefix(SPACE) in ("state", "parallel", "final")
    ]
    ids = [node.attrib["id"] for node in states]
    assert len(ids) == len(set(ids))
    assert not [name for name in ids if not re.fullmatch(r"[A-Za-z_][\w-]*", name)]
    for node in [*root.iter(f"{SPACE}transition"), *states]:
        for name in ("target", "initial"):
            assert node.attrib.get(name, ids[0]) in ids
    for node in states:
        own = {child.attrib.get("id") for child in node}
        assert node.tag != f"{SPACE}state" or node.attrib.get("initial") in own | {None}
    data = [node.attrib["id"] for node in root.iter(f"{SPACE}data")]
    assert len(data) == len(set(data))


def test_a_document_has_only_the_functions_that_it_uses() -> None:
    text, report = built(counter("ud.n + 1"))
    assert report == []
    assert "function enter(" in text
    assert "function join(" not in text
    assert 'expr="sm.n + 1"' in text


def test_functions_call_only_known_ones() -> None:
    assert functions_in(["sorted(x)"]) == [functions()[name] for name in functions() if name in (
        "kind", "number", "equal", "less", "items", "sorted"
    )]  # fmt: skip


@pytest.mark.parametrize(
    ("code", "text"),
    [
        ("ud.n + 1", "sm.n + 1"),
        ("1 - ud.n", "1 - sm.n"),
        ("ud.n + ud.n", "whole(sm.n + sm.n)"),
        ("ud.n // 2", "floored(sm.n, 2)"),
        ("2 if ud.n < 3 else 4", "sm.n &lt; 3 ? 2 : 4"),
        ("2 if ud.x else 4", "truth(sm.x) ? 2 : 4"),
        ('2 if ud.s == "b" else 4', "sm.s === 'b' ? 2 : 4"),
        ("2 if not ud.xs else 4", "!truth(sm.xs) ? 2 : 4"),
        ("len(ud.xs)", "size(sm.xs)"),
        ("ud.xs[-1]", "item(sm.xs, -1)"),
        ("2 if ud.n in (1, 2) else 4", "contains(sm.n, [1, 2]) ? 2 : 4"),
        ("2 if ud.s is None else 4", None),
        ("[i for i in ud.xs]", None),
        ("len((1, ud.n) if ud.n else ud.xs)", None),
        ("len(str(ud.x))", None),
        ("ud.x ** 3", None),
        ("9007199254740993 + ud.n", None),
        ("len(range(3) if ud.n else ud.xs)", None),
    ],
)
def test_expressions(code: str, text: str | None) -> None:
    script = counter(code.replace('"', '""').replace('""', '"'))
    found, report = built(script)
    if text is None:
        assert [finding.code for finding in report] == ["SM601"]
        assert report[0].span.line == 9
    else:
        assert report == []
        assert f'location="sm.n" expr="{text}"' in found


REFUSED = """\
name: sm
outcomes: [done]
states:
  - GO:
      template: ScriptedState
      outcomes: [a.b]
      transitions: {a.b: done}
"""


def test_a_refusal_names_the_line() -> None:
    text, report = built(REFUSED)
    assert text == ""
    assert [(finding.code, finding.span.line) for finding in report] == [("SM601", 4)]


NAMES = """\
name: stop
outcomes: [done, fault]
userdata: {class: 1}
states:
  - error:
      template: StateMachine
      input_keys: [class]
      outcomes: [ok, failed]
      states:
        - stop: {template: ScriptedState, outcomes: [ok, failed]}
      transitions: {ok: Object, failed: fault}
  - Object:
      template: StateMachine
      outcomes: [next, halt]
      userdata: {userdata: 1}
      states:
        - userdata:
            template: CallbacksState
            input_keys: [userdata]
            output_keys: [userdata]
            callbacks: {userdata: 'lambda ud: ud.userdata + 1'}
            transitions: {succeeded: LAST}
        - LAST: {template: ScriptedState, outcomes: [next, halt]}
      transitions: {next: done, halt: done}
"""


def test_names_that_mean_something_else() -> None:
    text, report = built(NAMES)
    assert report == []
    ids = re.findall(r'<(?:state|final) id="([\w-]+)"', text)
    assert len(ids) == len(set(ids))
    assert not {"stop", "error"} & set(ids)
    data = re.findall(r'<data id="(\w+)"', text)
    assert len(data) == len(set(data))
    assert "Object" not in data


@pytest.mark.browser
def test_such_names_run() -> None:
    text, _ = built(NAMES, traced=True)
    case = {"document": 0, "inputs": {}, "stopped": False}
    (events,) = played([text], [case], scripted=False)
    assert events[-1]["event"] == "finish"


@pytest.mark.parametrize(
    ("missing", "words"),
    [
        ("node", "Node is not here"),
        pytest.param("scion", "SCION is not here", marks=pytest.mark.browser),
    ],
)
def test_verify_names_what_is_missing(
    missing: str,
    words: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    (tmp_path / "main.yml").write_text(counter("ud.n + 1"), "utf-8")
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("NODE_PATH", raising=False)
    if missing == "node":
        monkeypatch.setenv("PATH", str(tmp_path))
    elif shutil.which("node") is None:
        pytest.skip("node is not there: make test-browser")
    assert main(["verify", "main.yml", "--targets", "scxml"]) == 1
    assert words in capsys.readouterr().err


def test_the_option_is_checked() -> None:
    with pytest.raises(ValueError, match="`trace` must be true or false"):
        smachac.compile(ROOT / "examples/06_callbacks/main.yml", "scxml", options={"trace": "yes"})


BORDERS = """\
name: sm
outcomes: [done]
userdata: {x: 1, y: 2}
states:
  - INNER:
      template: StateMachine
      outcomes: [done]
      input_keys: [a, b]
      output_keys: [c, a, b]
      remapping: {a: x, b: x, c: y}
      userdata: {c: 3}
      states:
        - GO:
            template: CallbacksState
            input_keys: [a, b, c]
            output_keys: [a, b, c]
            callbacks: {a: 'lambda ud: ud.b + 1', b: 'lambda ud: ud.a', c: 'lambda ud: ud.c'}
            transitions: {succeeded: done}
"""


def test_keys_are_copied_in_the_order_of_the_script() -> None:
    """Of two outputs that are copied to one key, the last one counts."""
    text, report = built(BORDERS)
    assert report == []
    assert "copy(sm, INNER, {x: 'a'});" in text
    assert "copy(sm, INNER, {x: 'b'});" in text
    assert "copy(INNER, sm, {c: 'y', a: 'x', b: 'x'});" in text
