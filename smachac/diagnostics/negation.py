"""Negation in names: `not_found` is the opposite of `found`, and no misspelling of it."""

from __future__ import annotations

import re

NEGATIONS = frozenset(["cannot", "never", "no", "non", "not", "without"])
"""Words that negate the name they are in."""

PREFIXES = ("un", "non", "not", "dis", "in", "im")
"""The beginnings of words that negate the rest of the word: `unreachable`."""

SHORTEST_REST = 4
"""Shorter rests are often no words: `unit`."""

NEAR = 0.8
"""A rest as similar as this to a word is that word, misspelt."""

STOPPED = "preempted"
"""The outcome after a stop request: a word that is only a little similar to it, as `rejected`, does
not mean it."""

NEAR_STOPPED = 0.8
"""A word as similar as this to STOPPED is that word, misspelt."""

SLIP = 0.6
"""A negation as similar as this to a word of the other name can be a misspelling of it."""

_WORDS = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])")


def are_unlike(one: str, name: str) -> bool:
    """Whether a similar name has another meaning than a word, so that it is no guess."""
    import difflib

    likeness = difflib.SequenceMatcher(None, one.casefold(), name) if name == STOPPED else None
    if likeness is not None and likeness.ratio() < NEAR_STOPPED:
        return True
    return are_opposite(one, name)


def are_opposite(one: str, other: str) -> bool:
    """Whether one of two names is the negation of the other."""
    if one.casefold().replace("_", "") == other.casefold().replace("_", ""):
        return False
    first, second = words_in(one), words_in(other)
    return _negated(first, second) != _negated(second, first)


def is_negation(one: str, other: str) -> bool:
    """Whether one of two names negates the other and has a word of it: `not_found` and `found`, but
    not `not_found` and `empty`."""
    return are_opposite(one, other) and not {*words_in(one)}.isdisjoint(words_in(other))


def words_in(name: str) -> list[str]:
    """The words of a name in lower case, without digits."""
    return [word.lower() for word in _WORDS.findall(name)]


def _negated(words: list[str], others: list[str]) -> bool:
    """Whether a name has a negation that another one does not have."""
    left = [word for word in others if word not in words]
    return any(_negates(word, others, left) for word in words if word not in others)


def _negates(word: str, others: list[str], left: list[str]) -> bool:
    """Whether a word negates another name, or a word of it. `left` are the words that only the
    other name has."""
    import difflib

    if word in NEGATIONS:
        return not difflib.get_close_matches(word, left, n=1, cutoff=SLIP)
    for prefix in PREFIXES:
        rest = word.removeprefix(prefix)
        if rest != word and len(rest) >= SHORTEST_REST:
            bare = [other for other in others if not other.startswith(prefix)]
            if difflib.get_close_matches(rest, bare, n=1, cutoff=NEAR):
                return True
    return False
