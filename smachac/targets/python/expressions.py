"""What expressions of a script need in the module they are printed into."""

from __future__ import annotations

import ast
import sys

from smachac.ir.nodes import Machine
from smachac.ir.walk import expressions, walk


def standard_imports(machine: Machine) -> list[str]:
    """Imports of the modules of the standard library that expressions name: `math.pi`."""
    found = {
        name
        for _, node in walk(machine.root)
        for expression in expressions(node)
        for name in _modules(expression.text)
    }
    return [f"import {name}" for name in sorted(found)]


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
