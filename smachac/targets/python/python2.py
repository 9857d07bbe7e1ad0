"""Python 2 in templates for SMACHA: what is certainly Python 2 is translated to Python 3."""

from __future__ import annotations

import ast
import re
from typing import NamedTuple

from smachac.ir.python_code import parse_module

Change = tuple[str, str]
"""A line before and after its translation."""


class Modern(NamedTuple):
    """Text as Python 3, the changes that this took, and its tree, or why it is no Python."""

    text: str
    changes: list[Change]
    tree: ast.Module | SyntaxError


_EXCEPT = re.compile(r"^(\s*except\s+(?:\([^()]*\)|[\w.]+))\s*,\s*(\w+)\s*:(.*)$")
_PRINT = re.compile(r"^(\s*)print(?:\s+(?!\()|(?=[\"']))([^>\s].*)$")
_PRINT_NOTHING = re.compile(r"^(\s*)print\s*$")
_PRINT_FORMAT = re.compile(r"^(\s*)print\s+(\(.*\)\s*%.*|[\"'].*)$")
_RAISE = re.compile(r"^(\s*raise\s+[\w.]+)\s*,\s*(.+)$")
_UNEQUAL = re.compile(r"^([^\"'#]*?)<>(.*)$")


def modern(text: str) -> Modern:
    """Text as Python 3.

    Text that is Python 3 is unchanged except for `except A, e:`, which new versions of Python read
    as two exceptions.
    """
    changes: list[Change] = []
    lines = text.split("\n")
    for number, line in enumerate(lines):
        if _EXCEPT.match(line):
            lines[number] = translated(line) or line
            changes.append((line, lines[number]))
    text = "\n".join(lines)
    tree = parsed(text)
    if isinstance(tree, ast.Module):
        return Modern(text, changes, tree)
    more: list[Change] = []
    for number, line in enumerate(lines):
        new = _line(line)
        if new is not None and new != line:
            lines[number] = new
            more.append((line, new))
    tried = "\n".join(lines)
    tried_tree = parsed(tried) if more else tree
    if isinstance(tried_tree, ast.Module):
        return Modern(tried, [*changes, *more], tried_tree)
    return Modern(text, changes, tree)


def translated(line: str) -> str | None:
    """A line as Python 3; None unless it is certainly Python 2."""
    found = _EXCEPT.match(line)
    return f"{found[1]} as {found[2]}:{found[3]}" if found else _line(line)


def _line(line: str) -> str | None:
    """A line with `print`, `raise` or `<>` of Python 2 as Python 3; None for other lines."""
    line = line.rstrip()
    if found := _PRINT_NOTHING.match(line):
        return f"{found[1]}print()"
    if found := _PRINT_FORMAT.match(line):
        return f"{found[1]}print({found[2]})"
    if found := _PRINT.match(line):
        values = found[2].removesuffix(",")
        end = ', end=" "' if values != found[2] and values else ""
        return f"{found[1]}print({values or found[2]}{end})"
    if found := _RAISE.match(line):
        return f"{found[1]}({found[2]})"
    if found := _UNEQUAL.match(line):
        return f"{found[1]}!={found[2]}"
    return None


def parsed(text: str) -> ast.Module | SyntaxError:
    """The tree of a text, or the exception if it is no Python."""
    try:
        return parse_module(text)
    except SyntaxError as error:
        return error
