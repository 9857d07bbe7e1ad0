"""Hostile text in a script stays text: in no generated program does it become code."""

from __future__ import annotations

import ast
import json
import re
from pathlib import Path

import pytest

import smachac.stdlib
from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.driver import analyse, build
from smachac.frontend.files import disk_library
from smachac.frontend.loader import Library
from smachac.frontend.types.state_types import find_state_type
from smachac.ir.nodes import Checked
from smachac.targets import load_target
from smachac.targets.cpp.builtin_states import is_built_in

HOSTILE = (
    "x), evil(",
    "x, evil()",
    'x"), evil("',
    "x'), evil('",
    'x"""\nevil()\n"""',
    "x\nevil()",
    "x; evil()",
    "x import *; evil()",
    "lambda a: 1, evil()",
    "x\\",
    "a=1, b=evil()",
)

VALUES = {
    "service": "std_srvs/Trigger",
    "msg_type": "std_msgs/String",
    "time": 1,
    "command": "open",
    "cond_cb": "lambda *given: True",
}

QUICK = {"Base", "CallbacksState", "GripperState", "SleepState", "WriteCSVFileState"}
TYPES = [
    pytest.param(name, marks=() if name in QUICK else pytest.mark.slow)
    for name in sorted(path.stem for path in Path(smachac.stdlib.__path__[0]).glob("*.yml"))
]

FRONTEND = re.compile(r"SM0\d\d")
"""Codes of findings that refuse a script before anything is printed."""

CPP_TOKEN = re.compile(
    r'//[^\n]*(?:\\\n[^\n]*)*|/\*.*?\*/|"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)*\'|\w+|\s+|.', re.S
)


def is_expression(text: str) -> bool:
    try:
        ast.parse(text, mode="eval")
    except SyntaxError:
        return False
    return True


def library_of(folder: Path) -> Library:
    return disk_library(folder / "main.yml", [])


def programs(
    text: str,
    folder: Path,
    name: str = "main.yml",
    targets: tuple[str, ...] = ("python", "cpp", "dot"),
) -> dict[str, str] | None:
    """The programs and the graph of a script; None where the front end refuses it. Other findings
    are passed over."""
    library = library_of(folder)
    analysis = analyse(Source(name, text), library, [])
    if any(
        item.severity.name == "ERROR" and FRONTEND.fullmatch(item.code) for item in analysis.report
    ):
        return None
    assert analysis.machine is not None
    files: dict[str, str] = {}
    for target in targets:
        loaded = load_target(target)
        assert loaded is not None
        report: Report = []
        files |= build(Checked(analysis.machine), loaded, library, report) or {}
    return files


def assert_harmless(files: dict[str, str]) -> None:
    for name, text in files.items():
        if name.endswith(".py"):
            names = {
                getattr(node, field, "")
                for node in ast.walk(ast.parse(text))
                for field in ("id", "attr", "name", "arg")
            }
            assert "evil" not in names, [line for line in text.splitlines() if "evil" in line]
        elif name.endswith((".hpp", ".cpp")):
            tokens = CPP_TOKEN.findall(text)
            assert "evil" not in tokens, [line for line in text.splitlines() if "evil" in line]
            assert not any("\\\n" in token for token in tokens if token.startswith("//"))


def script(type_: str, variables: dict[str, object]) -> str:
    interface = find_state_type(type_, library_of(Path()), [])
    assert interface is not None
    base = type_ if interface.kind == "base" else "Base"
    state: dict[str, object] = {"template": "SleepState" if base == type_ else type_}
    if base == type_:
        variables = {"time": 1, **variables}
    else:
        for name, variable in interface.variables.items():
            if variable.required:
                default = "actionlib/TestAction" if type_ == "SimpleActionState" else "start"
                state[name] = VALUES.get(name, default if name == "action" else "word")
    if "outcomes" in interface.given:
        state["outcomes"] = ["succeeded"]
    outcomes = [outcome.name for outcome in interface.outcomes] or ["succeeded"]
    state["transitions"] = dict.fromkeys(outcomes, "done")
    root = {"name": "sm", "template": base, "outcomes": ["done"]}
    if base == type_:
        state["time"] = variables.pop("time")
        root |= variables  # type: ignore[arg-type]
        variables = {}
    return json.dumps({**root, "states": [{"A": {**state, **variables}}]})


