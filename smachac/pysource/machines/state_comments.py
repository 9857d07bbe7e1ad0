"""Comments that describe states which the evaluator cannot see: `# smachac: outcomes done, failed`,
`# smachac: input_keys part` and `# smachac: output_keys pose`.

A comment at the end of a line describes the state that a call in this line adds, a comment on a
line of its own that of the next line with code.
"""

from __future__ import annotations

import contextlib
import io
import re
import tokenize
from collections.abc import Iterator

from smachac.diagnostics.source import Source, Span, Word
from smachac.records import dataclass

VERBS = ("outcomes", "input_keys", "output_keys")
"""The words after `smachac:` in such comments: the parameters of `smach.State`."""

_COMMENT = re.compile(rf"#\s*smachac:\s*({'|'.join(VERBS)})\b(.*)")
_NAME = re.compile(r"[^\s,]+")


@dataclass(frozen=True, slots=True, kw_only=True)
class StateComment:
    """What comments say about a state; None: nothing."""

    outcomes: tuple[Word, ...] | None = None
    input_keys: tuple[Word, ...] | None = None
    output_keys: tuple[Word, ...] | None = None


class StateComments:
    """The comments about states of the files that were read; `used` are those at states that are
    not known."""

    def __init__(self) -> None:
        self.by_source: dict[Source, list[tuple[int, str, Span, tuple[Word, ...]]]] = {}
        self.used: set[Span] = set()

    def at(self, span: Span) -> StateComment:
        """The comments in the lines of a call, or before it."""
        first, last = span.line, span.source.position(max(span.end - 1, span.start))[0]
        found: dict[str, tuple[Word, ...]] = {}
        for line, verb, place, words in self._of(span.source):
            if first <= line <= last and words:
                found[verb] = words
                self.used.add(place)
        return StateComment(**found)

    def forget(self, file: str) -> None:
        """Forgets the comments of a file that has another text now."""
        self.by_source = {source: found for source, found in self.by_source.items()
                          if source.name != file}  # fmt: skip
        self.used = {place for place in self.used if place.source.name != file}

    def unused(self, source: Source) -> list[Span]:
        """The comments of a file that describe no state, or one that is known."""
        return [place for _, _, place, _ in self._of(source) if place not in self.used]

    def _of(self, source: Source) -> list[tuple[int, str, Span, tuple[Word, ...]]]:
        if source not in self.by_source:
            self.by_source[source] = [*_comments(source)]
        return self.by_source[source]


def _comments(source: Source) -> Iterator[tuple[int, str, Span, tuple[Word, ...]]]:
    """The comments about states, each with the line that it is about, counted from 1."""
    if "smachac:" not in source.text:
        return
    waiting: list[tuple[str, Span, tuple[Word, ...]]] = []
    with contextlib.suppress(tokenize.TokenError, SyntaxError):
        for token in tokenize.generate_tokens(io.StringIO(source.text, newline="\n").readline):
            line, column = token.start
            if token.type in (tokenize.NL, tokenize.INDENT, tokenize.DEDENT):
                continue
            if token.type != tokenize.COMMENT:
                yield from ((line, *comment) for comment in waiting)
                waiting.clear()
                continue
            found = _COMMENT.match(token.string)
            if found is None:
                continue
            start = source.line_starts[line - 1] + column
            place = Span(source, start, start + len(token.string.rstrip()))
            names = _NAME.finditer(token.string, found.start(2), found.end(2))
            words = tuple(
                Word(name.group(), Span(source, start + name.start(), start + name.end()))
                for name in names
            )
            if token.line[:column].strip():
                yield line, found.group(1), place, words
            else:
                waiting.append((found.group(1), place, words))
