"""Misspelt names: which one was meant, when that is certain, and the edit that mends it."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable
from functools import lru_cache

from smachac.diagnostics.diagnostic import Edit
from smachac.diagnostics.source import Word

MOST_COMPARED = 40
"""Among more names than these, only a name one slip away is found, so that ten thousand misspelt
names take no longer than they should."""

SHORTEST_SLIP = 4
"""Shorter names are one slip away from too many others: only their case may differ."""

LONGEST_SLIP = 100
"""In characters. Of longer names, which nobody types, only the case may differ: to compare them
takes time and memory as their length squared."""

SHORTEST_WRONG_LETTER = 6
"""Names as long as this may be meant for certain though a letter is another: LIFT is not LEFT."""

_PLAIN = re.compile(r"[A-Za-z_][\w./-]*", re.ASCII)
_NOT_PLAIN = frozenset(["true", "false", "null", "yes", "no", "on", "off", "y", "n"])
_NO_DIGITS = re.compile(r"\D+")


class Guesser:
    """Finds the candidate nearest to a misspelt name.

    One slip is another case, or a letter too many, missing, wrong, or in the place of the next.
    """

    def __init__(self, candidates: Iterable[str]) -> None:
        self.names = list(dict.fromkeys(candidates))
        self._index: dict[str, str] = {}
        self._shared: set[str] = set()

    def __call__(self, word: str) -> str | None:
        """The nearest name, or None."""
        index = self._slips()
        one_slip = next((index[slip] for slip in slips(word) if slip in index), None)
        if one_slip is not None or len(self.names) > MOST_COMPARED or len(word) > LONGEST_SLIP:
            return one_slip
        return next(iter(difflib.get_close_matches(word, self.names, n=1)), None)

    def sure(self, word: str) -> str | None:
        """The one name that can have been meant, or None: one slip away, with the same digits,
        and no other name is as near."""
        index = self._slips()
        near = [slip for slip in slips(word) if slip in index]
        names = {index[slip] for slip in near}
        if len(names) != 1 or not self._shared.isdisjoint(near):
            return None
        (name,) = names
        return name if name != word and _one_slip(word.casefold(), name.casefold()) else None

    def _slips(self) -> dict[str, str]:
        if not self._index:
            for name in self.names:
                for slip in dict.fromkeys(slips(name)):
                    if self._index.setdefault(slip, name) != name:
                        self._shared.add(slip)
            self._index.update((name.casefold(), name) for name in reversed(self.names))
        return self._index


@lru_cache(maxsize=8)
def guesser_of(names: tuple[str, ...]) -> Guesser:
    """The guesser of names that many words are held against."""
    return Guesser(names)


def slips(name: str) -> list[str]:
    """A name without regard to case, and without each of its letters. Two names one slip apart
    have one of these in common."""
    word = name.casefold()
    if not SHORTEST_SLIP <= len(word) <= LONGEST_SLIP:
        return [word]
    return [word, *(word[:at] + word[at + 1 :] for at in range(len(word)))]


def _one_slip(word: str, name: str) -> bool:
    """Whether two names that have a slip in common are so near that nothing else was meant."""
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
    """Whether YAML takes a name for what it is wherever it stands, without quotes."""
    return _PLAIN.fullmatch(name) is not None and name.casefold() not in _NOT_PLAIN


def respelt(word: Word, name: str | None) -> tuple[Edit, ...]:
    """The edit that makes a word of a script another name; none where it is not written there."""
    if name is None or not is_plain(name):
        return ()
    written = word.span.text
    for quote in ("", "'", '"'):
        if written == f"{quote}{word.text}{quote}":
            return (Edit(span=word.span, text=f"{quote}{name}{quote}"),)
    return ()


def guesser(candidates: Iterable[str]) -> Guesser:
    """What finds the candidate nearest to a misspelt name."""
    return Guesser(candidates)
