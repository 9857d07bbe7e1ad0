"""Line ends of rewritten scripts: each line keeps its own, also in a text with several kinds."""

from __future__ import annotations

import re
from collections import defaultdict, deque

_LINE = re.compile(r"([^\r\n]*)(\r\n|\r|\n|$)")


def with_line_ends(text: str, like: str) -> str:
    """A text with line feeds, with the line ends of the text that it was made from.

    A line is recognised by its content without the spaces around it. A new line has the line end of
    the line above it.
    """
    old = [match.groups() for match in _LINE.finditer(like)]
    ends = [end for _, end in old if end]
    if not ends or ends.count("\n") == len(ends):
        return text
    first = ends[0]
    if ends.count(first) == len(ends):
        return text.replace("\n", first)
    *lines, last = text.split("\n")
    parts: list[str] = []
    for line, end in zip(lines, _matched(lines, old, first), strict=True):
        if not line and end == "\n" and parts and parts[-1].endswith("\r"):
            end = "\r"  # CR and LF would be one line end
        parts.append(line + end)
    return "".join([*parts, last])


def _matched(lines: list[str], old: list[tuple[str, ...]], first: str) -> list[str]:
    """The ends of the new lines. The lines at both ends of the text that are unchanged are matched
    by their position, the others by their content, each with the first one that is left."""
    contents = [line.strip() for line in lines]
    known = [(line.strip(), end) for line, end in old if end]
    shorter = min(len(contents), len(known))
    head = 0
    while head < shorter and contents[head] == known[head][0]:
        head += 1
    tail = 0
    while tail < shorter - head and contents[-1 - tail] == known[-1 - tail][0]:
        tail += 1
    left: dict[str, deque[str]] = defaultdict(deque)
    for content, end in known[head : len(known) - tail]:
        left[content].append(end)
    ends = [end for _, end in known[:head]]
    for content in contents[head : len(contents) - tail]:
        above = ends[-1] if ends else first
        ends.append(left[content].popleft() if left[content] else above)
    return ends + [end for _, end in known[len(known) - tail :]]
