"""Positions of the protocol: lines and columns counted from 0, columns in units of an encoding."""

from __future__ import annotations

import re
from bisect import bisect_right
from typing import Literal

Encoding = Literal["utf-8", "utf-16", "utf-32"]

_LINE_END = re.compile(r"\r\n|\r|\n")


class Positions:
    """The positions of one text. A line ends with a line feed, a carriage return or both."""

    def __init__(self, text: str, encoding: Encoding = "utf-16") -> None:
        self.text = text
        self.encoding = encoding
        self.starts = [0, *(end.end() for end in _LINE_END.finditer(text))]

    def at(self, offset: int) -> tuple[int, int]:
        """Line and column of an offset in characters."""
        offset = min(max(offset, 0), len(self.text))
        line = bisect_right(self.starts, offset) - 1
        before = self.text[self.starts[line] : offset]
        return line, len(before) if before.isascii() else self._units(before)

    def offset(self, line: int, column: int) -> int:
        """The offset of a position; beyond the end of a line, that end."""
        if line >= len(self.starts):
            return len(self.text)
        start = self.starts[line]
        end = self.starts[line + 1] if line + 1 < len(self.starts) else len(self.text)
        words = _LINE_END.sub("", self.text[start:end])
        if words.isascii():
            return start + min(column, len(words))
        for number, character in enumerate(words):
            if column <= 0:
                return start + number
            column -= self._units(character)
        return start + len(words)

    def _units(self, text: str) -> int:
        match self.encoding:
            case "utf-8":
                return len(text.encode("utf-8", "surrogatepass"))
            case "utf-16":
                return len(text) + sum(character > "\uffff" for character in text)
        return len(text)
