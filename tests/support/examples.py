"""The number of examples of a law: all of them where the slow tests run as well, else a part."""

from __future__ import annotations

from hypothesis import settings

ALL, SOME = 100, 30
"""The examples of a law without a number of its own, in all tests and in `make test`."""


def examples(count: int) -> int:
    """As many examples as the loaded profile of Hypothesis has in place of `count`."""
    return max(count * settings.default.max_examples // ALL, 5)
