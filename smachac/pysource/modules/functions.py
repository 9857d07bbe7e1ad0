"""Parts of functions in Python: their returns, the accesses of a line to the userdata."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator

from smachac.pysource.modules.syntax_tree import walk_code
from smachac.records import dataclass

WIDE = frozenset(["AttributeError", "Exception", "BaseException"])
"""Exceptions that a missing attribute raises."""


METHODS = frozenset(["extract", "keys", "merge", "update"])
"""The attributes of userdata that are no keys (smach.user_data)."""

_Functions = ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef | ast.expr


def is_plain(function: ast.FunctionDef) -> bool:
    """Whether a function runs when it is called: it is no generator and has no decorator."""
    return not function.decorator_list and not is_generator(function)


def is_generator(function: ast.FunctionDef) -> bool:
    """Whether a function itself, not one inside it, has a `yield`."""
    todo: list[ast.AST] = [*function.body]
    while todo:
        node = todo.pop()
        if isinstance(node, ast.Yield | ast.YieldFrom):
            return True
        if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef | ast.Lambda):
            todo.extend(ast.iter_child_nodes(node))
    return False


@dataclass(frozen=True, slots=True, kw_only=True)
class Access:
    """A key of the userdata that an expression reads or, otherwise, writes, with its place."""

    key: str
    read: bool
    place: ast.expr


def access_of(node: ast.AST, name: str) -> Access | None:
    """The access of an expression to the userdata of a name."""
    match node:
        case ast.Attribute(value=ast.Name(id=owner), attr=key, ctx=ctx) if owner == name:
            if key not in METHODS and not key.startswith("_"):
                return Access(key=key, read=isinstance(ctx, ast.Load), place=node)
        case ast.Subscript(value=ast.Name(id=owner), slice=ast.Constant(str() as key), ctx=ctx):
            if owner == name:
                return Access(key=key, read=isinstance(ctx, ast.Load), place=node)
        case ast.Call(
            func=ast.Name(id="getattr" | "setattr" as function),
            args=[ast.Name(id=owner), ast.Constant(str() as key) as place, *_],
        ) if owner == name:
            return Access(key=key, read=function == "getattr", place=place)
    return None


def alternatives(value: ast.expr) -> Iterator[ast.expr]:
    """The expressions one of which is the value of an expression."""
    if isinstance(value, ast.IfExp):
        yield from alternatives(value.body)
        yield from alternatives(value.orelse)
    else:
        yield value


def returns_of(body: list[ast.stmt]) -> Iterator[ast.Return]:
    """The return statements of a function, without those of nested functions."""
    todo: list[ast.AST] = [*reversed(body)]
    while todo:
        node = todo.pop()
        if isinstance(node, ast.Return):
            yield node
        elif not isinstance(node, _Functions):
            todo.extend(reversed(list(ast.iter_child_nodes(node))))


def caught(node: ast.ClassDef) -> set[ast.AST]:
    """The nodes in a `try` that catches the error of a missing attribute."""
    found: set[ast.AST] = set()
    for inner in walk_code(node):
        if isinstance(inner, ast.Try) and any(map(_is_wide, inner.handlers)):
            found.update(inner for line in inner.body for inner in walk_code(line))
    return found


def _is_wide(handler: ast.ExceptHandler) -> bool:
    if handler.type is None:
        return True
    names = {name.id for name in walk_code(handler.type) if isinstance(name, ast.Name)}
    return bool(names & WIDE)


def tried_code(every: Iterable[ast.AST]) -> set[ast.AST]:
    """The code in the body of a `try`."""
    return {inner for node in every if isinstance(node, ast.Try)
            for line in node.body for inner in walk_code(line)}  # fmt: skip
