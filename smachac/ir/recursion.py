"""Recursion limit for deeply nested containers and values."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

FRAMES = 10_000
"""Python's recursion limit during our work: twice the need of the deepest accepted script."""


@contextmanager
def deep_recursion() -> Iterator[None]:
    """Raise Python's recursion limit inside a `with` block."""
    before = sys.getrecursionlimit()
    sys.setrecursionlimit(max(before, FRAMES))
    try:
        yield
    finally:
        sys.setrecursionlimit(before)
