"""Scripts in an editor: their states are pieces, and a state that did not change keeps its tree.

The text of a script is cut before each item of its list `states`. Each piece is parsed as a text of
its own, where that is sure to give the same tree.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Piece, Source, Span
from smachac.frontend.text.yaml_tree import (
    Entry,
    Map,
    ParseAnomalies,
    Scalar,
    Seq,
    Tree,
    fits_limits,
    parse_piece,
)

MOST_CHARACTERS = 500_000
"""In a longer text the number of values has to be counted."""

_LIST = re.compile(r"^states:[ \t]*\n(?:[ \t]*(?:#.*)?\n)*(?P<item>(?P<indent> *)-[ \n])", re.M)
"""The beginning of the list of states of a script."""


class PieceTree(NamedTuple):
    """A piece with its text and its tree: that of the script without states, or of one state."""

    text: str
    piece: Piece
    tree: Map | None


def _cuts(text: str) -> list[int]:
    """The indexes of the items of the list `states`, which is the last field of the script; none
    where the text is not cut."""
    if "&" in text or "\r" in text or "%" in text[:1] or "\n%" in text:
        return []  # anchors and directives hold beyond a piece
    found = [*_LIST.finditer(text)]
    if len(found) != 1 or len(text) > MOST_CHARACTERS:
        return []
    begin, width = found[0].start("item"), len(found[0]["indent"])
    item = re.compile(rf"^ {{{width}}}-[ \n]", re.M)
    other = re.compile(rf"^(?! {{{width + 1}}}| {{{width}}}-[ \n]|[ \t]*(?:#|$))", re.M)
    if other.search(text, begin) is not None:
        return []
    return [match_.start() for match_ in item.finditer(text, begin)]


def parse_in_pieces(
    source: Source, before: tuple[PieceTree, ...]
) -> tuple[Map, tuple[PieceTree, ...]] | None:
    """The tree of a script, and its pieces; None for a text that is not cut, or in which something
    is wrong: it is parsed as a whole. `before` are the pieces of the text before a change, which
    move into this one where they did not change."""
    cuts = _cuts(source.text)
    if not cuts or not fits_limits(source, []):
        return None
    pieces = [*_moved(source, [0, *cuts], before)]
    source.pieces[:] = [piece.piece for piece in pieces]
    report: Report = []
    anomalies = ParseAnomalies([], [], [])
    for number, (text, piece, tree) in enumerate(pieces):
        if tree is None:
            pieces[number] = PieceTree(text, piece, _tree(source, piece, text, report, anomalies))
    tree = None if report or any(anomalies) else _whole(source, pieces)
    if tree is None:
        source.pieces[:] = [Piece(source, 0)]
        return None
    return tree, tuple(pieces)


class PieceTrees:
    """The pieces of the last text of each file, by the name of the file."""

    def __init__(self) -> None:
        self._known: dict[str, tuple[PieceTree, ...]] = {}

    def parse(self, source: Source) -> Tree | None:
        """As `parse_in_pieces`: the tree alone. The text becomes the last one of its file."""
        found = parse_in_pieces(source, self._known.get(source.name, ()))
        if found is None:
            return None
        tree, self._known[source.name] = found
        return tree


def _moved(source: Source, cuts: list[int], before: tuple[PieceTree, ...]) -> Iterator[PieceTree]:
    """The pieces of a text, those that were in the text before with their trees."""
    known: dict[str, list[PieceTree]] = {}
    for same in reversed(before):
        known.setdefault(same.text, []).append(same)
    for begin, end in pairwise([*cuts, len(source.text)]):
        text = source.text[begin:end]
        if known.get(text):
            same = known[text].pop()
            same.piece.source, same.piece.begin = source, begin
            yield same
        else:
            yield PieceTree(text, Piece(source, begin), None)


def _tree(
    source: Source, piece: Piece, text: str, report: Report, anomalies: ParseAnomalies
) -> Map | None:
    """The mapping in a piece: the fields of the script, or the item of its list."""
    tree = parse_piece(source, piece, text, report, anomalies)
    if isinstance(tree, Seq) and len(tree.items) == 1:
        tree = tree.items[0]
    return tree if isinstance(tree, Map) else None


def _whole(source: Source, pieces: list[PieceTree]) -> Map | None:
    """The tree of a script, from those of its pieces; None if one is missing, or if the list is not
    that of the script."""
    head, *states = (piece.tree for piece in pieces)
    items = [tree for tree in states if tree is not None]
    if head is None or len(items) < len(states):
        return None
    key, nothing = head.entries[-1].key, head.entries[-1].value
    if key.value != "states" or not isinstance(nothing, Scalar) or nothing.value is not None:
        return None
    if any(entry.key.value == "it" for entry in head.entries):
        return None
    end, dash = items[-1].span.end, source.text.index("-", pieces[1].piece.begin)
    listed = Seq(tuple(items), Span(source, dash, end))
    return Map((*head.entries[:-1], Entry(key, listed)), Span(source, head.span.start, end))
