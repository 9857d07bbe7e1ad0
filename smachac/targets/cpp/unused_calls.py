"""Calls in `execute` of a C++ class whose `bool` result decides an outcome and is not used.

The type of the result is in a header of the project: the member of the class is an object of a
class with one method of that name, which returns `bool`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from smachac.diagnostics.source import Word
from smachac.frontend.loader import Library
from smachac.targets.cpp.cpp_text import Part, without_literals

_CALL = re.compile(
    r"(?:\A|(?<=[;{}]))\s*(?P<call>(?P<object>\w+)\s*(?:\.|->)\s*(?P<method>\w+)\s*\()"
)
_INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]*)"', re.M)
_END = re.compile(r"\s*;\s*(?:(?P<return>return\s+Outcome\s*::\s*(?P<outcome>\w+))\s*;)?")


class UnusedCall(NamedTuple):
    """A call whose result is not used: its text and place with the `return` of an outcome that
    follows it, if there is one, and the name of that outcome; the name of its method."""

    word: Word
    method: str
    outcome: str


def unused_call(body: Part, run: Part, library: Library) -> UnusedCall | None:
    """The only call of a function that returns `bool` whose result `execute` does not use."""
    found = [
        match_
        for match_ in _CALL.finditer(run.text)
        if _returns_bool(body, match_["object"], match_["method"], library)
    ]
    if len(found) != 1:
        return None
    (one,) = found
    close = _closing(run.text, one.end())
    end = _END.match(run.text, close + 1) if close is not None else None
    if close is None or end is None:
        return None
    start = run.start + one.start("call")
    text = " ".join(run.source.text[start : run.start + close + 1].split())
    last = end.end("return") if end["outcome"] else close + 1
    word = run.word(text, one.start("call"), last)
    return UnusedCall(word, one["method"], end["outcome"] or "")


def _closing(text: str, at: int) -> int | None:
    """The place of the parenthesis that closes the one before a place."""
    depth = 1
    for found in re.compile(r"[()]").finditer(text, at):
        depth += 1 if found.group() == "(" else -1
        if depth == 0:
            return found.start()
    return None


def _returns_bool(body: Part, member: str, method: str, library: Library) -> bool:
    """Whether the class of a member has one method of a name, which returns `bool`."""
    declared = re.search(rf"\b(\w+)\s*[&*]?\s*\b{re.escape(member)}\s*;", body.text)
    if declared is None:
        return False
    head = re.compile(rf"\b(?:class|struct)\s+{declared[1]}\b[^;(){{}}]*\{{")
    for part in _headers(body, library):
        found = head.search(part.text)
        inside = part.inside(found)
        if inside is not None:
            types = re.findall(rf"(\w+)\s+{re.escape(method)}\s*\(", inside.text)
            return types == ["bool"]
    return False


def _headers(body: Part, library: Library) -> Iterator[Part]:
    """The header of a class, and those of the project that it includes."""
    source = body.source
    yield Part(source=source, text=without_literals(source.text))
    for name in _INCLUDE.findall(source.text):
        other = library.code(name) if not name.startswith("smachac/") else None
        if other is not None and len(other.text) <= 200_000:
            yield Part(source=other, text=without_literals(other.text))
