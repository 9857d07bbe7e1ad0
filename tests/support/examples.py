"""The examples of a law or a table: all of them in the nightly tests, else a part."""

from __future__ import annotations

from collections.abc import Iterable

import pytest
from _pytest.mark import ParameterSet
from hypothesis import settings

ALL, SOME = 100, 20
"""The examples of a law without a number of its own, in the nightly tests and in all others."""


def examples(count: int) -> int:
    """As many examples as the loaded profile of Hypothesis has in place of `count`."""
    profile = settings.default
    assert profile is not None
    return max(count * profile.max_examples // ALL, 3)


def every(step: int, values: Iterable[object]) -> list[ParameterSet]:
    """The values as parameters of a test; but for each `step`-th one the test is slow."""
    return [
        pytest.param(value, marks=[pytest.mark.slow] if place % step else [])
        for place, value in enumerate(values)
    ]


def seeds(quick: int, slow: int, nightly: int) -> list[ParameterSet]:
    """The seeds from 0 as parameters of a test: those up to `quick` for `make test`, those up to
    `slow` slow, and those up to `nightly` nightly."""
    return [pytest.param(seed, marks=tier(seed, quick, slow)) for seed in range(nightly)]


def tier(place: int, quick: int, slow: int) -> list[pytest.MarkDecorator]:
    """The marks of the test at a place of its table; see `seeds`."""
    if place < quick:
        return []
    return [pytest.mark.slow if place < slow else pytest.mark.nightly]
