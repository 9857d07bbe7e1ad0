"""Traces of runs are accepted; traces with a changed, missing or moved event are not."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import HealthCheck, given, seed, settings
from hypothesis import strategies as st

import smachac
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run
from smachac.ir.nodes import Machine
from smachac.verify.trace_conformance import first_violation
from tests.pipeline.test_differential import of_generated, of_interpreter
from tests.strategies.full_machines import busy_machines
from tests.support.examples import examples

Event = dict[str, Any]
SLOW = list(HealthCheck)


def words(machine: Machine, events: list[Event]) -> str | None:
    violation = first_violation(machine, events)
    return None if violation is None else f"{events[violation.at]}: {violation.message}"


@seed(0)
@settings(max_examples=examples(250), database=None, suppress_health_check=SLOW)
@given(busy_machines())
def test_runs_of_the_interpreter_are_allowed(drawn: tuple[Machine, tuple[str, int]]) -> None:
    machine, asked = drawn
    events = of_interpreter(machine, asked)
    assert events is None or words(machine, events) is None


@seed(0)
@settings(max_examples=40, database=None, suppress_health_check=SLOW)
@given(busy_machines())
@pytest.mark.slow
def test_runs_of_generated_programs_are_allowed(drawn: tuple[Machine, tuple[str, int]]) -> None:
    machine, asked = drawn
    if of_interpreter(machine, asked) is not None:
        assert words(machine, of_generated(machine, asked=asked)) is None


def traces(drawn: tuple[Machine, tuple[str, int]]) -> list[Event]:
    """The events of a run, from its start to its finish; none if it fails or has no end."""
    events = of_interpreter(*drawn) or []
    return events if events and events[-1]["event"] == "finish" else []


@pytest.mark.parametrize("kind", ["start", "enter", "exit", "transition"])
def test_a_trace_without_one_of_its_events_is_refused(kind: str) -> None:
    found: list[str] = []

    @seed(1)
    @settings(max_examples=examples(60), database=None, suppress_health_check=SLOW)
    @given(busy_machines(), st.randoms(use_true_random=False))
    def refuse(drawn: tuple[Machine, tuple[str, int]], random: Any) -> None:
        events = traces(drawn)
        places = [at for at, event in enumerate(events) if event["event"] == kind]
        if places:
            at = random.choice(places)
            message = words(drawn[0], events[:at] + events[at + 1 :])
            assert message is not None, events[at]
            found.append(message)

    refuse()
    assert len(found) > examples(20)


@pytest.mark.parametrize("name", ["outcome", "to", "path"])
@pytest.mark.slow
def test_a_trace_with_another_outcome_or_path_is_refused(name: str) -> None:
    found: list[str] = []

    @seed(2)
    @settings(max_examples=examples(60), database=None, suppress_health_check=SLOW)
    @given(busy_machines(), st.randoms(use_true_random=False))
    def refuse(drawn: tuple[Machine, tuple[str, int]], random: Any) -> None:
        events = traces(drawn)
        places = [at for at, event in enumerate(events) if name in event]
        if places:
            at = random.choice(places)
            changed = {**events[at], name: f"{events[at][name]}x"}
            violation = first_violation(drawn[0], [*events[:at], changed, *events[at + 1 :]])
            opened = name == "outcome" and changed["event"] == "exit"
            assert violation is not None or opened, changed
            if violation is not None:
                found.append(violation.message)

    refuse()
    assert len(found) > examples(20)


def test_the_first_event_that_is_not_allowed_is_named() -> None:
    machine = smachac.load(
        "name: sm\noutcomes: [done, lost]\nstates:\n"
        "  - A: {template: ScriptedState, outcomes: [ok, bad], transitions: {ok: B, bad: lost}}\n"
        "  - B: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}\n",
        name="main.yml",
    )
    events: list[Event] = []
    run(machine, builtin_behaviour(), events.append)
    assert first_violation(machine, events) is None
    at = next(n for n, event in enumerate(events) if event["event"] == "transition")
    events[at] = {**events[at], "to": "sm:lost"}
    violation = first_violation(machine, events)
    assert violation is not None
    assert violation.at == at
    assert violation.message == "`ok` of `sm/A` leads to `sm:lost`, in the script to `sm/B`"
    assert violation.span.line == 4
