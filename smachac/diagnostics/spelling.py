"""Spelling suggestions: the nearest known name, and the edit that replaces a misspelt one."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import lru_cache

from smachac.diagnostics.negation import are_opposite, are_unlike
from smachac.diagnostics.repair import Edit
from smachac.diagnostics.source import Word

MOST_COMPARED = 40
"""With more candidates, only names one slip away are found: comparing them all would take too
long."""

MOST_EXPLAINED = 100
"""The most findings of one kind in a container, or in a state, whose help is searched in the whole
of it. So many faults have one cause, and a search for each of them would take quadratic time."""

SHORTEST_SLIP = 4
"""Shorter names are one slip away from too many others: for them only the case may differ."""

SHORTEST_PART = 3
"""A shorter word is a part of too many names."""

LONGEST_SLIP = 100
"""In characters. For longer names only the case may differ: a comparison takes quadratic time and
memory."""

SHORTEST_WRONG_LETTER = 6
"""Shorter names with one different letter are not certain: LIFT is not LEFT."""

_PLAIN = re.compile(r"[A-Za-z_][\w./-]*", re.ASCII)
_NOT_PLAIN = frozenset(["true", "false", "null", "yes", "no", "on", "off", "y", "n"])
_NO_DIGITS = re.compile(r"\D+")
_WORDS = re.compile(r"[A-Za-z]+|\d+")


class Guesser:
    """Finds the candidate nearest to a misspelt name.

    A slip is a difference in case, one letter too many, one missing, one wrong, or two swapped
    neighbours.
    """

    def __init__(self, candidates: Iterable[str]) -> None:
        self.names = list(dict.fromkeys(candidates))
        self._index: dict[str, str] = {}
        self._shared: set[str] = set()

    def __call__(self, word: str) -> str | None:
        """The nearest name, or the only one of which the word is a part (`blue` of `blue_block`);
        None without one. A name with another meaning is no guess."""
        index = self._slips()
        nearest = next((index[slip] for slip in slips(word) if slip in index), None)
        if nearest is None and len(self.names) <= MOST_COMPARED and len(word) <= LONGEST_SLIP:
            parts = [name for name in self.names if word.casefold() in name.casefold().split("_")]
            if len(parts) != 1 or len(word) < SHORTEST_PART:
                import difflib

                parts = difflib.get_close_matches(word, self.names, n=1)
            nearest = next(iter(parts), None)
        return None if nearest is None or are_unlike(word, nearest) else nearest

    def unique_match(self, word: str) -> str | None:
        """The only candidate that is one slip away and has the same digits, or None."""
        index = self._slips()
        near = [slip for slip in slips(word) if slip in index]
        names = {index[slip] for slip in near}
        if len(names) != 1 or not self._shared.isdisjoint(near):
            return None
        (name,) = names
        if name == word or are_opposite(word, name):
            return None
        return name if _one_slip(word.casefold(), name.casefold()) else None

    def _slips(self) -> dict[str, str]:
        if not self._index:
            for name in self.names:
                for slip in dict.fromkeys(slips(name)):
                    if self._index.setdefault(slip, name) != name:
                        self._shared.add(slip)
            self._index.update((name.casefold(), name) for name in reversed(self.names))
        return self._index


# Cached, because a guesser has an index of its names: without, a check of 1,000 states with a
# misspelt field takes 60 % more instructions.
@lru_cache(maxsize=8)
def guesser_of(names: tuple[str, ...]) -> Guesser:
    """The guesser for a tuple of names."""
    return Guesser(names)


def slips(name: str) -> list[str]:
    """A name in lower case, and the same without each of its letters.

    Two names one slip apart have one of these in common.
    """
    word = name.casefold()
    if not SHORTEST_SLIP <= len(word) <= LONGEST_SLIP:
        return [word]
    return [word, *(word[:at] + word[at + 1 :] for at in range(len(word)))]


def _one_slip(word: str, name: str) -> bool:
    """Whether two names with a common slip are near enough for a certain correction."""
    if word == name:
        return True
    if min(len(word), len(name)) < SHORTEST_SLIP:
        return False
    if _NO_DIGITS.sub("", word) != _NO_DIGITS.sub("", name):
        return False
    if sorted(word) == sorted(name):
        wrong = [at for at, (a, b) in enumerate(zip(word, name, strict=True)) if a != b]
        return wrong == [wrong[0], wrong[0] + 1]
    if len(word) != len(name):
        return True
    return len(word) >= SHORTEST_WRONG_LETTER


def is_plain(name: str) -> bool:
    """Whether YAML reads a name as a string everywhere without quotes."""
    return _PLAIN.fullmatch(name) is not None and name.casefold() not in _NOT_PLAIN


def written_name(name: str) -> str:
    """A name as YAML needs it in a script: `"no"` for a word that YAML 1.1 reads as a boolean."""
    return f'"{name}"' if name.casefold() in _NOT_PLAIN else name


def respelt(word: Word, name: str | None) -> tuple[Edit, ...]:
    """The edit that replaces a word of a script with another name; empty if the word is not in the
    text."""
    if name is None or not is_plain(name):
        return ()
    written = word.span.text
    for quote in ("", "'", '"'):
        if written == f"{quote}{word.text}{quote}":
            return (Edit(span=word.span, text=f"{quote}{name}{quote}"),)
    return ()


def in_quotes(text: str) -> str:
    """A text of one line as a quoted scalar of YAML, with as few escapes as possible."""
    if "'" in text and not {'"', "\\"} & set(text):
        return f'"{text}"'
    return "'" + text.replace("'", "''") + "'"


def guesser(candidates: Iterable[str]) -> Guesser:
    """The guesser for some names."""
    return Guesser(candidates)


def words_of(*names: str) -> set[str]:
    """The words and numbers in names, in lower case: `found` and `pose` of `found_pose`."""
    return {word.lower() for name in names for word in _WORDS.findall(name)}
