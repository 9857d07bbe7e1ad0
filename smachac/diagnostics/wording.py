"""How problems and rules name what they speak of."""

from __future__ import annotations

from collections.abc import Iterable

MOST_LISTED = 12
"""So many names a message lists; the rest is counted."""


def listed(names: Iterable[str]) -> str:
    """Names in backticks, in the order of the alphabet, at most MOST_LISTED of them."""
    every = sorted(set(names))
    text = ", ".join(f"`{name}`" for name in every[:MOST_LISTED])
    more = len(every) - MOST_LISTED
    return f"{text} and {more} more" if more > 0 else text
