"""Room for recursion over what is nested deep: containers, and the values of a script."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

FRAMES = 10_000
"""Python's limit of recursion while we work: twice what the deepest script needs."""


@contextmanager
def deep_recursion() -> Iterator[None]:
    """Raise Python's limit of recursion for as long as this lasts."""
    before = sys.getrecursionlimit()
    sys.setrecursionlimit(max(before, FRAMES))
    try:
        yield
    finally:
        sys.setrecursionlimit(before)
