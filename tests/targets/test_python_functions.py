"""The functions of a generated Python program: which containers get one, and its parameters.

Whatever the functions, the program builds the same machine as a program that is one function.
"""

from __future__ import annotations

import ast
import contextlib
import io
import json
import random
import re
from collections.abc import Iterator
from pathlib import Path
from types import FunctionType, MethodType
from typing import Any

import pytest

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.driver import Analysis, analyse, build
from smachac.frontend.files import disk_library
from smachac.frontend.loader import memory_library
from smachac.targets.python import TARGET, functions, module
from tests.smacha.smacha_programs import machine_of

BUILT_IN = disk_library(Path("main.yml"), [])


def analysis_of(files: dict[str, str]) -> Analysis:
    library = memory_library(files, BUILT_IN)
    return analyse(Source("main.yml", files["main.yml"]), library, [])


def program(analysis: Analysis) -> str:
    """The Python program of a script."""
    report: Report = []
    assert analysis.checked is not None, analysis.report
    assert analysis.library is not None
    made = build(analysis.checked, TARGET, analysis.library, report)
    assert made, report
    ((_, text),) = made.items()
    return text


def in_one_function(analysis: Analysis, patch: pytest.MonkeyPatch) -> str:
    """The Python program of a script with as few functions as possible."""
    with patch.context() as patched:
        patched.setattr(module, "functions", functions.one_function)
        return program(analysis)


def outline_of(text: str) -> str:
    """All that the objects of a program's machine hold, as text."""
    with contextlib.redirect_stderr(io.StringIO()), contextlib.redirect_stdout(io.StringIO()):
        return "\n".join(lines_of(machine_of(text), "sm", []))


def lines_of(value: Any, path: str, around: list[object]) -> Iterator[str]:
    """A line for each value below an object; objects that are around it are not repeated."""
    match value:
        case _ if any(value is item for item in around):
            yield f"{path}: as above"
        case dict():
            for key in value:
                yield from lines_of(value[key], f"{path}[{key!r}]", [*around, value])
        case list() | tuple():
            for number, each in enumerate(value):
                yield from lines_of(each, f"{path}[{number}]", [*around, value])
        case FunctionType() | MethodType():
            yield f"{path}: {value.__name__}"
        case _ if hasattr(value, "__dict__"):
            yield f"{path}: {type(value).__name__}"
            for name in sorted(vars(value)):
                yield from lines_of(vars(value)[name], f"{path}.{name}", [*around, value])
        case _ if hasattr(value, "__slots__"):
            yield f"{path}: {type(value).__name__}"
            for name in value.__slots__:
                inner = getattr(value, name, None)
                yield from lines_of(inner, f"{path}.{name}", [*around, value])
        case _ if " at 0x" in repr(value):
            yield f"{path}: {type(value).__name__}"
        case _:
            yield f"{path}: {value!r}"


def functions_of(text: str) -> dict[str, ast.FunctionDef]:
    """The functions that build containers, by name."""
    tree = ast.parse(text)
    found = [statement for statement in tree.body if isinstance(statement, ast.FunctionDef)]
    return {item.name: item for item in found if item.name.startswith("build")}


def depth(node: ast.AST) -> int:
    """How deep blocks `with` are nested."""
    inner = max((depth(child) for child in ast.iter_child_nodes(node)), default=0)
    return inner + isinstance(node, ast.With)


def random_files(seed: int) -> dict[str, str]:
    """A script and sub-scripts that call one another, with params that they pass on."""
    draw = random.Random(seed)
    files = {}
    last = 3
    for number in range(last + 1):
        states = _states(draw, number, last, depth=0)
        body = {"outcomes": ["done"], "states": states, "userdata": {"x": _value(draw, number)}}
        if number == 0:
            files["main.yml"] = _text({"name": "sm", "template": "Base", **body})
        else:
            body |= {"template": "StateMachine", "params": {"p": 0, "q": "word"}}
            files[f"part_{number}.yml"] = _text([{f"PART_{number}": body}])
    return files


def _text(data: Any) -> str:
    """Data in the flow style of YAML, without quotes: in quotes, a look-up is text."""
    return json.dumps(data).replace('"', "")


def _value(draw: random.Random, number: int) -> Any:
    values: list[Any] = [1, "word", [1, 2], {"a": 1}]
    params = [["params", "p"], ["params", "q"]] if number else []
    return draw.choice([*values, *params, *params])


