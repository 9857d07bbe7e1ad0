"""The names that a module can give a value to, in any of its scopes."""

from __future__ import annotations

import ast
import builtins
from collections.abc import Iterator

from smachac.pysource.modules.syntax_tree import walk_code

KNOWN_NAMES = frozenset(dir(builtins)) | frozenset([
    "__file__", "__path__", "__builtins__", "__annotations__", "__class__", "__module__",
    "__qualname__", "WindowsError", "apply", "basestring", "buffer", "cmp", "coerce", "execfile",
    "file", "get_ipython", "intern", "long", "raw_input", "reduce", "reload", "unichr", "unicode",
    "xrange",
])  # fmt: skip
"""The built-in names of Python 3 and 2."""


def bound_names(tree: ast.Module) -> frozenset[str]:
    """The names that the code of a module binds: no other name can have a value."""
    return frozenset(name for node in walk_code(tree) for name in _bound(node))


def _bound(node: ast.AST) -> Iterator[str]:
    match node:
        case ast.Name(id=name, ctx=ast.Store() | ast.Del()):
            yield name
        case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name) | ast.ClassDef(name=name):
            yield name
        case ast.arg(arg=name) | ast.ExceptHandler(name=str() as name):
            yield name
        case ast.MatchAs(name=str() as name) | ast.MatchStar(name=str() as name):
            yield name
        case ast.MatchMapping(rest=str() as name):
            yield name
        case ast.Global(names=names) | ast.Nonlocal(names=names):
            yield from names
        case ast.alias(name=name, asname=other):
            yield other or name.partition(".")[0]


def star_imports(tree: ast.Module) -> list[ast.ImportFrom]:
    """The imports that bind all names of a module."""
    return [
        node
        for node in walk_code(tree)
        if isinstance(node, ast.ImportFrom) and any(part.name == "*" for part in node.names)
    ]
