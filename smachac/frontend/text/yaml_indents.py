"""Repairs of a wrong indentation: a row, with or without those inside it, is moved to a column of
its neighbours, if the text then has the form of a script.

The finding is about the row that is moved, which is often not the one at which a parser stops.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from smachac.diagnostics.diagnostic import Diagnostic
from smachac.diagnostics.repair import Certainty, Edit, Repair
from smachac.diagnostics.source import Source, Span
from smachac.frontend.errors.script import yaml_syntax
from smachac.frontend.text.yaml_errors import of_spaces
from smachac.frontend.text.yaml_outline import (
    Row,
    dangling_count,
    form_of,
    outline,
    rows_of,
    steps_in,
    unusual_steps,
)
from smachac.frontend.text.yaml_tree import OffsetMap

_ABOVE, _BELOW, _HEADS, _COLUMNS, _PARTS = 150, 100, 16, 8, 6
"""Limits of the rows above and below a fault that are read, of those that are moved for trial, of
the columns to which they are, and of the rows inside them that stay."""

_BAD, _EQUAL = 1.0, 1e-9
"""The least cost of a form that is wrong, and the difference of two repairs that are as good."""


class Move(NamedTuple):
    """The rows of `rows` from the number `first` up to `last`, moved by a number of columns."""

    rows: tuple[Row, ...]
    first: int
    last: int
    by: int

    def apply(self) -> list[Row]:
        moved = [row.moved(self.by) for row in self.rows[self.first : self.last]]
        return [*self.rows[: self.first], *moved, *self.rows[self.last :]]

    @property
    def like(self) -> Row | None:
        """The nearest row above, or else below, beside which the first one stands then."""
        rows = self.apply()
        here = rows[self.first]
        for others in (reversed(rows[: self.first]), rows[self.last :]):
            for row in others:
                column = row.column if here.dashes else row.key_column
                if column == here.column and bool(row.dashes) >= bool(here.dashes):
                    return row
                if row.column < here.column:
                    break
        return None


def best_move(text: str, index: int, *, stops: bool) -> Move | None:
    """The move of rows after which a text has the form of a script; None if there is none, or if
    another one is as good. `stops`: the text is no YAML, because of a fault near the index."""
    every = rows_of(text)
    line = text.count("\n", 0, index)
    at = next((n for n, row in enumerate(every) if row.last >= line), len(every) - 1)
    if at < 0:
        return None
    rows, here = _window(every, at)
    usual = steps_in(rows)
    whole = outline(rows)
    before, dangling = form_of(whole), dangling_count(whole)
    if before < _BAD or (stops and whole is not None):
        return None
    ranked: list[tuple[float, Move]] = []
    for move in dict.fromkeys(_moves(rows, here)):
        moved = move.apply()
        new = outline(moved)
        form = form_of(new)
        if form > before - _BAD / 2 or form >= (_BAD if stops else _BAD / 2):
            continue
        lost = dangling_count(new)
        if not stops and moved[move.first].dashes and lost >= dangling:
            continue
        cost = form + 0.4 * lost + 0.11 * unusual_steps(moved, usual)
        ranked.append((cost + 0.001 * (move.last - move.first) + 0.0001 * abs(move.by), move))
    ranked.sort(key=lambda pair: pair[0])
    if not ranked or (len(ranked) > 1 and ranked[1][0] - ranked[0][0] < _EQUAL):
        return None
    return ranked[0][1]


def _window(every: list[Row], at: int) -> tuple[tuple[Row, ...], int]:
    """The rows around one, after those that hold the first of them; and its number there."""
    first, last = max(0, at - _ABOVE), at + _BELOW
    around: list[Row] = []
    least = every[first].column
    for row in reversed(every[:first]):
        if row.column < least:
            least = row.column
            around.append(row)
    return (*reversed(around), *every[first:last]), at - first + len(around)


def _moves(rows: tuple[Row, ...], here: int) -> Iterator[Move]:
    """The moves of the rows at and above one: of each alone, with the rows inside it, and with
    those after it at its column."""
    heads: list[int] = []
    least = 1_000
    for number in range(min(here + 1, len(rows) - 1), -1, -1):
        near = here - number < _HEADS // 2
        if near or (rows[number].column < least and len(heads) < _HEADS):
            heads.append(number)
        if number < here:
            least = min(least, rows[number].column)
    for head in heads:
        row = rows[head]
        for column in _columns(rows, head):
            for last in _ends(rows, head):
                yield Move(rows, head, last, column - row.column)


def _ends(rows: Sequence[Row], head: int) -> list[int]:
    """The numbers after the rows that can be moved together with one."""
    row = rows[head]
    last = _end(rows, head, row.column + 1)
    ends = {head + 1, last, _run(rows, head)}
    if last > head + 1:
        column = rows[head + 1].column
        ends.add(_end(rows, head, column))
        inside = [at for at in range(head + 2, last) if rows[at].column <= column]
        ends.update(inside[:_PARTS])
    return sorted(ends)


def _end(rows: Sequence[Row], head: int, column: int) -> int:
    """The number after the rows below one that are not left of a column."""
    last = head + 1
    while last < len(rows) and rows[last].column >= column:
        last += 1
    return last


def _run(rows: Sequence[Row], head: int) -> int:
    """The number after the rows at and below one that have its kind and its column."""
    last, row = head + 1, rows[head]
    while last < len(rows) and rows[last].column >= row.column:
        same = rows[last].column == row.column
        if same and bool(rows[last].dashes) != bool(row.dashes):
            break
        last += 1
    return last


def _columns(rows: Sequence[Row], head: int) -> list[int]:
    """The columns to which a row can be moved, those of rows near it."""
    row = rows[head]
    found: dict[int, None] = {}
    near = sorted(
        (other for other in rows if other is not row),
        key=lambda other: (abs(other.line - row.line), other.line),
    )
    for other in near:
        if bool(row.dashes) != bool(other.dashes) and row.dashes:
            continue
        column = other.column if row.dashes else other.key_column
        if column != row.column and (not other.dashes or row.dashes):
            found.setdefault(column)
        if len(found) >= _COLUMNS:
            break
    above = rows[head - 1] if head else None
    if above is not None and above.key and not above.value:
        found.setdefault(above.key_column + 2)
    return [column for column in found if column != row.column]


def moved_text(text: str, move: Move, before: OffsetMap) -> tuple[str, OffsetMap]:
    """The text in which the lines of a move are moved, and the changes with those before."""
    changes: list[tuple[int, int, int]] = []
    shift = 0
    for at, taken, added in _shifts(text, move):
        text = text[: at + shift] + " " * added + text[at + shift + taken :]
        changes.append((at + shift, taken, added))
        shift += added - taken
    return text, OffsetMap(text, (*before.changes, *changes))


def _shifts(text: str, move: Move) -> Iterator[tuple[int, int, int]]:
    """The index of each line that moves, and the numbers of spaces that it loses and gets."""
    first, last = move.rows[move.first], move.rows[move.last - 1]
    at = first.start
    for line in text[at:].split("\n")[: last.last - first.line + 1]:
        if line.strip():
            indent = len(line) - len(line.lstrip(" "))
            yield at, min(indent, max(0, -move.by)), max(0, move.by)
        at += len(line) + 1


def move_finding(
    source: Source, text: str, before: OffsetMap, move: Move, *, stops: bool
) -> Diagnostic:
    """SM001 for a row at a wrong column of a text. `stops`: it is no YAML because of it."""
    row, like = move.rows[move.first], move.like
    start = before.back(row.start + row.column)
    length = row.key_column - row.column + len(row.key) + bool(row.dashes)
    column = row.column + move.by
    name = _shown(row)
    how = f"indent {name} by {of_spaces(column)}" if column else f"write {name} in the first column"
    message = f"{name} is indented by {of_spaces(row.column)}"
    if like is not None:
        how += f", like {_shown(like)}"
        message += f", {_shown(like)} beside it by {column}"
    if row.dashes and row.key and not stops:
        owner = _container(move.rows, move.first)
        message = f"{name} is indented as a state of {owner}"
    if move.last == move.first + 2:
        how += f", and move {_shown(move.rows[move.last - 1])} equally"
    elif move.last > move.first + 2:
        how += f", and move the lines below it, down to {_shown(move.rows[move.last - 1])}, equally"
    edits = [
        Edit(span=Span(source, before.back(at), before.back(at + taken)), text=" " * added)
        for at, taken, added in _shifts(text, move)
    ]
    repair = Repair(edits=(*edits,), certainty=Certainty.LIKELY, operator="move lines")
    return yaml_syntax(
        Span(source, start, start + max(length, 1)),
        message,
        how,
        arguments=("indent", name, str(column)),
        effect="the indentation decides to which state or field a line belongs",
        repairs=(repair,),
    )


def _container(rows: Sequence[Row], head: int) -> str:
    """The state that holds an item of a list of states, with its kind if that limits them."""
    column = rows[head].column
    fields: dict[str, Row] = {}
    for row in reversed(rows[:head]):
        if row.column < column and row.dashes:
            template = fields.get("template", fields.get("T"))
            is_iterator = "it" in fields or (template is not None and template.value == "Iterator")
            return f"`{row.key}`" + ", an Iterator, which has one state" * is_iterator
        if row.column < column:
            fields.setdefault(row.key, row)
    return "the script"


def _shown(row: Row) -> str:
    """A row as messages name it."""
    dash = "- " if row.dashes else ""
    text = f"{row.key}:" if row.key and dash else row.key or row.value
    return f"`{dash}{text}`"
