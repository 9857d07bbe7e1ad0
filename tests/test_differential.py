"""What the interpreter does, the generated Python does: event by event."""

from __future__ import annotations

import contextlib
import io
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from quiet import quiet
from strategies import valid_machines

from smachac.driver import build, check, load
from smachac.files import disk_library, read_source
from smachac.ir.behaviours import built_in
from smachac.ir.nodes import Checked, Machine
from smachac.ir.run import run
from smachac.runtime import trace
from smachac.runtime.compare import compare
from smachac.states import Library
from smachac.targets.python import TARGET

ROOT = Path(__file__).parents[1]
LIBRARY = disk_library(ROOT / "main.yml", [])

Event = dict[str, Any]


def of_generated(machine: Machine, library: Library = LIBRARY) -> list[Event]:
    """The trace of the generated program."""
    report: list[Any] = []
    ((name, text),) = build(Checked(machine), TARGET, library, report).items()
    assert report == []
    module: dict[str, Any] = {"__name__": "generated"}
    exec(compile(text, name, "exec"), module)
    events: list[Event] = []
    with quiet(), contextlib.redirect_stdout(io.StringIO()):
        root = module["build"]()
        trace.attach(root, machine.root.name, events.append)
        with contextlib.suppress(Exception):
            root.execute()
    return events


def of_interpreter(machine: Machine) -> list[Event]:
    events: list[Event] = []
    run(machine, built_in(), events.append)
    return events


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
        ROOT / "tests" / "cases" / "sugar" / "main.yml",
    ],
    ids=lambda path: path.parent.name,
)
def test_examples(script: Path) -> None:
    report: list[Any] = []
    source = read_source(script, report)
    assert source is not None
    library = disk_library(script, report)
    machine = load(source, library, report)
    assert machine is not None
    assert check(machine, report) is not None
    difference = differ(of_interpreter(machine), of_generated(machine, library))
    assert difference is None, difference


@settings(max_examples=150, suppress_health_check=list(HealthCheck))
@given(valid_machines(), st.data())
def test_random_machines(machine: Machine, data: st.DataObject) -> None:
    difference = differ(of_interpreter(machine), of_generated(machine))
    assert difference is None, difference
