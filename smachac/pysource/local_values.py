"""Local variables of `execute`: those that it assigns and does not use, and those that have a value
at a place."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from smachac.diagnostics.source import Span, Word
from smachac.pysource.modules import OwnClass
from smachac.pysource.source import PythonText
from smachac.pysource.syntax_tree import walk_code


def text_of(own: OwnClass, function: ast.FunctionDef) -> PythonText:
    """The text with a method of a class."""
    return next(module.text for module, node in own.classes if function in node.body)


def unused_values(own: OwnClass, function: ast.FunctionDef) -> tuple[tuple[str, Word], ...]:
    """The local variables that `execute` assigns and does not use, with the key of each."""
    text = text_of(own, function)
    userdata = function.args.args[1].arg
    names = [each for each in walk_code(function) if isinstance(each, ast.Name)]
    used = {each.id for each in names if not isinstance(each.ctx, ast.Store)}
    assigned = [each.targets[0] for each in walk_code(function)
                if isinstance(each, ast.Assign) and len(each.targets) == 1]  # fmt: skip
    local = tuple(
        (each.id, Word(f"{userdata}.{each.id}", text.span(each)))
        for each in assigned
        if isinstance(each, ast.Name) and each.id not in used
    )
    read = {each.attr for _, node in own.classes for each in walk_code(node)
            if isinstance(each, ast.Attribute) and not isinstance(each.ctx, ast.Store)
            and not (isinstance(each.value, ast.Name) and each.value.id == userdata)}  # fmt: skip
    kept = tuple(
        (each.attr, Word(f"{userdata}.{each.attr}", text.span(each)))
        for each in assigned
        if isinstance(each, ast.Attribute) and each.attr not in read
        and isinstance(each.value, ast.Name) and each.value.id == "self"
    )  # fmt: skip
    return (*kept, *local)


def local_values(text: PythonText, function: ast.FunctionDef) -> tuple[Word, ...]:
    """The local variables that a function assigns, each with the code in which it has a value: from
    behind the assignment to the end of its block."""
    return tuple(_local_values(text, function.body))


def _local_values(text: PythonText, block: Sequence[ast.stmt]) -> Iterator[Word]:
    end = text.span(block[-1]).end
    for each in block:
        place = text.span(each)
        for name in _assigned(each):
            yield Word(name, Span(place.source, place.end, end))
        match each:
            case ast.If() | ast.For() | ast.While():
                inner = [each.body, each.orelse]
            case ast.With():
                inner = [each.body]
            case ast.Try():
                inner = [
                    each.body,
                    each.orelse,
                    each.finalbody,
                    *(one.body for one in each.handlers),
                ]
            case _:
                inner = []
        for part in inner:
            if part:
                yield from _local_values(text, part)


def _assigned(node: ast.stmt) -> list[str]:
    """The names to which a statement assigns."""
    match node:
        case ast.Assign(targets=targets):
            parts = [
                part
                for each in targets
                for part in (each.elts if isinstance(each, ast.Tuple) else [each])
            ]
        case ast.AnnAssign(target=target, value=ast.expr()):
            parts = [target]
        case _:
            parts = []
    return [each.id for each in parts if isinstance(each, ast.Name)]
