"""Text of a C++ header without comments and literals, parts of it between braces, and what is read
of a class there: its body and its outcomes (docs/targets.md)."""

from __future__ import annotations

import re
from collections.abc import Iterator

from smachac.diagnostics.source import Source, Span, Word
from smachac.records import dataclass

LONGEST = 200_000
"""The length of the longest header that is read, in characters."""

_NO_CODE = re.compile(
    r"""(?P<kept>\b\d[\w.']*)|//[^\n]*|/\*.*?(?:\*/|\Z)|"(?:\\.|[^"\\\n])*"?|'(?:\\.|[^'\\\n])*'?""",
    re.DOTALL,
)
"""Comments and literals. A literal that is not closed ends with its line: a search for the quote
from each start would take quadratic time."""


_CLASS = (
    r"(?<!enum )\b(?:class|struct)\s+(?:\w+\s+)?(?P<name>{})\b(?P<base>[^;(){{}}=]{{0,1000}})\{{"
)
_OUTCOME = r"\benum\s+(?:class|struct)\s+Outcome\b[^;{]{0,1000}\{"
_ENUMERATOR = re.compile(r"\s*(?P<name>[A-Za-z_]\w*)\s*(?:=[^,]*)?")


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


def class_head(name: str) -> str:
    """The pattern of the head of a class, up to its brace; the groups are `name` and `base`."""
    return _CLASS.format(re.escape(name))


def outcome_words(body: Part) -> tuple[Word, ...] | None:
    """The names in `enum class Outcome` in the body of a class; None where it cannot be read."""
    part = body.inside(body.member(_OUTCOME))
    if part is None or re.search(r"[\[{(]", part.text):
        return None
    words = []
    for at, piece in part.split(","):
        found = _ENUMERATOR.fullmatch(piece.rstrip())
        if found is None:
            return None
        start, end = found.span("name")
        words.append(part.word(found["name"], at + start, at + end))
    return tuple(words)
