"""The nodes of a syntax tree of Python."""

from __future__ import annotations

import ast
from collections.abc import Iterable

_KEPT = ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef | ast.Module
"""The nodes that keep what is in them: many parts of the class reader visit each of them."""


def walk_code(root: ast.AST) -> Iterable[ast.AST]:
    """A node and all nodes in it, as `ast.walk` in their order, but without those for the contexts
    of names (`ast.Load`). The tree must not change afterwards."""
    kept: list[ast.AST] | None = getattr(root, "_smachac_nodes", None)
    if kept is not None:
        return kept
    found: list[ast.AST] = [root]
    for node in found:
        for name in node._fields:
            part = getattr(node, name, None)
            if isinstance(part, list):
                found += [inner for inner in part if isinstance(inner, ast.AST)]
            elif isinstance(part, ast.AST) and not isinstance(part, ast.expr_context):
                found.append(part)
    if isinstance(root, _KEPT):
        root._smachac_nodes = found  # type: ignore[union-attr]
    return found
