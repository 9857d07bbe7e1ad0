"""The examples of a law or a table: all of them where the slow tests run as well, else a part."""

from __future__ import annotations

from collections.abc import Iterable

import pytest
from _pytest.mark import ParameterSet
from hypothesis import settings

ALL, SOME = 100, 20
"""The examples of a law without a number of its own, in all tests and in `make test`."""


def examples(count: int) -> int:
    """As many examples as the loaded profile of Hypothesis has in place of `count`."""
    profile = settings.default
    assert profile is not None
    return max(count * profile.max_examples // ALL, 3)


def every(step: int, values: Iterable[object]) -> list[ParameterSet]:
    """The values as parameters of a test; but for each `step`-th one the test is slow."""
    return [
        pytest.param(each, marks=[pytest.mark.slow] if place % step else [])
        for place, each in enumerate(values)
    ]
