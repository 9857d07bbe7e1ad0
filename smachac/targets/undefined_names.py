"""Undefined names: names that code in a script uses and its Python program does not define (SM019).

The definitions of templates are approximated by their text: every word in a template of the user
counts as defined, and there are no findings if a template computes names or has `import *`.
"""

from __future__ import annotations

import ast
import builtins
import re
import sys
import warnings
from collections.abc import Iterator

from smachac.diagnostics.diagnostic import Diagnostic
from smachac.frontend.errors.script import undefined_name
from smachac.frontend.loader import Library
from smachac.ir.expressions import looks_like_expression
from smachac.ir.nodes import Data, Expression, Leaf, Machine, Node, Struct
from smachac.ir.traversal import expressions, walk

USERDATA = ("ud", "userdata")
"""The names of the userdata in code that is no function."""

_MAKES_NAMES = re.compile(r"import \*|[\"']\*[\"']|\w\{\{|\}\}\w")
_BLOCK = re.compile(r"\{%[-+]?\s*(?:end)?block\b[^%]*%\}")
_WORDS = re.compile(r"[^\W\d]\w*")
_DEFINED = re.compile(r"^[ \t]*(?:def|class|import|from \S+ import)\s+(\w+)|^[ \t]*(\w+) = ", re.M)


def undefined_names(machine: Machine, library: Library) -> Iterator[Diagnostic]:
    """The undefined names, each at the code that uses it."""
    used = [
        (node, expression, name)
        for _, node in walk(machine.root)
        if not (isinstance(node, Leaf) and node.written)  # its template decides how it is printed
        for expression in expressions(node)
        for name in _free(expression.text)
    ]
    known = _known(machine, library) if used else None
    for node, expression, name in used:
        if known is not None and name not in known:
            by_look = _by_look(node, expression)
            yield undefined_name(expression.span, name, expression.text, by_look)


def _by_look(node: Node, expression: Expression) -> bool:
    """Whether a string of the script counts as code only because of its form."""
    if isinstance(node, Leaf) and expression in _functions(node):
        return False
    written = expression.span.text
    made = written.startswith("[") and "`" not in written  # a string construct
    return made or (written == expression.text and looks_like_expression(written))


def _functions(leaf: Leaf) -> Iterator[Data]:
    """The values in the mappings of a leaf whose strings are all code."""
    for held in leaf.variables:
        if held.name == "callbacks" or held.role in ("callbacks", "conditions"):
            entries = held.value.data.entries if isinstance(held.value.data, Struct) else ()
            yield from (value for _, value in entries)


def _free(text: str) -> list[str]:
    """The names that code uses from its module, except names that every module has."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SyntaxWarning)
            nodes = [*ast.walk(ast.parse(text.strip(), mode="eval"))]
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return []  # SM016
    bound = {node.arg for node in nodes if isinstance(node, ast.arg)}
    names = [node for node in nodes if isinstance(node, ast.Name)]
    bound |= {name.id for name in names if not isinstance(name.ctx, ast.Load)}
    found = dict.fromkeys(name.id for name in names if name.id not in bound)
    return [
        name
        for name in found
        if name not in USERDATA and not hasattr(builtins, name)
        if name not in sys.stdlib_module_names
    ]


def _known(machine: Machine, library: Library) -> set[str] | None:
    """The defined names: the words of all templates and the names that are imported for them; None
    if a template computes names."""
    from smachac.targets.python.imports import importable
    from smachac.targets.python.template_sources import template_sources

    known = importable()
    for file, source in template_sources(machine, library):
        if library.own_template(file) is None:
            known.update(word for pair in _DEFINED.findall(source.text) for word in pair if word)
        elif _MAKES_NAMES.search(source.text):
            return None
        else:
            known.update(_WORDS.findall(_BLOCK.sub("", source.text)))
    return known
