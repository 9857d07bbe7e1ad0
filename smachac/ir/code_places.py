"""Places in code of the script: spans of the parts of an expression.

The text of an expression is the value of a YAML scalar: without quotes, escapes and backticks.
"""

from __future__ import annotations

import ast

from smachac.diagnostics.source import Span
from smachac.ir.nodes import Expression
from smachac.ir.script_code import script_code


def place_in(code: Expression, start: int, end: int) -> Span:
    """The span of the characters `start` to `end` of the text of an expression; that of the whole
    expression if it is not known, as for a text that is joined from params."""
    places = _places(code.span.text, code.text)
    if places is None or not 0 <= start < end <= len(places):
        return code.span
    begin = code.span.start
    last = places[end] if end < len(places) else places[end - 1] + 1
    return Span(code.span.source, begin + places[start], begin + last)


def node_place(code: Expression, node: ast.expr) -> Span:
    """The span of a part of an expression that Python has read from its text."""
    return place_in(code, *node_range(code.text, node))


def attribute_place(code: Expression, node: ast.Attribute) -> Span:
    """The span of the name of an attribute."""
    _, end = node_range(code.text, node)
    return place_in(code, end - len(node.attr), end)


def key_place(code: Expression, key: str) -> Span:
    """The first place where code reads a key of userdata, `ud.key` or `ud["key"]`; the whole code
    if there is none."""
    tree = script_code(code.text).tree
    for node in ast.walk(tree) if tree is not None else ():
        match node:
            case ast.Attribute(value=ast.Name(), attr=name) if name == key:
                return attribute_place(code, node)
            case ast.Subscript(value=ast.Name(), slice=ast.Constant(value=name)) if name == key:
                return node_place(code, node.slice)
    return code.span


def node_range(text: str, node: ast.expr) -> tuple[int, int]:
    """The first character of a part of a text, and the one after it."""
    last = node.end_lineno or node.lineno
    end = _offset(text, last, node.end_col_offset or 0)
    return _offset(text, node.lineno, node.col_offset), end


def _offset(text: str, line: int, column: int) -> int:
    """The offset of a position of `ast`, whose columns count bytes of UTF-8."""
    lines = text.split("\n")[:line]
    before = lines.pop().encode("utf-8", "surrogatepass")[:column]
    return sum(len(line) + 1 for line in lines) + len(before.decode("utf-8", "surrogatepass"))


def _places(written: str, text: str) -> range | list[int] | None:
    """The offset in `written`, a YAML scalar, of each character of its value; None if it is not
    known."""
    at = written.find(text)
    if at >= 0:
        return range(at, at + len(text))
    quote = written[:1] if written[:1] in ("'", '"') else ""
    at = len(quote)
    while at < len(written) and (written[at].isspace() or written[at] == "`"):
        at += 1
    found: list[int] = []
    for letter in text:
        step = _step(written, at, letter, quote)
        if step is None:
            return None
        found.append(at)
        at += step
    return found


def _step(written: str, at: int, letter: str, quote: str) -> int | None:
    """The number of characters of a scalar that stand for one letter of its value."""
    if quote == '"' and written[at : at + 1] == "\\":
        return 2 if written[at + 1 : at + 2] == letter else None
    if letter == " " and written[at : at + 1].isspace():
        rest = written[at:]
        blank = len(rest) - len(rest.lstrip())
        return blank if "\n" in rest[:blank] else 1  # a line end of a folded text is a space
    if written[at : at + 1] != letter:
        return None
    return 2 if letter == quote == "'" else 1
