"""Requests to stop: random machines as generated Python on the bundled runtime, against the
interpreter. tests/cpp/test_preempt_requests.py has the same for C++."""

from __future__ import annotations

from typing import Any

import pytest

from tests.conformance_ir import generated_vectors
from tests.conformance_ir.test_ir_vectors import expected, replay
from tests.support.examples import seeds
from tests.support.stop_machines import cases, once

Json = Any

BLOCK = 300


def differing(drawn: list[Json]) -> list[str]:
    """Machines that do something else as generated Python."""
    return [
        case["id"]
        for case in drawn
        if once(replay(case)) != once(expected(case, generated_vectors.replay(case)))
    ]


def test_requests_reach_the_same_states() -> None:
    assert differing(cases(1, 40)) == []


@pytest.mark.parametrize("seed", seeds(0, 2, 10))
def test_requests_reach_the_same_states_in_many_machines(seed: int) -> None:
    assert differing(cases(2 + seed, BLOCK)) == []
