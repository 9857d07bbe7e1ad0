"""Python source as a formatter would lay it out: literals, and calls that break when too long."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from smachac.ir.nodes import Data, Expression, Struct

WIDTH = 88
"""The line length of Black and of Ruff's formatter."""


@dataclass(frozen=True, slots=True)
class Group:
    """Items between brackets: on one line where they fit, else one a line with a last comma."""

    opening: str
    items: tuple[tuple[str, Doc], ...]
    closing: str


Doc = str | Group


def flat(doc: Doc) -> str:
    """The text on one line."""
    if isinstance(doc, str):
        return doc
    return (
        f"{doc.opening}{', '.join(prefix + flat(item) for prefix, item in doc.items)}{doc.closing}"
    )


def laid_out(doc: Doc, width: int, before: int = 0, after: int = 0) -> str:
    """The text within a width, after `before` characters on its first line and with `after` more
    behind its last. Lines but the first are indented by what they need beyond the first's."""
    line = flat(doc)
    if isinstance(doc, str) or not doc.items or before + len(line) + after <= width:
        return line
    lines = [doc.opening]
    for prefix, item in doc.items:
        text = laid_out(item, width - 4, len(prefix), 1)
        lines.append("    " + prefix + text.replace("\n", "\n    ") + ",")
    lines.append(doc.closing)
    return "\n".join(lines)


def call(function: str, arguments: Iterable[tuple[str, Doc]]) -> Group:
    """A call; an argument's prefix is `name=` or nothing."""
    return Group(f"{function}(", tuple(arguments), ")")


def names(words: Iterable[str]) -> Group:
    """A list of strings."""
    return Group("[", tuple(("", string(word)) for word in words), "]")


def mapping(pairs: Iterable[tuple[str, Doc]]) -> Group:
    """A dict with strings as keys."""
    return Group("{", tuple((f"{string(key)}: ", value) for key, value in pairs), "}")


def string(text: str) -> str:
    """A string literal in double quotes, in single ones where that saves escapes."""
    literal = repr(text)
    if literal[0] == '"' or '"' in text:
        return literal
    return f'"{literal[1:-1]}"'


def literal(data: Data) -> Doc:
    """A value; expressions stand as they were written."""
    match data:
        case Expression(text=text):
            return " ".join(text.split("\n"))
        case Struct(entries=entries):
            return mapping((key, literal(value)) for key, value in entries)
        case tuple():
            return Group("[", tuple(("", literal(item)) for item in data), "]")
        case str():
            return string(data)
        case float() if not math.isfinite(data):
            return f'float("{data}")'
    return repr(data)
