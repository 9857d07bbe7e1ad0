"""Source texts, spans and positions: the foundation of all other rooms."""

from __future__ import annotations

from bisect import bisect_right
from functools import cached_property
from typing import Literal, NamedTuple, NoReturn

from smachac.records import dataclass


@dataclass(frozen=True, eq=False)
class Source:
    """A text and its name (a path as the user gave it), and the language of the states in it.

    Two sources are equal only if they are the same object.
    """

    name: str
    text: str
    language: Literal["yaml", "python"] = "yaml"

    @cached_property
    def line_starts(self) -> list[int]:
        """Offset of the first character of each line (lines end with a line feed)."""
        starts = [0]
        find = self.text.find
        at = find("\n")
        while at >= 0:
            starts.append(at + 1)
            at = find("\n", at + 1)
        return starts

    def position(self, offset: int) -> tuple[int, int]:
        """Line and column of an offset, both counted from 1."""
        line = bisect_right(self.line_starts, offset)
        return line, offset - self.line_starts[line - 1] + 1

    def line(self, number: int) -> str:
        """The text of a line (counted from 1) without its end; empty after the last line."""
        starts = self.line_starts
        if not 1 <= number <= len(starts):
            return ""
        end = starts[number] - 1 if number < len(starts) else len(self.text)
        return self.text[starts[number - 1] : end].rstrip("\r")


class Span(NamedTuple):
    """A range of a source, as offsets in characters: `start` included, `end` excluded."""

    source: Source
    start: int
    end: int

    @property
    def line(self) -> int:
        return self.source.position(self.start)[0]

    @property
    def column(self) -> int:
        return self.source.position(self.start)[1]

    @property
    def text(self) -> str:
        return self.source.text[self.start : self.end]

    def __str__(self) -> str:
        line, column = self.source.position(self.start)
        return f"{self.source.name}:{line}:{column}"

    def __repr__(self) -> str:
        return f"Span({self})"


NOWHERE = Span(Source("<none>", ""), 0, 0)
"""The span of nodes without a text: machines made by a program, such as a test."""


class Word(NamedTuple):
    """A name and its span."""

    text: str
    span: Span


new_tuple = tuple.__new__
"""A maker of named tuples, `new_tuple(Word, (text, span))`. It takes half of the time of a call of
their class: a long script has millions of spans."""


def assert_never(value: NoReturn) -> NoReturn:
    """The end of a `match` over all kinds; to reach it is a bug of smachac."""
    raise AssertionError(f"unexpected kind: {value!r}")
