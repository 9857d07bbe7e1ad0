"""Python source in the layout of a formatter: literals and calls, broken into lines if too long."""

from __future__ import annotations

import ast
import io
import math
import tokenize
from collections.abc import Iterable
from typing import TYPE_CHECKING

from smachac.ir.nodes import Data, Expression, Struct
from smachac.ir.python_code import parse_code
from smachac.records import dataclass
from smachac.targets import comment_lines

if TYPE_CHECKING:
    from smachac.ir.expressions import Expr

WIDTH = 99
"""The line length of Python in ROS 2 (ament_flake8)."""


@dataclass(frozen=True, slots=True)
class Group:
    """Items in brackets: on one line if they fit, else one item a line with a trailing comma. The
    arguments of a call may stand together on a line of their own, as in Ruff's formatter."""

    opening: str
    items: tuple[tuple[str, Doc], ...]
    closing: str


Doc = str | Group


def flat(doc: Doc) -> str:
    """The text on one line."""
    if isinstance(doc, str):
        return doc
    items = [prefix + (item if isinstance(item, str) else flat(item)) for prefix, item in doc.items]
    return f"{doc.opening}{', '.join(items)}{doc.closing}"


def laid_out(doc: Doc, width: int, before: int = 0, after: int = 0) -> str:
    """The text in lines of a width. `before` characters precede its first line, `after` characters
    follow its last line. The indentation of its lines is relative to that of the first."""
    line = flat(doc)
    if isinstance(doc, str) or not doc.items or before + len(line) + after <= width:
        return line
    inside = line[len(doc.opening) : len(line) - len(doc.closing)]
    if doc.closing[0] == ")" and len(inside) <= width - 4:
        return f"{doc.opening}\n    {inside}\n{doc.closing}"
    lines = [doc.opening]
    for prefix, item in doc.items:
        text = item if isinstance(item, str) else laid_out(item, width - 4, len(prefix), 1)
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
    """A string literal in double quotes, or in single quotes where that needs fewer escapes."""
    literal = repr(text)
    if literal[0] == '"' or '"' in text:
        return literal
    return f'"{literal[1:-1]}"'


def docstring(text: str) -> str:
    """A text as part of a docstring: it neither ends the string nor escapes anything."""
    return text.replace("\\", "\\\\").replace('"""', "'''").rstrip('"')


def docstring_lines(text: str, width: int) -> str:
    """The docstring of a text, in lines of a width. The quotes at the end of several lines stand
    alone."""
    lines = [
        line.replace("\\", "\\\\").replace('"""', "'''") for line in comment_lines(text, width - 6)
    ]
    first = f" {lines[0]}" if lines[0].startswith('"') else lines[0]
    if len(lines) > 1:
        return "\n".join([f'"""{first}', *lines[1:], '"""'])
    return f'"""{first} """' if first.endswith('"') else f'"""{first}"""'


def expression(text: str) -> Doc:
    """Code of the script: in layout if it is a portable expression, else unchanged."""
    from smachac.ir.expressions import parse_expression

    tree = parse_expression(text)
    return _one_line(text) if tree is None else _expression(tree)


def _one_line(text: str) -> str:
    """Code on one line, without comments, which would hide the text that follows on the line, and
    as one argument of a call: a tuple in parentheses."""
    if not any(mark in text for mark in "#\n,"):
        return text
    try:
        tree = parse_code(f"({text}\n)")
        if isinstance(tree, ast.Tuple) or "#" in text or "\n" in text:
            return ast.unparse(tree)
        return text
    except SyntaxError:
        return " ".join(text.split("\n"))


def _expression(tree: Expr) -> Doc:
    """The layout of an expression: long lists, also as the result of a lambda, break into lines."""
    from smachac.ir.expressions import Lambda, ListDisplay, print_expression

    match tree:
        case ListDisplay(items):
            return Group("[", tuple(("", _expression(item)) for item in items), "]")
        case Lambda(parameter, body):
            head = f"lambda {parameter}: " if parameter else "lambda: "
            inner = _expression(body)
            if isinstance(inner, str):
                return head + inner
            return Group(head + inner.opening, inner.items, inner.closing)
    return _double_quoted(print_expression(tree))


def _double_quoted(code: str) -> str:
    """Code with its string literals in double quotes."""
    if "'" not in code:
        return code
    parts, end = [], 0
    for token in tokenize.generate_tokens(io.StringIO(code).readline):
        if token.type == tokenize.STRING:
            parts += [code[end : token.start[1]], string(ast.literal_eval(token.string))]
            end = token.end[1]
    return "".join([*parts, code[end:]])


def literal(data: Data) -> Doc:
    """A value of the script."""
    match data:
        case Expression(text=text):
            return expression(text)
        case Struct(entries=entries):
            return mapping((key, literal(value)) for key, value in entries)
        case tuple():
            return Group("[", tuple(("", literal(item)) for item in data), "]")
        case str():
            return string(data)
        case float() if not math.isfinite(data):
            return f'float("{data}")'
    return repr(data)