def _states(draw: random.Random, number: int, last: int, depth: int) -> list[dict[str, Any]]:
    names = [f"S{number}_{depth}_{place}" for place in range(draw.randint(1, 4))]
    states = []
    for name, target in zip(names, [*names[1:], "done"], strict=True):
        body: dict[str, Any] = {"transitions": {"done": target}}
        kind = draw.choice(["leaf", "call", "call", "box"])
        if kind == "call" and number < last:
            params = {word: _value(draw, number) for word in "pq" if draw.random() < 0.7}
            body |= {"script": f"part_{draw.randint(number + 1, last)}", "params": params}
        elif kind == "box" and depth < 4:
            inner = _states(draw, number, last, depth + 1)
            body |= {"template": "StateMachine", "outcomes": ["done"], "states": inner}
        else:
            steps = [{"outcome": "done", "set": {"n": _value(draw, number)}}]
            body |= {"template": "ScriptedState", "outcomes": ["done"], "steps": steps}
            body["output_keys"] = ["n"]
        if draw.random() < 0.2:
            body["retry"] = {"on": ["error"], "max": draw.randint(2, 3)}
            body["transitions"] |= {"exhausted": "done", "preempted": "done"}
        states.append({name: body})
    return states


@pytest.mark.parametrize("seed", range(25))
def test_random_scripts_build_the_same_machine(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    analysis = analysis_of(random_files(seed))
    text = program(analysis)
    assert all(depth(item) <= functions.MOST_NESTED for item in functions_of(text).values())
    assert outline_of(text) == outline_of(in_one_function(analysis, monkeypatch))


@pytest.mark.slow
def test_random_scripts_share_functions() -> None:
    """The test above would not fail if there were none."""
    texts = [program(analysis_of(random_files(seed))) for seed in range(25)]
    found = [item for text in texts for item in functions_of(text).values()]
    assert sum(bool(item.args.args) for item in found) > 20
    passed_on = [text for text in texts if re.search(r"build_\w+\([^)]*(\w+)=\1\b", text)]
    assert len(passed_on) > 1


BOXED = "{template: StateMachine, outcomes: [done], transitions: {done: done}, states: [%s]}"
LEAF = "{template: ScriptedState, outcomes: [done], transitions: {done: %s}}"


def chain(names: list[str], end: str = "done") -> str:
    """States in a row, as flow style."""
    targets = [*names[1:], end]
    return ", ".join(f"{name}: {LEAF % to}" for name, to in zip(names, targets, strict=True))


def nested(levels: int) -> str:
    text = "A: " + LEAF % "done"
    for level in range(levels):
        text = f"C{level}: {BOXED % text}"
    return f"name: sm\ntemplate: Base\noutcomes: [done]\nstates: [{text}]\n"


@pytest.mark.parametrize("levels", [1, 2, 3, 7, 30])
def test_containers_are_nested_three_deep_at_most(
    levels: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    analysis = analysis_of({"main.yml": nested(levels)})
    text = program(analysis)
    found = functions_of(text)
    assert max(map(depth, found.values())) == min(levels + 1, 3)
    assert len(found) == 1 + levels // 3
    assert outline_of(text) == outline_of(in_one_function(analysis, monkeypatch))


@pytest.mark.parametrize(("states", "count"), [(8, 1), (9, 2)])
def test_a_large_container_is_a_function(states: int, count: int) -> None:
    inside = chain([f"S{number}" for number in range(states)])
    box = f"BOX: {BOXED % inside}"
    text = program(
        analysis_of({"main.yml": f"name: sm\ntemplate: Base\noutcomes: [done]\nstates: [{box}]\n"})
    )
    assert len(functions_of(text)) == count


PART = """\
- PART:
    template: StateMachine
    outcomes: [done]
    params: {%s}
    userdata: {%s}
    states:
      - A: {template: ScriptedState, outcomes: [done], steps: %s, transitions: {done: B}}
      - B: {template: ScriptedState, outcomes: [done], steps: %s, transitions: {done: done}}
"""


def calls(part: str, *params: str) -> dict[str, str]:
    """A script that calls `part.yml` once with each params."""
    names = [f"CALL_{number}" for number in range(len(params))]
    lines = [
        f"  - {name}: {{script: part, params: {{{given}}}, transitions: {{done: {to}}}}}"
        for name, given, to in zip(names, params, [*names[1:], "done"], strict=True)
    ]
    head = "name: sm\ntemplate: Base\noutcomes: [done]\nstates:\n"
    return {"main.yml": head + "\n".join(lines) + "\n", "part.yml": part}


STEP = "[{outcome: done, set: {n: [params, %s]}}]"


def heads(text: str) -> list[str]:
    """The functions with their parameters."""
    return [
        f"{item.name}({', '.join(arg.arg for arg in item.args.args)})"
        for item in functions_of(text).values()
    ]


@pytest.mark.parametrize(
    ("params", "userdata", "given", "expected"),
    [
        # Nothing differs.
        ("a: 1", "x: [params, a]", ["", ""], ["build()", "build_part()"]),
        # A value is a parameter with the name of its key.
        ("a: 1", "x: [params, a], y: 2", ["a: 3", "a: 4"], ["build()", "build_part(x)"]),
        # Equal scalars are one parameter, lists are not.
        ("a: 1", "x: [params, a], y: [params, a]", ["a: 3", "a: 4"], ["build()", "build_part(x)"]),
        (
            "a: 1",
            "x: [params, a], y: [params, a]",
            ["a: [3]", "a: [4]"],
            ["build()", "build_part(x, y)"],
        ),
        # 1, 1.0 and true are different values.
        ("a: 1", "x: [params, a]", ["a: 1", "a: 1.0", "a: true"], ["build()", "build_part(x)"]),
        # Names that a variable cannot have.
        ("a: 1", "smach: [params, a]", ["a: 1", "a: 2"], ["build()", "build_part(value_1)"]),
        ("a: 1", "X: [params, a]", ["a: 1", "a: 2"], ["build()", "build_part(x)"]),
    ],
)  # fmt: skip
def test_calls_of_a_sub_script(
    params: str,
    userdata: str,
    given: list[str],
    expected: list[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    steps = "[{outcome: done}]"
    analysis = analysis_of(calls(PART % (params, userdata, steps, steps), *given))
    text = program(analysis)
    assert heads(text) == expected
    assert outline_of(text) == outline_of(in_one_function(analysis, monkeypatch))


def test_lists_of_a_shared_function_are_never_one_object() -> None:
    steps = "[{outcome: done}]"
    part = PART % ("a: 1", "x: [params, a], y: [params, a]", steps, steps)
    root = machine_of(program(analysis_of(calls(part, "a: [1]", "a: [2]"))))
    for child in root.get_children().values():
        assert child.userdata.x == child.userdata.y
        assert child.userdata.x is not child.userdata.y


def test_calls_with_many_differences_have_a_function_each() -> None:
    names = "abcdef"
    params = ", ".join(f"{name}: 0" for name in names)
    userdata = ", ".join(f"u{name}: [params, {name}]" for name in names)
    steps = "[{outcome: done}]"
    given = [", ".join(f"{name}: {k}{ord(name)}" for name in names) for k in (1, 2)]
    text = program(analysis_of(calls(PART % (params, userdata, steps, steps), *given)))
    assert heads(text) == ["build()", "build_part()", "build_part_2()"]


INNER = """\
- INNER:
    template: StateMachine
    outcomes: [done]
    params: {word: x}
    userdata: {deep: [params, word]}
    states:
      - S: {template: ScriptedState, outcomes: [done], steps: [{outcome: done}], transitions: {done: done}}
"""  # noqa: E501

OUTER = """\
- OUTER:
    template: StateMachine
    outcomes: [done]
    params: {given: x}
    userdata: {top: 1}
    states:
      - ONE: {script: inner, params: {word: [params, given]}, transitions: {done: TWO}}
      - TWO: {script: inner, params: {word: always}, transitions: {done: LOOP}}
      - LOOP: {script: inner, params: {word: [params, given]}, retry: {on: [error], max: 2},
               transitions: {done: done, exhausted: done, preempted: done}}
"""


def test_parameters_are_passed_on_to_inner_sub_scripts(monkeypatch: pytest.MonkeyPatch) -> None:
    files = calls(OUTER, "given: left", "given: right")
    files["main.yml"] = files["main.yml"].replace("script: part, params", "script: outer, params")
    files = {**files, "outer.yml": OUTER, "inner.yml": INNER}
    analysis = analysis_of(files)
    text = program(analysis)
    expected = ["build()", "build_outer(deep)", "build_inner(deep)", "build_inner_2(deep)"]
    assert heads(text) == expected  # the last one is tried again after an error: one more outcome
    assert "build_inner(deep=deep)" in text
    assert 'build_inner(deep="always")' in text
    assert outline_of(text) == outline_of(in_one_function(analysis, monkeypatch))


def test_a_container_in_a_shared_function_takes_its_parameters(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    inside = LEAF.replace("outcomes", "steps: %s, output_keys: [n], outcomes") % ("%s", "done")
    text = "S: " + inside % "[{outcome: done, set: {n: [params, a]}}]"
    for level in range(5):
        text = f"C{level}: {BOXED % text}"
    part = f"- PART: {BOXED.replace('outcomes', 'params: {a: 1}, outcomes', 1) % text}\n"
    analysis = analysis_of(calls(part, "a: 1", "a: 2"))
    found = program(analysis)
    assert heads(found) == ["build()", "build_part(steps)", "build_c2(steps)"]
    assert outline_of(found) == outline_of(in_one_function(analysis, monkeypatch))


BODY = "smach.{{ parent_type }}.add('{{ name }}', T(), transitions={'done': '%s'})"
CLASS = """\
{%% extends "State.tpl.py" %%}
{%% block class_defs %%}
class T(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=['done'])
{%% endblock %%}
{%% block %s %%}
%s
{%% endblock %%}
"""
BOX = """\
name: sm
template: Base
outcomes: [done]
states:
  - PICK: {script: pick, transitions: {done: done}}
"""
PICK = "- X: {template: StateMachine, outcomes: [done], states: [A: {template: T, outcomes: [done], transitions: {done: done}}]}\n"  # noqa: E501


@pytest.mark.parametrize(
    ("block", "text", "expected"),
    [
        ("body", BODY % "done", ["build()", "build_pick()"]),
        # Its code uses the variable of an outer container.
        ("body", "sm.userdata.seen = 1\n" + BODY % "done", ["build()"]),
        # Its definition has the name of the function.
        ("defs", "def build_pick():\n    return 1", ["build_pick()", "build()"]),
        ("imports", "from os import getcwd as build_pick", ["build()"]),
        # Its code in the main function is for all states.
        ("main_def", "tool = 'gripper'", ["build()"]),
        ("footer", "print('end')", []),
    ],
)
def test_code_of_templates_finds_the_names_that_it_uses(
    block: str, text: str, expected: list[str]
) -> None:
    files = {"main.yml": BOX, "pick.yml": PICK, "templates/T.tpl.py": CLASS % (block, text)}
    if block != "body":
        files["templates/T.tpl.py"] += "{% block body %}" + BODY % "done" + "{% endblock %}"
    found = program(analysis_of(files))
    assert heads(found) == expected
    outline_of(found)


OWN_BASE = """\
{% block imports %}
import smach
{% endblock %}
{% block class_defs %}{{ class_defs }}{% endblock %}
{% block main_def %}
def main():
    sm = smach.StateMachine(outcomes=['done'])
    with sm:
        {{ body | indent(8) }}
    return sm.execute()
{% endblock %}
"""


def test_a_base_of_the_user_without_functions_gets_all_states_in_one() -> None:
    files = {"main.yml": BOX.replace("Base", "Own"), "pick.yml": PICK}
    files["pick.yml"] = PICK.replace("template: T", "template: ScriptedState")
    files["templates/Own.tpl.py"] = OWN_BASE
    found = program(analysis_of(files))
    assert "build_" not in found
    outline_of(found)


def test_variables_are_named_after_their_containers_as_smacha_named_them() -> None:
    """A template may print the name of the variable itself."""
    body = "sm_{{ parent_name | lower }}.userdata.seen = 1\n" + BODY % "done"
    text = CLASS % ("body", body)
    files = {"main.yml": BOX.replace("PICK:", "TAKE:"), "pick.yml": PICK}
    found = program(analysis_of({**files, "templates/T.tpl.py": text}))
    assert heads(found) == ["build()", "build_pick()"]
    assert "    sm_take.userdata.seen = 1\n" in found
    outline_of(found)
