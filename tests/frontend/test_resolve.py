"""Resolved scripts: each field is read once, with its span; lowering needs nothing else."""

from __future__ import annotations

import ast
import typing
from collections.abc import Iterator
from pathlib import Path

import pytest

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source, Word
from smachac.driver import read_machine
from smachac.frontend import schema
from smachac.frontend.files import disk_library
from smachac.frontend.resolved_script import Script, State
from smachac.frontend.script import resolve as resolve_module
from smachac.frontend.script.lower import lower
from smachac.frontend.script.resolve import resolve
from smachac.frontend.text.fields import READERS
from smachac.frontend.text.yaml_tree import parse
from smachac.frontend.types.state_types import find_state_type
from smachac.ir.nodes import Value
from smachac.ir.traversal import walk

ROOT = Path(__file__).parents[2]
LIBRARY = disk_library(ROOT / "main.yml", [])

SCRIPT = """\
name: tour
template: Base
outcomes: [done, lost]
input_keys: {goal: Pose}
userdata: {count: 3, pose: {type: Pose, value: home}}
robot: panda
states:
  - WORK:
      template: ScriptedState
      outcomes: [succeeded, aborted]
      output_keys: [result]
      transitions: {succeeded: BOTH, aborted: lost}
      remapping: {result: count}
      claims: [arm]
      timeout: 20s
      retry: {on: [aborted], max: 3}
      for_each: {item: one, in: [a, 2], on: [succeeded]}
  - BOTH:
      template: Concurrence
      outcomes: [done]
      default_outcome: done
      outcome_map: {done: {LEFT: ended}}
      states:
        - LEFT: {template: ScriptedState, outcomes: [ended]}
"""


def resolved(text: str) -> tuple[Script, Report]:
    report: Report = []
    source = Source("main.yml", text)
    script = resolve(source, parse(source, report), LIBRARY, report)
    assert script is not None
    return script, report


def test_typed_fields_keep_their_spans() -> None:
    script, _ = resolved(SCRIPT)
    base, (work, both) = script.base, script.base.states
    pairs = [*work.transitions, *work.remapping]
    words = [word for pair in pairs for word in pair]
    words += [base.name, work.name, *work.claims]
    words += [Word(item.name, item.span) for item in (*base.outcomes, *work.outcomes)]
    words += [word for word, _ in (*base.input_keys, *work.output_keys)]
    for outcome, conditions in both.outcome_map:
        words += [outcome, *(word for pair in conditions for word in pair)]
    assert base.robot is not None
    assert both.default_outcome is not None
    words += [base.robot, both.default_outcome]
    assert work.sugar.retry is not None
    assert work.sugar.for_each is not None
    words += [*work.sugar.retry.on, *work.sugar.for_each.on]
    assert len(words) == 22
    assert [word.span.text for word in words] == [word.text for word in words]
    assert [item.span.text for item in base.userdata] == ["count", "pose"]
    assert [item.value.span.text for item in base.userdata] == ["3", "home"]
    assert work.sugar.for_each.items.span.text == "[a, 2]"
    assert work.sugar.timeout is not None
    assert work.sugar.timeout.span.text == "timeout"


def test_what_cannot_be_read_is_reported_once() -> None:
    text = SCRIPT.replace("claims: [arm]", "claims: [arm, arm]").replace("{count: 3", "{on: 3")
    text = text.replace("in: [a, 2]", "in: [a, 2], by: 2").replace("robot: panda", "robot: [x]")
    _, report = resolved(text)
    faults = sorted((item.span.line, item.code) for item in report)
    assert faults == [(5, "SM004"), (6, "SM004"), (14, "SM002"), (17, "SM003")]


def test_a_param_that_is_given_twice_is_reported() -> None:
    text = SCRIPT.replace("robot: panda", "params: {kind: 1, kind: 2}")
    _, report = resolved(text.replace("count: 3", "count: [[params, kind]]"))
    assert [(item.span.line, item.code) for item in report] == [(6, "SM002")]


