"""Source texts, spans and positions: the foundation of all other rooms."""

from __future__ import annotations

from bisect import bisect_right
from functools import cached_property
from operator import attrgetter
from pathlib import PurePath
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
    def file_name(self) -> str:
        """The name without its folder."""
        return PurePath(self.name).name

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

    @cached_property
    def pieces(self) -> list[Piece]:
        """The pieces of the text in their order, without gaps: one, unless an editor changes it."""
        return [Piece(self, 0)]

    def piece_at(self, offset: int) -> Piece:
        """The piece in which an offset is."""
        pieces = self.pieces
        if len(pieces) == 1:
            return pieces[0]
        return pieces[max(bisect_right(pieces, offset, key=_begin) - 1, 0)]

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


_begin = attrgetter("begin")


class Piece:
    """A part of a text, to which spans are relative: a whole text, or a state of a text in an
    editor. After an edit before it, `Source.pieces` moves it into the new text: what has been
    computed from the state stays valid, with its spans."""

    __slots__ = ("begin", "source")

    def __init__(self, source: Source, begin: int) -> None:
        self.source = source
        self.begin = begin


class _Range(NamedTuple):
    """A range of a piece, as offsets in characters from its begin."""

    piece: Piece
    first: int
    last: int


class Span(_Range):
    """A range of a source, as offsets in characters: `start` included, `end` excluded."""

    __slots__ = ()

    def __new__(cls, source: Source, start: int, end: int) -> Span:
        piece = source.piece_at(start)
        return new_tuple(cls, (piece, start - piece.begin, end - piece.begin))

    def __getnewargs__(self) -> tuple[Source, int, int]:
        return self.source, self.start, self.end

    @property
    def source(self) -> Source:
        return self.piece.source

    @property
    def start(self) -> int:
        return self.piece.begin + self.first

    @property
    def end(self) -> int:
        return self.piece.begin + self.last

    @property
    def line(self) -> int:
        return self.source.position(self.start)[0]

    @property
    def column(self) -> int:
        return self.source.position(self.start)[1]

    @property
    def text(self) -> str:
        begin = self.piece.begin
        return self.piece.source.text[begin + self.first : begin + self.last]

    def __str__(self) -> str:
        line, column = self.source.position(self.start)
        return f"{self.source.name}:{line}:{column}"

    def __repr__(self) -> str:
        return f"Span({self})"


class Word(NamedTuple):
    """A name and its span."""

    text: str
    span: Span


new_tuple = tuple.__new__
"""A maker of named tuples, `new_tuple(Word, (text, span))`. It takes half of the time of a call of
their class: a long script has millions of spans."""

NOWHERE = Span(Source("<none>", ""), 0, 0)
"""The span of nodes without a text: machines made by a program, such as a test."""


def assert_never(value: NoReturn) -> NoReturn:
    """The end of a `match` over all kinds; to reach it is a bug of smachac."""
    raise AssertionError(f"unexpected kind: {value!r}")
