"""Test cases for targets, the expected traces, and the comparison of traces."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import zip_longest
from typing import Any

from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run
from smachac.interpreter.scenario import (
    PlainStep,
    Scenario,
    plain_steps_by_path,
    scenario_behaviour,
)
from smachac.interpreter.userdata import Userdata
from smachac.ir.nodes import Leaf, Machine
from smachac.ir.secret_keys import SecretKeys, secret_keys
from smachac.ir.traversal import walk
from smachac.records import dataclass
from smachac.runtime.tracing.compare import Difference, difference
from smachac.runtime.tracing.writer import trace_value
from smachac.verify.paths import Path
from smachac.verify.python_values import Sample
from smachac.verify.sample_values import sample_inputs
from smachac.verify.shared_keys import deterministic_reads

Event = dict[str, Any]


class UnplayableError(Exception):
    """A target cannot run test cases here; the message has the reason."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TestCase:
    """One test case: the steps of every leaf that follows the scenario, by path (`rows`); the
    leaves that run their own code (`live`); the inputs that the other leaves record (`reads`); the
    userdata of the machine; the limit on visits of leaves (`most`); whether a request to stop comes
    before the start (`stopped`); the values that replace those that only Python computes
    (`samples`), which targets without Python code do not have; the keys whose values traces hide,
    by path (`secret`)."""

    __test__ = False  # pytest: not a test class

    rows: Mapping[str, Sequence[PlainStep]]
    live: frozenset[str]
    reads: Mapping[str, Sequence[str]]
    userdata: Mapping[str, object]
    most: int
    secret: SecretKeys
    stopped: bool = False
    samples: Sequence[Sample] = ()


Player = Callable[[Sequence[TestCase]], Iterable[list[Event]]]
"""Runs test cases on a target; yields the trace of each. May raise UnplayableError."""


def test_cases(
    machine: Machine, paths: Sequence[Path], live: frozenset[str], samples: Sequence[Sample]
) -> list[TestCase]:
    """The test cases of paths.

    Leaves that a path does not visit have no steps: a visit is an error. On a live path the `live`
    leaves run their own code.
    """
    reads, userdata = deterministic_reads(machine), sample_inputs(machine)
    secret = secret_keys(machine)
    leaves = [path for path, node in walk(machine.root) if isinstance(node, Leaf)]
    cases = []
    scripted_reads = {path: keys for path, keys in reads.items() if path not in live}
    for path in paths:
        own = live if path.live else frozenset()
        rows: dict[str, Sequence[PlainStep]] = {name: () for name in leaves if name not in own}
        rows |= plain_steps_by_path(path.scenario, machine)
        cases.append(
            TestCase(
                rows=rows,
                live=own,
                reads=scripted_reads if own else reads,
                userdata=userdata,
                most=path.visits,
                stopped=path.stopped,
                samples=samples,
                secret=secret,
            )
        )
    return cases


def expected_trace(machine: Machine, scenario: Scenario, case: TestCase) -> list[Event]:
    """The trace of the interpreter, with the inputs that leaves read."""
    events: list[Event] = []
    scripted = scenario_behaviour(scenario, machine, builtin_behaviour())

    def behave(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
        for key in case.reads.get(path, ()):
            if key in userdata:
                record_read(events, path, key, userdata[key])
        return scripted(path, leaf, visit, userdata)

    stops = [0] if case.stopped else ()
    run(machine, behave, events.append, schedule=(), userdata=case.userdata, preempt_at=stops)
    return events


def record_read(events: list[Event], path: str, key: str, value: object) -> None:
    """Add the input of a leaf to a trace.

    None is left out: some targets do not distinguish it from an absent key. A value without a JSON
    form is recorded as OPAQUE.
    """
    if value is None:
        return
    try:
        json.dumps(value, allow_nan=False)
        shown = trace_value(value)
    except (TypeError, ValueError, RecursionError):
        shown = OPAQUE
    events.append({"event": "read", "path": path, "key": key, "value": shown})


OPAQUE = "(not JSON)"
"""Stands for a value without a JSON form."""


def _is_error_of(event: Event | None, path: str) -> bool:
    return event is not None and event["event"] == "error" and event["path"] == path


def compare_traces(ours: list[Event], theirs: list[Event]) -> Difference | None:
    """The first difference of two traces.

    `preempt` events are ignored: it depends on the progress of a branch which states receive a
    request. Keys that are OPAQUE in one trace are ignored in both, and so is the end of a state
    directly before its error, for an outcome that leads nowhere: stepped C++ has the error alone.
    """
    opaque = {
        (event["path"], event["key"])
        for event in (*ours, *theirs)
        if event["event"] == "read" and event["value"] == OPAQUE
    }
    kept = [
        [
            event
            for event, after in zip_longest(events, events[1:])
            if event["event"] != "preempt"
            and not (event["event"] == "read" and (event["path"], event["key"]) in opaque)
            and not (event["event"] == "exit" and _is_error_of(after, event["path"]))
        ]
        for events in (ours, theirs)
    ]
    return difference(*kept)
