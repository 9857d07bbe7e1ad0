"""Absorbing Markov chains against closed forms and against numpy."""

from __future__ import annotations

import random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from smachac.analysis.absorbing_chain import EndlessChainError, absorption


def test_a_chain_without_cycles() -> None:
    rows = {"a": {"b": 0.25, "good": 0.75}, "b": {"good": 0.5, "bad": 0.5}}
    visits, ends = absorption(rows, "a")
    assert visits == {"a": 1.0, "b": 0.25}
    assert ends == {"good": 0.875, "bad": 0.125}


def test_a_retry_is_a_geometric_series() -> None:
    """A try that fails with 0.3 is repeated until it succeeds: 1 / 0.7 tries."""
    visits, ends = absorption({"try": {"try": 0.3, "done": 0.7}}, "try")
    assert visits["try"] == pytest.approx(1 / 0.7)
    assert ends == {"done": pytest.approx(1.0)}


def test_what_is_not_reached_has_no_visits() -> None:
    visits, _ = absorption({"a": {"end": 1.0, "b": 0.0}, "b": {"b": 1.0}}, "a")
    assert visits == {"a": 1.0}


def test_a_chain_that_never_ends_is_an_error() -> None:
    with pytest.raises(EndlessChainError, match="`b` is reached"):
        absorption({"a": {"b": 1.0}, "b": {"b": 1.0}}, "a")


@given(st.integers(0, 2**32), st.integers(1, 12))
def test_random_chains_have_the_solution_of_numpy(seed: int, size: int) -> None:
    rng = random.Random(seed)
    rows: dict[int, dict[int, float]] = {}
    for state in range(size):
        weights = {to: rng.random() for to in range(size) if rng.random() < 0.5}
        weights[-1 - rng.randrange(2)] = rng.random() + 1e-3
        total = sum(weights.values())
        rows[state] = {to: weight / total for to, weight in weights.items()}
    found, ends = absorption(rows, 0)
    inside = np.array([[rows[i].get(j, 0.0) for j in range(size)] for i in range(size)])
    visits = np.linalg.solve((np.eye(size) - inside).T, np.eye(size)[0])
    for state in range(size):
        assert found.get(state, 0.0) == pytest.approx(visits[state], abs=1e-9)
    for end in (-1, -2):
        wanted = sum(visits[state] * rows[state].get(end, 0.0) for state in range(size))
        assert ends.get(end, 0.0) == pytest.approx(wanted, abs=1e-9)
