"""Terminal output: width of text in columns; control and invisible characters are made visible."""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from typing import NamedTuple
from unicodedata import category, combining, east_asian_width

TAB = 4
"""Columns between two tab stops."""

ELLIPSIS = "…"
COMMAND = "##["
"""The beginning of a command of GitHub Actions and Azure Pipelines, anywhere in a line of a log;
its bracket is printed as `<U+005B>`."""

LEAD = 8
"""Columns kept before a span that is wider than the screen."""


class Line(NamedTuple):
    """A part of a source line as printed, and the columns of its characters.

    `starts` are the columns of the characters from `first` on, before the part from `left` to
    `right` was cut out, and the column of the end.
    """

    text: str
    first: int
    starts: list[int]
    left: int
    right: int

    def column(self, index: int) -> int:
        """The column of a character of the source line; for a character that was cut off, the
        edge."""
        start = self.starts[min(max(index - self.first, 0), len(self.starts) - 1)]
        return min(max(start, self.left), self.right) - self.left


def _joins(character: str) -> bool:
    """Whether a character is drawn over the one before it (marks, Hangul vowels and finals)."""
    return (
        combining(character) != 0
        or category(character) in ("Mn", "Me")
        or "\u1160" <= character <= "\u11ff"
    )


def _glyph(character: str, *, alone: bool) -> tuple[str, int]:
    """The printed form of a character that is no tab, and its width in columns.

    No character can control the terminal or stay invisible: control characters are printed as
    pictures (Unicode block 2400), other invisible characters as `<U+202E>`.
    """
    if " " <= character <= "~":
        return character, 1
    if character < " ":
        return chr(0x2400 + ord(character)), 1
    if character == "\x7f":
        return "\u2421", 1
    if category(character) in ("Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp", "Zs") or (
        alone and _joins(character)
    ):
        name = f"<U+{ord(character):04X}>"
        return name, len(name)
    if _joins(character):
        return character, 0
    return character, 2 if east_asian_width(character) in "WF" else 1


def _glyphs(text: str) -> tuple[list[str], list[int]]:
    """The printed form of each character, and the columns where they start and the last one
    ends."""
    if text.isascii() and text.isprintable() and COMMAND not in text:
        return list(text), list(range(len(text) + 1))
    printed: list[str] = []
    starts = [0]
    known = {character: _glyph(character, alone=False) for character in {*text}}
    for character in text:
        if character == "\t":
            size = TAB - starts[-1] % TAB
            glyph = " " * size
        elif character == "[" and printed[-2:] == ["#", "#"]:
            glyph = "<U+005B>"
            size = len(glyph)
        elif printed:
            glyph, size = known[character]
        else:
            glyph, size = _glyph(character, alone=True)
        printed.append(glyph)
        starts.append(starts[-1] + size)
    return printed, starts


def visible(text: str) -> str:
    """A text with all invisible characters made visible, except line feeds. No line is a command of
    a CI log."""
    return "\n".join(_no_command("".join(_glyphs(line)[0])) for line in text.split("\n"))


def wrapped(text: str, room: int) -> list[str]:
    """The lines of a text, at most `room` columns each; broken at spaces, not in code between
    backticks. A longer word has a line of its own."""
    if columns(text) <= room:
        return [text]
    first, *words = re.findall(r"(?:`[^`]*`|\S)+", text) or [text]
    lines = [first]
    for word in words:
        longer = f"{lines[-1]} {word}"
        if columns(longer) <= room:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines


def linked(text: str, uri: str) -> str:
    """A text that opens a file, in terminals that support it (OSC 8)."""
    return f"\x1b]8;;{uri}\x1b\\{text}\x1b]8;;\x1b\\"


def _no_command(line: str) -> str:
    """A line that does not begin with `::`, as a command of GitHub Actions does."""
    return line.replace(":", "<U+003A>", 1) if line.lstrip().startswith("::") else line


def on_one_line(text: str) -> str:
    """A text with all invisible characters and line feeds made visible: it cannot begin a line, as
    a command of GitHub Actions would."""
    return visible(text).replace("\n", "␊")


def columns(text: str) -> int:
    """The width of a text without tabs and line feeds, in columns."""
    return _glyphs(text)[1][-1]


def _left_edge(start: int, end: int, total: int, room: int) -> int:
    """The first column of the window that shows a span of a long line."""
    span = end - start
    before = (room - span) // 2 if span + 2 < room else LEAD
    return max(0, min(start - before, total - room + 1))


def lay_out(text: str, start: int, end: int, room: int) -> Line:
    """A line in at most `room` columns in which the characters `start` to `end` are visible.

    Only the neighbourhood of the span is examined, so that the cost does not depend on the length
    of the line.
    """
    room = max(room, 20)
    low, high = max(0, start - room), min(len(text), start + room)
    printed, starts = _glyphs(text[low:high])
    total = starts[-1]
    if low == 0 and high == len(text) and total <= room:
        return Line("".join(printed), 0, starts, 0, total)
    from_column = starts[min(start, high) - low]
    to_column = starts[min(max(end, start), high) - low]
    left = 0
    if low > 0 or (to_column >= room and from_column > room // 3):
        left = _left_edge(from_column, to_column, total, room)
    cut_left = low > 0 or left > 0
    first = bisect_left(starts, left + cut_left, hi=len(printed))
    limit = left + room
    cut_right = high < len(text) or total > limit
    last = max(first, bisect_right(starts, limit - cut_right) - 1)
    shown = ELLIPSIS * cut_left + "".join(printed[first:last]) + ELLIPSIS * cut_right
    return Line(shown, low, starts, starts[first] - cut_left, starts[last])
