"""Wording of messages: lists of names."""

from __future__ import annotations

from collections.abc import Collection, Iterable

MOST_LISTED = 12
"""Limit on the names in a message; the others are counted."""


LONGEST_QUOTE = 200
"""The most characters of a quoted text from a file."""


def quote(text: str) -> str:
    """A text from a file in a message; the middle of a long one is left out."""
    if len(text) <= LONGEST_QUOTE:
        return f"`{text}`"
    end = LONGEST_QUOTE // 2
    return f"`{text[:end]}…{text[-end:]}` ({len(text)} characters)"


def listed(names: Iterable[str]) -> str:
    """Names in backticks, sorted, at most MOST_LISTED of them."""
    every = sorted(set(names))
    text = ", ".join(map(quote, every[:MOST_LISTED]))
    more = len(every) - MOST_LISTED
    return f"{text} and {more} more" if more > 0 else text


MOST_POSSIBLE = 6
"""The most names in a list of those that fit best."""


def possible(names: Collection[str], fitting: Collection[str]) -> str:
    """The end of a help that lists names: all of them, or, if that is much, only those `fitting`,
    which are not given yet."""
    if not fitting or len(names) <= MOST_POSSIBLE:
        return f": {listed(names)}"
    shown = sorted(fitting)
    more = len(shown) - MOST_POSSIBLE
    text = ", ".join(f"`{name}`" for name in shown[:MOST_POSSIBLE])
    return f" that are not given yet: {text}{f' and {more} more' if more > 0 else ''}"


def both(names: Iterable[str]) -> str:
    """Names in backticks as the subject of a sentence: `A` and `B`, or `A`, `B` and `C`."""
    every = sorted(set(names))
    if not 1 < len(every) <= MOST_LISTED:
        return listed(every)
    return f"{listed(every[:-1])} and `{every[-1]}`"


def either(choices: Iterable[str]) -> str:
    """Texts in backticks as alternatives, in their order: `a` or `b`, or `a`, `b` or `c`."""
    *others, last = [f"`{choice}`" for choice in choices]
    return f"{', '.join(others)} or {last}" if others else last
