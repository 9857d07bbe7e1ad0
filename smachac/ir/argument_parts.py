"""Reader of facts in the syntax tree of a function: parts of its arguments, comparisons, results.

It serves functions in modules and lambdas in a script, which differ in the places of their code.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from typing import TypeAlias

from smachac.diagnostics.source import Span, Word
from smachac.ir.function_facts import ArgumentUses, Comparison, Operand, Part, Result

TESTS = frozenset(["callable", "dir", "getattr", "hasattr", "isinstance", "type", "vars"])
"""Functions that test what an argument is; code with them can be right for several classes."""

OPERATORS: Mapping[type[ast.cmpop], str] = {
    ast.Eq: "==", ast.NotEq: "!=", ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=",
    ast.Is: "is", ast.IsNot: "is not",
}  # fmt: skip
"""The operators of comparisons with one value, as Python has them."""

OF_NUMBERS = frozenset(["abs", "float", "int", "len", "max", "min", "range", "round", "sum"])
"""Functions of Python that fail with one argument that is neither a number, a text nor a list."""

Places: TypeAlias = "Callable[[ast.expr], Span]"
"""The span of an expression."""


def argument_uses(
    nodes: Iterable[ast.AST], names: Collection[ast.Name], places: Places
) -> ArgumentUses:
    """The parts of arguments in some nodes; `names` are the places that read an argument."""
    parts: list[Part] = []
    comparisons: list[Comparison] = []
    operands: list[Operand] = []
    for node in nodes:
        for operand in _operands(node):
            found = part_of(operand, names, places)
            if found is not None:
                operands.append(Operand(found, places(operand), ast.unparse(node)))
        match node:
            case ast.Attribute():
                found = part_of(node, names, places)
                parts += [found] if found is not None else []
            case ast.Call(
                func=ast.Name(id="setattr"), args=[owner, ast.Constant(str(name)) as place, _]
            ):
                found = part_of(owner, names, places)
                if found is not None:
                    word, steps = Word(name, places(place)), (*found.steps, name)
                    parts.append(found._replace(steps=steps, name=word))
            case ast.Compare():
                comparisons += _comparison(node, names, places)
    return ArgumentUses(tuple(parts), tuple(comparisons), tuple(operands))


def _operands(node: ast.AST) -> list[ast.expr]:
    """The parts of an operation that have to be numbers, texts or lists. An object of another class
    makes it fail; `==` is false."""
    match node:
        case ast.BinOp(left=left, op=ast.Mod()):
            return [left]  # a text can contain any object: `"%s" % message`
        case ast.BinOp(left=left, right=right):
            return [left, right]
        case ast.UnaryOp(op=ast.USub() | ast.UAdd() | ast.Invert(), operand=operand):
            return [operand]
        case ast.Subscript(value=value):
            return [value]
        case ast.Call(func=ast.Name(id=name), args=[only], keywords=[]) if name in OF_NUMBERS:
            return [only]
        case ast.Compare(left=left, ops=[operator], comparators=[right]):
            if isinstance(operator, ast.Lt | ast.LtE | ast.Gt | ast.GtE):
                return [left, right]
            if isinstance(operator, ast.In | ast.NotIn):
                return [right]
            pairs = ((left, right), (right, left))
            return [one for one, other in pairs if _is_plain(other)]
    return []


def _is_plain(node: ast.expr) -> bool:
    """Whether code is a number, a text or a truth value."""
    return isinstance(node, ast.Constant) and isinstance(node.value, bool | int | float | str)


def part_of(node: ast.expr, names: Collection[ast.Name], places: Places) -> Part | None:
    """The part of an argument that code is; None for other code and for a part of a list."""
    steps: list[str | None] = []
    owner = node
    while isinstance(owner, ast.Attribute | ast.Subscript):
        if isinstance(owner, ast.Subscript) and isinstance(owner.slice, ast.Slice):
            return None
        steps.append(owner.attr if isinstance(owner, ast.Attribute) else None)
        owner = owner.value
    if not isinstance(owner, ast.Name) or owner not in names:
        return None
    span = places(node)
    word = Word("", span)
    if isinstance(node, ast.Attribute):
        word = Word(node.attr, Span(span.source, max(span.end - len(node.attr), 0), span.end))
        if word.span.text != node.attr:  # a place that is not known exactly
            word = Word(node.attr, span)
    return Part(owner.id, tuple(reversed(steps)), word, ast.unparse(node))


def _comparison(
    node: ast.Compare, names: Collection[ast.Name], places: Places
) -> Iterator[Comparison]:
    match node:
        case ast.Compare(left=left, ops=[operator], comparators=[ast.Constant(value=value)]):
            pass
        case ast.Compare(left=ast.Constant(value=value), ops=[operator], comparators=[left]):
            pass
        case _:
            return
    sign = OPERATORS.get(type(operator))
    if sign is None or not isinstance(value, str | int | float):
        return
    part = part_of(left, names, places)
    if part is not None:
        yield Comparison(part, sign, value, places(node))


def result_of(node: ast.expr, names: Collection[ast.Name], places: Places) -> Result:
    """What code gives as the result of its function."""
    text, span = ast.unparse(node), places(node)
    match node:
        case ast.Constant(value=value):
            return Result(text, span, "constant", value)
        case ast.Compare(ops=[_]) | ast.UnaryOp(op=ast.Not()):
            return Result(text, span, "truth")
    part = part_of(node, names, places)
    return Result(text, span, "part" if part is not None else "", None, part)


def own_names(
    body: Iterable[ast.stmt], parameters: Iterable[str], assigned: Collection[str] = ()
) -> list[ast.Name]:
    """The places in a function with statements that read its parameters, or variables that it has
    `assigned` once. None of a parameter that is set again in it, or whose class or fields it tests;
    none at all in a `try`."""
    nodes = [node for line in body for node in ast.walk(line)]
    lost: set[str] = set()
    caught: set[ast.AST] = set()
    for node in nodes:
        match node:
            case ast.Name(id=name, ctx=ast.Store() | ast.Del()):
                lost.update({name} - {*assigned})
            case (
                ast.arg(arg=name) | ast.ExceptHandler(name=str(name)) | ast.alias(asname=str(name))
            ):
                lost.add(name)
            case (
                ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name) | ast.alias(name=name)
            ):
                lost.add(name)
            case ast.MatchAs(name=str(name)) | ast.MatchStar(name=str(name)):
                lost.add(name)
            case ast.Call(func=ast.Name(id=called), args=given) if called in TESTS:
                lost.update(node.id for one in given for node in ast.walk(one)
                            if isinstance(node, ast.Name))  # fmt: skip
            case ast.Match(subject=subject):
                lost.update(node.id for node in ast.walk(subject) if isinstance(node, ast.Name))
            case ast.Try():
                caught.update(inner for line in node.body for inner in ast.walk(line))
    known = {*parameters} - lost
    return [
        node
        for node in nodes
        if isinstance(node, ast.Name) and node.id in known and node not in caught
    ]
