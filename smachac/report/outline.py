"""Layout of explanations: a headline and labelled paragraphs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from smachac.analysis.def_use import Status
from smachac.diagnostics.source import NOWHERE, Span
from smachac.report.terminal import on_one_line
from smachac.report.text import shortened

STATUS: dict[Status, str] = {
    "always": "always set",
    "given": "always set, if the caller of the machine sets it",
    "sometimes": "set on some paths, not on all",
    "never": "never set",
    "unreachable": "never read, because no path leads to this state",
}
"""Whether a key is set when a state is entered, in words."""

WIDTH = 100
"""Width of a printed path, in columns."""

Paragraph = tuple[str, list[str]]
"""A label and its lines."""


def paragraphs(headline: str, parts: Iterable[Paragraph]) -> str:
    """A text that ends in a line feed; paragraphs without lines are left out."""
    filled = [(word, lines) for word, lines in parts if lines]
    size = max((len(word) for word, _ in filled), default=0)
    lines = [headline]
    for word, sentences in filled:
        first = True
        for sentence in sentences:
            lines.append(f"  {word if first else '':<{size}}  {sentence}")
            first = False
    return "".join(f"{on_one_line(line)}\n" for line in lines)


def place(span: Span) -> str:
    """A span in parentheses, printed after a text; empty for NOWHERE."""
    return "" if span.source is NOWHERE.source else f" ({span})"


def at(span: Span) -> str | None:
    """A span as `file:line:column`; None for NOWHERE."""
    return None if span.source is NOWHERE.source else str(span)


def alternatives(names: Sequence[str]) -> str:
    """A list of names in words: `a, b or c`."""
    return " or ".join(filter(None, [", ".join(names[:-1]), *names[-1:]]))


def article(noun: str) -> str:
    """A noun with its indefinite article."""
    return f"{'an' if noun[:1].lower() in 'aeiou' else 'a'} {noun}"


def way(head: str, path: tuple[str, ...]) -> Iterator[str]:
    """A path in lines of limited width; the middle of a long path is left out."""
    if not path:
        return
    line = head
    for part in shortened(path):
        if len(line) + len(part) > WIDTH and line.strip():
            yield line
            line = " " * len(head) + part.lstrip()
        else:
            line += part
    yield line
