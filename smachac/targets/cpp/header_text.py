"""Text of a C++ header without comments and literals, and parts of it between braces."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from smachac.diagnostics.source import Source, Span, Word

_NO_CODE = re.compile(
    r"""(?P<kept>\b\d[\w.']*)|//[^\n]*|/\*.*?(?:\*/|\Z)|"(?:\\.|[^"\\\n])*"?|'(?:\\.|[^'\\\n])*'?""",
    re.DOTALL,
)
"""Comments and literals. A literal that is not closed ends with its line: a search for the quote
from each start would take quadratic time."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """A part of a header, without comments and string literals; `start` is its offset."""

    source: Source
    text: str
    start: int = 0

    def word(self, text: str, at: int, end: int) -> Word:
        return Word(text, Span(self.source, self.start + at, self.start + end))

    def only(self, pattern: str) -> re.Match[str] | None:
        """The match of a pattern, if there is exactly one."""
        found = list(re.finditer(pattern, self.text))
        return found[0] if len(found) == 1 else None

    def member(self, pattern: str) -> re.Match[str] | None:
        """The match of a pattern outside braces, if the pattern has exactly one match."""
        found = self.only(pattern)
        before = self.text[: found.start()] if found is not None else ""
        return found if before.count("{") == before.count("}") else None

    def members(self, pattern: re.Pattern[str]) -> Iterator[re.Match[str]]:
        """The matches of a pattern outside the braces in this part."""
        at = depth = 0
        for found in pattern.finditer(self.text):
            depth += self.text.count("{", at, found.start())
            depth -= self.text.count("}", at, found.start())
            at = found.start()
            if depth == 0:
                yield found

    def inside(self, head: re.Match[str] | None) -> Part | None:
        """The part between the brace at the end of a head and the matching closing brace."""
        depth = 1
        for found in re.finditer(r"[{}]", self.text[head.end() :]) if head is not None else ():
            depth += 1 if found.group() == "{" else -1
            if depth == 0 and head is not None:
                text = self.text[head.end() : head.end() + found.start()]
                return Part(source=self.source, text=text, start=self.start + head.end())
        return None

    def split(self, mark: str) -> Iterator[tuple[int, str]]:
        """The pieces between marks that are not blank, each with its offset."""
        at = 0
        for piece in self.text.split(mark):
            if piece.strip():
                yield at, piece
            at += len(piece) + 1


def without_literals(text: str) -> str:
    """C++ in which comments and literals, except numbers, are replaced by blanks: every other
    character keeps its offset."""
    return _NO_CODE.sub(_blank, text)


def _blank(found: re.Match[str]) -> str:
    return found["kept"] or re.sub(r"[^\n]", " ", found.group())
