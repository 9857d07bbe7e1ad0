"""Markdown: tables, and text in which nothing is markup."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from smachac.report.terminal import visible

_MARKUP = re.compile(r"[\\`*<\[\]|]|\b_|_\b")
"""Characters that are markup in Markdown."""


def cell(text: str) -> str:
    """A text with its Markdown characters escaped, on one line."""
    return _MARKUP.sub(r"\\\g<0>", visible(text).replace("\n", " "))


def table(heads: Iterable[str], rows: Iterable[Iterable[str]]) -> Iterator[str]:
    """The lines of a table."""
    titles = list(heads)
    yield _row(titles)
    yield "|" + " --- |" * len(titles)
    yield from map(_row, rows)


def _row(cells: Iterable[str]) -> str:
    return f"| {' | '.join(map(cell, cells))} |"
