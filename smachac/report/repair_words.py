"""Repairs in words, made from their edits."""

from __future__ import annotations

import re

from smachac.diagnostics.repair import Repair, edited_texts
from smachac.diagnostics.source import Span

LONGEST = 100
"""In characters. A longer piece is not shown as the text to write."""


def in_words(repair: Repair, finding: Span) -> str:
    """What to write, for the finding at a place: `did you mean X?` for one name, else the line."""
    first, *others = repair.edits
    old, new = first.span.text, first.text
    if not others and old.isidentifier() and new.isidentifier():
        return f"did you mean `{new}`{_instead(first.span, finding)}?"
    (source, text), *rest = edited_texts(repair.edits).items()
    start = _start_of_entry(source.text, min(edit.span.start for edit in repair.edits))
    end = max(edit.span.end for edit in repair.edits)
    changed = Span(source, start, end)
    lines = _lines(changed, finding)
    if all(not edit.text for edit in repair.edits) and "\n" in changed.text:
        return f"delete {lines}"
    piece = text[start : end + len(text) - len(source.text)]
    if rest or "\n" in changed.text + piece or len(piece) > LONGEST:
        return f"change {lines}: {repair.operator}"
    if not old and not others:
        piece = text.split("\n")[changed.line - 1].strip()
    return f"write `{piece}`" + ("" if _here(changed, finding) else f" in {lines}")


def _start_of_entry(text: str, start: int) -> int:
    """The start of the name before a value, if the edits start with the value."""
    name = re.search(r"[\w-]+: *$", text[text.rfind("\n", 0, start) + 1 : start])
    return start - len(name[0]) if name else start


def _here(one: Span, other: Span) -> bool:
    return one.source is other.source and one.line == other.line


def _instead(span: Span, finding: Span) -> str:
    """The place of a word that is not on the line of the finding."""
    return "" if _here(span, finding) else f" in place of `{span.text}` in {_lines(span, finding)}"


def _lines(span: Span, finding: Span) -> str:
    """`line 3`, or `lines 3 to 5`; with the file, if it is not that of the finding."""
    last = span.source.position(max(span.start, span.end - 1))[0]
    lines = f"line {span.line}" if last == span.line else f"lines {span.line} to {last}"
    return lines if span.source is finding.source else f"{lines} of {span.source.name}"
