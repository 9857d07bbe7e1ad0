"""What is said of failures and ways against what happens in runs."""

from __future__ import annotations

import pytest
from hypothesis import event, given, settings
from hypothesis import strategies as st

from smachac.analysis.context import Context
from smachac.analysis.failure_paths import Failure
from smachac.analysis.successors import path_to
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run
from smachac.interpreter.result import Event, InterpreterResult
from smachac.ir.nodes import Concurrence, Leaf, Machine
from smachac.ir.outcome_names import is_failure
from smachac.ir.traversal import walk
from tests.strategies.machines import valid_machines
from tests.strategies.userdata_machines import data_machines
from tests.support.examples import examples

MACHINES = st.one_of(valid_machines(), data_machines())


def told(machine: Machine) -> dict[tuple[str, str], list[Failure]]:
    found: dict[tuple[str, str], list[Failure]] = {}
    for failure in Context(machine).failures:
        found.setdefault((failure.path, failure.outcome), []).append(failure)
    return found


def failed(machine: Machine, trace: list[Event]) -> list[tuple[int, tuple[str, str]]]:
    """The failures of leaves in a trace, each with its place there."""
    leaves = {path for path, node in walk(machine.root) if isinstance(node, Leaf)}
    return [
        (number, (line["path"], line["outcome"]))
        for number, line in enumerate(trace)
        if line["event"] == "exit" and line["path"] in leaves and is_failure(line["outcome"])
    ]


def ran(machine: Machine, seed: int) -> tuple[InterpreterResult, list[Event]]:
    trace: list[Event] = []
    return run(machine, builtin_behaviour(seed), trace.append, seed=seed, max_steps=200), trace


@settings(max_examples=examples(150))
@given(MACHINES, st.integers(0, 9))
def test_every_failure_of_a_run_is_told_with_its_end(machine: Machine, seed: int) -> None:
    rows = told(machine)
    result, trace = ran(machine, seed)
    for _, failure in failed(machine, trace):
        event("a failure")
        assert failure in rows
        if result.outcome is not None:
            assert any(result.outcome in row.ends for row in rows[failure]), (failure, rows)


@settings(max_examples=150)
@given(MACHINES, st.integers(0, 9))
@pytest.mark.slow
def test_what_follows_a_failure_is_told(machine: Machine, seed: int) -> None:
    if any(isinstance(node, Concurrence) for _, node in walk(machine.root)):
        return
    rows = told(machine)
    result, trace = ran(machine, seed)
    for number, failure in failed(machine, trace):
        later = (line["path"] for line in trace[number:] if line["event"] == "enter")
        following = next(later, "")
        if following or result.outcome is not None:
            event("followed by a state" if following else "followed by the end")
            assert following in {row.next for row in rows[failure]}, (failure, rows[failure])


@settings(max_examples=examples(100))
@given(MACHINES, st.integers(0, 9))
def test_every_state_of_a_run_has_a_way_to_it(machine: Machine, seed: int) -> None:
    ways = Context(machine).routes.before
    _, trace = ran(machine, seed)
    for path in {line["path"] for line in trace if line["event"] == "enter"} - {machine.root.name}:
        way = path_to(ways, (path, ""))
        assert way[-1] == path.rpartition("/")[2]
        assert way[0].startswith("(") is False