@pytest.mark.parametrize("type_", TYPES)
def test_no_variable_of_a_state_type_becomes_code(type_: str, tmp_path: Path) -> None:
    interface = find_state_type(type_, library_of(tmp_path), [])
    assert interface is not None
    assert programs(script(type_, {}), tmp_path) is not None, "the script itself is right"
    targets = ("python", "cpp") if is_built_in(interface) or interface.classes else ("python",)
    names = [*interface.variables]
    names += ["function_name", "node_name"] if interface.kind == "base" else ["doc", "x = 1, y"]
    for name in names:
        for text in HOSTILE:
            if name == "callbacks" and is_expression(text):
                continue  # it is code there
            value: object = {"n": text} if name == "callbacks" else text
            files = programs(script(type_, {name: value}), tmp_path, targets=targets)
            if files is not None:
                assert_harmless(files)


@pytest.mark.parametrize("text", HOSTILE)
def test_no_name_of_a_script_becomes_code(text: str, tmp_path: Path) -> None:
    deep: dict[str, object] = {
        "template": "SleepState",
        "time": 1,
        "transitions": {"succeeded": text},
    }
    for _ in range(13):
        deep = {
            "template": "StateMachine", "outcomes": [text], "states": [{text: deep}], "doc": text,
            "userdata": {text: text}, "transitions": {text: text},
        }  # fmt: skip
    whole = {"name": text, "template": "Base", "outcomes": [text], "states": [{f"A{text}": deep}]}
    files = programs(json.dumps({**whole, "doc": f"{text}\n{text}"}), tmp_path)
    if files is not None:
        assert_harmless(files)


@pytest.mark.parametrize("text", HOSTILE)
def test_no_name_of_a_file_becomes_code(text: str, tmp_path: Path) -> None:
    files = programs(script("SleepState", {}), tmp_path, f"{text}.yml")
    assert files is not None
    assert len(files) >= 3
    assert_harmless(files)
    for name, printed in files.items():
        if name.endswith(".dot"):
            assert not any(line.startswith("evil") for line in printed.splitlines())


@pytest.mark.parametrize(
    "line",
    [
        "variables: {'*': {}, 'a=1, b': {default: 1}}",
        "variables: {class: {default: 1}}",
        "code: {cpp: {header: 'a.hpp\"\\n#include \"b', class: A}}",
        "code: {cpp: {header: a.hpp, class: 'A; int evil'}}",
        "code: {cpp: {header: a.hpp, class: A, with: 'int a = evil()'}}",
        "code: {python: 'a:b, evil()'}",
    ],
)
def test_an_interface_that_would_print_code_is_refused(line: str, tmp_path: Path) -> None:
    (tmp_path / "templates").mkdir()
    (tmp_path / "templates" / "Own.yml").write_text(f"outcomes: {{done: {{}}}}\n{line}\n")
    report: Report = []
    find_state_type("Own", library_of(tmp_path), report)
    assert [found.code for found in report] == ["SM004"]


def test_shapes_that_programs_have_are_accepted(tmp_path: Path) -> None:
    given: dict[str, dict[str, object]] = {
        "ServiceState": {"service": "std_srvs.srv.Trigger", "request_cb": "`lambda u, r: r`"},
        "SimpleActionState": {
            "action": "actionlib.TestAction",
            "goal_cb": "ast.dump",
            "result_cb": "print(1)",
        },
        "WaitForMsgState": {"msg_type": "std_msgs/msg/String", "msg_cb": None},
        "Base": {"function_name": "run_robot"},
    }
    for type_, variables in given.items():
        assert programs(script(type_, dict(variables)), tmp_path) is not None, type_
    (tmp_path / "templates").mkdir(exist_ok=True)
    for code in (
        "class: 'a::B<int>', with: 'const a::B<c::D> &arm'",
        "class: '::B', with: 'a::B *b'",
    ):
        text = f"outcomes: {{done: {{}}}}\ncode: {{cpp: {{header: ../a-b/c.hpp, {code}}}}}\n"
        (tmp_path / "templates" / "Own.yml").write_text(text)
        report: Report = []
        find_state_type("Own", library_of(tmp_path), report)
        assert report == [], code


@pytest.mark.parametrize(
    "code", ["`(yield)`", "`lambda ud: (yield)`", "`lambda ud: (yield from ud)`"]
)
def test_a_generator_is_no_expression(code: str, tmp_path: Path) -> None:
    assert programs(script("SleepState", {"time": code}), tmp_path) is None
