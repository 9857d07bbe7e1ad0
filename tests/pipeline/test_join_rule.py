"""`join: rule`: the first rule that holds stops the other branches, in all that run a machine."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from smachac.driver import analyse_script, build
from smachac.frontend.files import disk_library
from smachac.interpreter.interpreter import run
from smachac.ir.nodes import Checked
from smachac.ir.parser import parse_machine
from smachac.ir.printer import print_machine
from smachac.targets import Target, flexbe, python, yasmin
from tests.flexbe import programs as on_flexbe
from tests.yasmin import programs as on_yasmin

PART = """\
import threading

from smachac.runtime import smach


class Part(smach.State):
    def __init__(self, end=None):
        super().__init__(["done", "slipped", "preempted"])
        self.end, self.stop = end, threading.Event()

    def request_preempt(self):
        super().request_preempt()
        self.stop.set()

    def execute(self, userdata):
        if self.end is None:
            self.stop.wait()
            self.service_preempt()
        return self.end or "preempted"
"""

INTERFACE = """\
name: Part
variables: {end: {default: null}}
outcomes: {done: {}, slipped: {failure: true}, preempted: {}}
code: {python: "join_rule_parts:Part"}
"""

SCRIPT = """\
name: grasp
outcomes: [held, lost, dropped, preempted]
states:
- BOTH:
    template: Concurrence
    join: rule
    outcomes: [held, lost, dropped, preempted]
    default_outcome: preempted
    outcome_map: [{lost: {A: slipped}}, {held: {A: done, B: done}}, {dropped: {B: slipped}}, \
{lost: {A: preempted}}]
    transitions: {held: held, lost: lost, dropped: dropped, preempted: preempted}
    states:
    - A: {template: Part, end: ENDA}
    - B: {template: Part, end: ENDB}
"""

CASES = {
    ("done", "done"): "held",
    ("done", "slipped"): "dropped",
    ("slipped", "null"): "lost",
    ("null", "slipped"): "dropped",
}
"""The outcome by those of the branches; `null` waits for a request to stop."""


@pytest.fixture(params=CASES, ids=lambda case: "-".join(case))
def case(
    request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[tuple[Path, tuple[str, str]]]:
    """The script of a case, and the ends of its branches."""
    first, second = request.param
    (tmp_path / "templates").mkdir()
    (tmp_path / "templates" / "Part.yml").write_text(INTERFACE, "utf-8")
    (tmp_path / "join_rule_parts.py").write_text(PART, "utf-8")
    (tmp_path / "main.yml").write_text(
        SCRIPT.replace("ENDA", first).replace("ENDB", second), "utf-8"
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    importlib.invalidate_caches()
    yield tmp_path / "main.yml", request.param
    sys.modules.pop("join_rule_parts", None)


def checked(script: Path) -> Checked:
    found = analyse_script(script).checked
    assert found is not None
    return found


def files_of(script: Path, target: Target) -> dict[str, str]:
    return build(checked(script), target, disk_library(script, []), [])


def test_the_interpreter(case: tuple[Path, tuple[str, str]]) -> None:
    script, ends = case
    machine = checked(script)

    def behave(path: str, _leaf: Any, _visit: int, userdata: Any) -> str:
        end = ends[0] if path.endswith("A") else ends[1]
        return "preempted" if userdata.preempted or end == "null" else end

    if ends != ("null", "slipped"):  # there A would end by itself
        assert run(machine, behave, lambda event: None).outcome == CASES[ends]
    text = print_machine(machine)
    assert print_machine(parse_machine(text)) == text


def test_python(case: tuple[Path, tuple[str, str]], silent_smach: None) -> None:
    script, ends = case
    ((_, text),) = files_of(script, python.TARGET).items()
    module: dict[str, Any] = {"__name__": "generated"}
    exec(compile(text, "grasp.py", "exec"), module)
    assert module["build"]().execute() == CASES[ends]


def test_yasmin(
    case: tuple[Path, tuple[str, str]], monkeypatch: pytest.MonkeyPatch, silent_smach: None
) -> None:
    script, ends = case
    monkeypatch.setitem(sys.modules, "yasmin", on_yasmin.ENGINE)
    with on_yasmin.loaded(files_of(script, yasmin.TARGET)) as module:
        assert module.run().execute() == CASES[ends]


def test_flexbe(case: tuple[Path, tuple[str, str]], silent_smach: None) -> None:
    script, ends = case
    with on_flexbe.loaded(files_of(script, flexbe.TARGET)) as made:
        assert on_flexbe.ready(made).execute() == CASES[ends]
