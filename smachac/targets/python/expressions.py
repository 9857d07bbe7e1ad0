"""What expressions of a script need in the module they are printed into."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator

from smachac.ir.nodes import Data, Expression, Leaf, Machine, Struct
from smachac.ir.walk import walk


def standard_imports(machine: Machine) -> list[str]:
    """Imports of the modules of the standard library that expressions name: `math.pi`."""
    found = {name for text in _expressions(machine) for name in _modules(text)}
    return [f"import {name}" for name in sorted(found)]


def _expressions(machine: Machine) -> Iterator[str]:
    for _, node in walk(machine.root):
        held = node.variables if isinstance(node, Leaf) else node.userdata
        for one in held:
            yield from _in(one.value.data)
        items = getattr(node, "items", None)
        if items is not None:
            yield from _in(items.data)


def _in(data: Data) -> Iterator[str]:
    match data:
        case Expression(text=text):
            yield text
        case Struct(entries=entries):
            for _, value in entries:
                yield from _in(value)
        case tuple():
            for value in data:
                yield from _in(value)


def _modules(text: str) -> set[str]:
    """The modules at the roots of dotted names; arguments of a lambda are none."""
    try:
        tree = ast.parse(text.strip(), mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return set()
    nodes = list(ast.walk(tree))
    arguments = {node.arg for node in nodes if isinstance(node, ast.arg)}
    roots = {
        node.value.id
        for node in nodes
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name)
    }
    return (roots - arguments) & sys.stdlib_module_names
