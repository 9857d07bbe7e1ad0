"""Random machines with every construct do on SCION what the interpreter does, event by event."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import HealthCheck, given, seed, settings

from smachac.ir.nodes import Machine
from smachac.runtime.tracing.compare import compare
from tests.pipeline.test_differential import NOBODY, Event, of_interpreter
from tests.scxml.scion import played, text_of
from tests.strategies.full_machines import busy_machines
from tests.support.typed_machines import with_state_types

pytestmark = pytest.mark.browser

COUNT = 60
"""The machines of one seed, which one process of Node runs."""


@pytest.mark.parametrize(
    "number", [1, *(pytest.param(seed, marks=pytest.mark.nightly) for seed in range(2, 12))]
)
def test_machines_do_what_the_interpreter_does(number: int) -> None:
    expected: list[list[Event]] = []
    texts: list[str] = []
    cases: list[dict[str, Any]] = []

    @seed(number)
    @settings(
        max_examples=COUNT, database=None, deadline=None, suppress_health_check=list(HealthCheck)
    )
    @given(busy_machines())
    def draw(given: tuple[Machine, tuple[str, int]]) -> None:
        machine, asked = given
        machine = with_state_types(machine)
        ours = of_interpreter(machine, asked)
        text = text_of(machine)
        if ours is not None and text is not None:
            expected.append([event for event in ours if event["event"] != "preempt"])
            texts.append(text)
            cases.append(
                {
                    "document": len(cases),
                    "inputs": {},
                    "stopped": False,
                    "asked": None if asked == NOBODY else list(asked),
                }
            )

    draw()
    assert len(expected) > COUNT / 2
    traces = played(texts, cases, scripted=False)
    for ours, theirs in zip(expected, traces, strict=True):
        assert compare(ours, theirs) is None
