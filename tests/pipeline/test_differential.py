"""What the interpreter does, the generated Python does: event by event."""

from __future__ import annotations

import contextlib
import io
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, seed, settings

from smachac.diagnostics.source import Source
from smachac.driver import build, check, read_machine
from smachac.frontend.files import disk_library, read_source
from smachac.frontend.loader import Library
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import Interpreter
from smachac.interpreter.userdata import Userdata
from smachac.ir.nodes import Checked, Leaf, Machine
from smachac.runtime.tracing import trace
from smachac.runtime.tracing.compare import compare
from smachac.targets.python import TARGET
from tests.strategies.full_machines import busy_machines
from tests.support.examples import examples, seeds
from tests.support.silent_smach import silent_smach
from tests.support.typed_machines import with_state_types

ROOT = Path(__file__).parents[2]
LIBRARY = disk_library(ROOT / "main.yml", [])

Event = dict[str, Any]


NOBODY = ("", 0)
SLOW = list(HealthCheck)
MOST_STEPS = 300


def of_generated(
    machine: Machine, library: Library = LIBRARY, asked: tuple[str, int] = NOBODY
) -> list[Event]:
    """The trace of the generated program; `asked`: the visit in which the machine is to stop."""
    report: list[Any] = []
    typed = with_state_types(machine, library)
    ((name, text),) = build(Checked(typed), TARGET, library, report).items()
    assert report == []
    module: dict[str, Any] = {"__name__": "generated"}
    exec(compile(text, name, "exec"), module)
    events: list[Event] = []
    entered: list[str] = []

    def observe(event: Event) -> None:
        events.append(event)
        if event["event"] == "enter":
            entered.append(event["path"])
            if event["path"] == asked[0] and entered.count(asked[0]) == asked[1]:
                root.request_preempt()

    with silent_smach(), contextlib.redirect_stdout(io.StringIO()):
        root = module["build"]()
        trace.attach(root, machine.root.name, observe)
        with contextlib.suppress(Exception):
            root.execute()
    return events


def of_interpreter(machine: Machine, asked: tuple[str, int] = NOBODY) -> list[Event] | None:
    """The trace of the interpreter; None if the machine does not end within MOST_STEPS."""
    events: list[Event] = []
    behave = builtin_behaviour()

    def asking(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
        if (path, visit) == asked:
            interpreter.preemption.request(machine.root.name)
        return behave(path, leaf, visit, userdata)

    interpreter = Interpreter(machine, asking, events.append, max_steps=MOST_STEPS)
    error = interpreter.execute().error
    return None if error is not None and error.kind == "no-end" else events


def differ(ours: list[Event], theirs: list[Event]) -> str | None:
    """The first difference, or None. When a request reaches a branch, threads decide."""
    both = [[event for event in run if event["event"] != "preempt"] for run in (ours, theirs)]
    asked = [
        sorted(event["path"] for event in run if event["event"] == "preempt")
        for run in (ours, theirs)
    ]
    if asked[0] != asked[1]:
        return f"asked to stop: {asked[0]}, but then {asked[1]}"
    return compare(*both)


@pytest.mark.parametrize(
    "script",
    [
        *sorted((ROOT / "examples").glob("0[1-7]*/main.yml")),
        ROOT / "tests" / "cases" / "containers" / "main.yml",
        ROOT / "tests" / "cases" / "deep_nesting" / "main.yml",
        ROOT / "tests" / "cases" / "on_error" / "main.yml",
        ROOT / "tests" / "cases" / "sugar" / "main.yml",
    ],
    ids=lambda path: path.parent.name,
)
def test_examples(script: Path) -> None:
    report: list[Any] = []
    source = read_source(script, report)
    assert source is not None
    library = disk_library(script, report)
    machine = read_machine(source, library, report)
    assert machine is not None
    assert check(machine, report) is not None
    ours = of_interpreter(machine)
    assert ours is not None
    difference = differ(ours, of_generated(machine, library))
    assert difference is None, difference


ITEMS = """
name: sm
template: Base
outcomes: [done]
userdata: {parts: [1, 2, 3], seen: []}
output_keys: [seen]
states:
  - EACH:
      template: Iterator
      it: CODE
      it_label: part
      input_keys: [parts, seen]
      output_keys: [seen]
      outcomes: [done]
      exhausted_outcome: done
      loop_outcomes: [succeeded]
      states:
        - NOTE:
            template: CallbacksState
            input_keys: [part, seen]
            output_keys: [seen]
            callbacks: {seen: 'lambda ud: ud.seen + [ud.part]'}
      transitions: {done: done}
"""


@pytest.mark.parametrize("code", ["parts", "'`lambda ud: ud.parts + [4]`'", "'`lambda: [1, 2]`'"])
def test_items_from_functions(code: str) -> None:
    """SMACH calls the function without arguments."""
    report: list[Any] = []
    machine = read_machine(Source("main.yml", ITEMS.replace("CODE", code)), LIBRARY, report)
    assert machine is not None
    ours = of_interpreter(machine)
    assert ours is not None
    assert sum(event["path"].endswith("NOTE") for event in ours if event["event"] == "enter") > 1
    assert differ(ours, of_generated(machine)) is None


CHUNKS = seeds(1, 4, 24)


@pytest.mark.parametrize("chunk", CHUNKS)
def test_random_machines(chunk: int) -> None:
    """1,200 machines, in parts so that workers share them."""

    @seed(chunk)
    @settings(
        max_examples=examples(50), derandomize=False, database=None, suppress_health_check=SLOW
    )
    @given(busy_machines())
    def agree(drawn: tuple[Machine, tuple[str, int]]) -> None:
        machine, asked = drawn
        ours = of_interpreter(machine, asked)
        if ours is None:
            return
        difference = differ(ours, of_generated(machine, asked=asked))
        assert difference is None, difference

    agree()