@pytest.mark.parametrize("type_", ["0.0", "3", "true", "[float]", "null"])
def test_the_type_of_an_initial_value_is_a_text(type_: str) -> None:
    """Without the finding, data with these fields would lose them in silence."""
    data = f"{{type: {type_}, value: 1}}"
    _, report = resolved(SCRIPT.replace("{type: Pose, value: home}", data))
    (item,) = [item for item in report if item.code == "SM004"]
    assert item.span.text == type_
    assert item.finding.help is not None
    assert f"`pose: {{value: {data}}}`" in item.finding.help


def test_readers_return_what_states_hold() -> None:
    held = typing.get_type_hints(State)
    assert held.pop("name") == Word  # a script without a name has a default one
    assert held.pop("it") == Value | None  # its reader has no annotations
    for name in sorted(set(held) & set(schema.VARIABLES) - {"states"}):
        given = typing.get_type_hints(READERS[schema.VARIABLES[name].shape])["return"]
        assert held[name] == given, name


@pytest.mark.parametrize("path", sorted((ROOT / "examples").glob("*/main.yml")), ids=str)
def test_machines_carry_the_state_types_of_their_states(path: Path) -> None:
    library = disk_library(path, [])
    machine = read_machine(Source(str(path), path.read_text("utf-8")), library, [])
    assert machine is not None
    found = dict(machine.state_types)
    names = {machine.base, *(node.type for _, node in walk(machine.root))}
    for name in sorted(names - set(schema.CONTAINERS)):
        assert found.pop(name, None) == find_state_type(name, library, []), name
    assert found == {}


def test_timers_of_sugar_have_a_state_type() -> None:
    script, report = resolved(SCRIPT)
    assert set(script.state_types) == {"Base", "ScriptedState", "SleepState"}
    assert lower(script).state_types == script.state_types
    assert [item for item in report if item.severity.value == "error"] == []


def imports(module: str) -> Iterator[str]:
    """The modules of ours that a module imports."""
    path = ROOT.joinpath(*module.split("."))
    path = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("smachac"):
            for alias in node.names:
                inner = f"{node.module}.{alias.name}"
                file = ROOT.joinpath(*inner.split("."))
                known = file.is_dir() or file.with_suffix(".py").exists()
                yield inner if known else str(node.module)


def test_lowering_reads_no_yaml() -> None:
    seen: set[str] = set()
    todo = ["smachac.frontend.script.lower"]
    while todo:
        module = todo.pop()
        if module not in seen:
            seen.add(module)
            todo += imports(module)
    assert {"smachac.frontend.resolved_script", "smachac.frontend.script.desugar"} <= seen
    readers = {"yaml_tree", "fields", "values", "resolve", "state_fields", "state_types", "sugar"}
    assert not {f"smachac.frontend.{name}" for name in readers} & seen


def test_state_types_are_looked_up_in_few_places() -> None:
    modules = (path.relative_to(ROOT) for path in sorted((ROOT / "smachac").rglob("*.py")))
    users = [
        str(path)
        for path in modules
        if "import find_state_type" in (ROOT / path).read_text("utf-8")
        or ", find_state_type" in (ROOT / path).read_text("utf-8")
    ]
    assert users == [
        "smachac/commands/new.py",
        "smachac/frontend/script/resolve.py",
        "smachac/frontend/script/resolve_cache.py",
        "smachac/lsp/complete_templates.py",
        "smachac/lsp/facts.py",
        "smachac/lsp/session.py",
        "smachac/refactor/change_states.py",
        "smachac/report/state_types.py",
    ]


def test_a_script_has_a_limit_of_userdata_values(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(resolve_module, "MAX_KEYS", 1)
    monkeypatch.setattr(resolve_module, "MAX_KEYS_BY_STATE", 2)
    text = (
        "name: sm\noutcomes: [done]\nuserdata: {KEYS}\nstates:\n"
        "  - A: {template: ScriptedState, outcomes: [done], transitions: {done: done}}\n"
    )
    assert not resolved(text.replace("KEYS", "a: 1, b: 1, c: 1"))[1]
    report: Report = []
    source = Source("main.yml", text.replace("KEYS", "a: 1, b: 1, c: 1, d: 1"))
    assert resolve(source, parse(source, report), LIBRARY, report) is None
    assert [(item.code, item.span.text) for item in report] == [("SM006", "a")]
    assert "sets 4 userdata keys; the limit is 3" in report[0].finding.message
