"""Combinations of outcomes of a concurrence, as a script writes them."""

from __future__ import annotations

from collections.abc import Mapping


def written(combination: Mapping[str, str]) -> str:
    """A combination as the script writes its conditions."""
    return ", ".join(f"`{child}: {outcome}`" for child, outcome in combination.items())
