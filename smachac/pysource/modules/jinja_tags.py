"""The tags in the text of a Jinja template, found in linear time, also where they do not end."""

from __future__ import annotations

import re
from collections.abc import Iterator

_OPENING = re.compile(r"\{[#%{]")
_META = r"\{%[-+]?\s*block\s+meta\b[^%]*%\}"
_END = re.compile(r"\{%[-+]?\s*endblock[^%]*%\}")
_CLOSING = {"#": "#}", "%": "%}", "{": "}}"}


def tags(text: str, kinds: str = "#%{") -> Iterator[tuple[int, int]]:
    """The start and end of each tag. `kinds` are the second characters of their openings: `#` for
    comments, `%` for statements, `{` for expressions."""
    left = set(kinds)
    at = 0
    while left and (found := _OPENING.search(text, at)):
        start = found.start()
        kind = text[start + 1]
        end = text.find(_CLOSING[kind], start + 2) if kind in left else -1
        if end >= 0:
            yield start, end + 2
            at = end + 2
        else:
            left.discard(kind)  # no later one ends
            at = start + 1


def replaced(text: str, ranges: Iterator[tuple[int, int]], how: dict[str, str]) -> str:
    """A text in which every character of some ranges but line ends is replaced: `how` has the
    replacement by the first two characters of a range, a space by default."""
    parts, at = [], 0
    for start, end in ranges:
        fill = how.get(text[start : start + 2], " ")
        lines = text[start:end].split("\n")
        parts += [text[at:start], "\n".join(fill * len(line) for line in lines)]
        at = end
    return "".join([*parts, text[at:]])


def meta_block(text: str) -> tuple[int, int, int, int] | None:
    """The start of the first `{% block meta %}`, the start and end of its text, and the end of its
    closing tag; None without one that ends."""
    opening = re.search(_META, text)
    closing = _END.search(text, opening.end()) if opening is not None else None
    if opening is None or closing is None:
        return None
    return opening.start(), opening.end(), closing.start(), closing.end()
