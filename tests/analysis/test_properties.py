"""Verdicts on properties, compared with runs of the interpreter and a monitor of their traces."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.analysis.context import Context
from smachac.analysis.properties import Judgement, judge
from smachac.interpreter.counterexample import replay
from smachac.ir.nodes import Machine
from smachac.ir.properties import AlwaysEnds
from tests.strategies.machines import machines
from tests.support.examples import examples
from tests.support.property_machines import (
    Monitor,
    random_machine,
    random_property,
    random_trace,
)

MOST_NOT_FOLLOWED = 2
"""Of 500 machines, the counterexamples of `always_ends` that a run does not follow exactly: seed
1831 has a loop over three items, and its path leaves the loop after two. The verdict is right."""


def drawn(seed: int) -> tuple[Machine, Judgement]:
    """A random machine, and the verdict on a random property of it."""
    rng = random.Random(seed)
    machine = random_machine(rng, depth=rng.choice([1, 2, 3]))
    given = random_property(rng, machine)
    (judgement,) = judge([given], machine.root, Context(machine).claims)
    assert judgement.verdict != "unclear"
    return machine, judgement


def compare(seeds: range, *, runs: int) -> dict[str, int]:
    """Each counterexample violates its property in the interpreter; where a property holds, no
    random run violates it. The number of each verdict."""
    counts: dict[str, int] = {}
    for seed in seeds:
        machine, judgement = drawn(seed)
        counts[judgement.verdict] = counts.get(judgement.verdict, 0) + 1
        given, example = judgement.property, judgement.counterexample
        monitor = Monitor(machine, given.form)
        if example is not None:
            shown = replay(machine, example.visits, example.again)
            if not shown.followed:  # a loop had another number of items than the path assumes
                assert isinstance(given.form, AlwaysEnds), seed
                counts["not followed"] = counts.get("not followed", 0) + 1
            if not isinstance(given.form, AlwaysEnds):
                ended = any(event["event"] == "finish" for event in shown.events)
                assert monitor.violated(shown.events, ended=ended), seed
        elif judgement.verdict in ("holds", "vacuous") and not isinstance(given.form, AlwaysEnds):
            for number in range(runs):
                trace, ended = random_trace(machine, 1000 * seed + number, stops=given.stops)
                assert not monitor.violated(trace, ended=ended), (seed, number)
    return counts


@pytest.mark.slow
def test_verdicts_agree_with_runs() -> None:
    counts = compare(range(250), runs=15)
    assert min(counts["holds"], counts["fails"], counts["vacuous"]) > 20
    assert "not followed" not in counts


@pytest.mark.nightly
@pytest.mark.parametrize("start", range(1000, 4000, 500))
def test_more_verdicts_agree_with_runs(start: int) -> None:
    counts = compare(range(start, start + 500), runs=20)
    assert counts.get("not followed", 0) <= MOST_NOT_FOLLOWED


@settings(max_examples=examples(100))
@given(machine=machines(), seed=st.integers(0, 1000))
def test_any_graph_is_judged(machine: Machine, seed: int) -> None:
    """Also a graph with dangling targets, names that clash and containers without states."""
    properties = [random_property(random.Random(seed), machine) for _ in range(3)]
    context = Context(replace(machine, properties=tuple(properties)))
    assert len(context.judgements) in (0, 3)
