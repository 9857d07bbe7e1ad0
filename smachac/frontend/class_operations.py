"""Operations on userdata keys in `execute`, and numbers that it writes to keys."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator, Mapping

from smachac.diagnostics.source import Span, Word
from smachac.frontend.python_functions import access_of
from smachac.frontend.python_modules import Module
from smachac.frontend.userdata_parts import TESTS, tried_code, written_keys

PURE = frozenset(["len", "abs", "min", "max", "round", "sum", "int", "float", "bool"])
"""Functions of Python that the types of expressions know (analysis/expression_types.py)."""

NUMBERS = frozenset(
    ["acos", "asin", "atan", "atan2", "ceil", "copysign", "cos", "degrees", "dist", "exp", "fabs",
     "floor", "fmod", "hypot", "log", "log10", "pow", "radians", "sin", "sqrt", "tan"]
)  # fmt: skip
"""Functions of the module `math` that return one number."""


def operations(module: Module, function: ast.FunctionDef) -> tuple[Word, ...]:
    """The comparisons and calculations of `execute` over nothing but userdata keys and constants.
    Not those of keys that it writes, and those in `try`; nothing if it tests the types of values.
    """
    userdata = function.args.args[1].arg
    every = [*ast.walk(function)]
    if any(isinstance(each, ast.Name) and each.id in TESTS for each in every):
        return ()
    tried, written = tried_code(every), written_keys(every, userdata)
    bound = {each.arg for each in every if isinstance(each, ast.arg)} - {userdata}
    names = (PURE - module.names.keys() - bound) | {userdata}
    found = []
    todo: list[ast.AST] = [*reversed(function.body)]
    while todo:
        node = todo.pop()
        if node in tried:
            continue
        if isinstance(node, ast.Compare | ast.BinOp) and _is_known(node, userdata, names, written):
            span = module.text.span(node)
            if not module.text.is_filled(span):
                found.append(Word(span.text, span))
            continue
        parts = [*ast.iter_child_nodes(node)]
        if isinstance(node, ast.Call):  # `all(...)` of an array of numpy
            parts = [each for each in parts if not isinstance(each, ast.Compare)]
        todo.extend(reversed(parts))
    return tuple(found)


def _is_known(
    node: ast.expr, userdata: str, names: frozenset[str] | set[str], written: frozenset[str]
) -> bool:
    """Whether an expression has no names but those of the userdata and of pure functions, and reads
    a key that the code does not write."""
    every = [*ast.walk(node)]
    used = {each.id for each in every if isinstance(each, ast.Name)}
    keys = {found.key for each in every if (found := access_of(each, userdata)) is not None}
    return used <= names and bool(keys) and not keys & written


def number_writes(module: Module, function: ast.FunctionDef) -> tuple[Span, ...]:
    """The places of the values that `execute` writes to userdata keys and that are one number."""
    userdata = function.args.args[1].arg
    every = [*ast.walk(function)]
    values = [each.value for each in every
              if isinstance(each, ast.Assign) and len(each.targets) == 1
              and access_of(each.targets[0], userdata) is not None]  # fmt: skip
    if not values:
        return ()
    local = dict(_local_values(every))
    found = (each for each in values if _is_number(each, module, local, 10))
    return tuple(module.text.span(each) for each in found)


def _local_values(every: list[ast.AST]) -> Iterator[tuple[str, ast.expr]]:
    """The local names that are bound once, by an assignment, each with its value."""
    stored = [each for each in every if isinstance(each, ast.Name)]
    bound = Counter(each.id for each in stored if not isinstance(each.ctx, ast.Load))
    bound.update(each.arg for each in every if isinstance(each, ast.arg))
    for each in every:
        match each:
            case ast.Global(names=names) | ast.Nonlocal(names=names):
                bound.update(names)
                bound.update(names)
    for each in every:
        match each:
            case ast.Assign(targets=[ast.Name(id=name)], value=value) if bound[name] == 1:
                yield name, value


def _is_number(node: ast.expr, module: Module, local: Mapping[str, ast.expr], depth: int) -> bool:
    """Whether the value of an expression is one number, whatever its names are."""

    def known(*nodes: ast.expr) -> bool:
        return depth > 0 and all(_is_number(each, module, local, depth - 1) for each in nodes)

    match node:
        case ast.Constant(value=int() | float() as value):
            return not isinstance(value, bool)
        case ast.UnaryOp(op=ast.USub() | ast.UAdd(), operand=inner):
            return known(inner)
        case ast.BinOp(left=left, right=right):
            return known(left, right)
        case ast.IfExp(body=body, orelse=other):
            return known(body, other)
        case ast.Name(id=name):
            return name in local and known(local[name])
        case ast.Attribute(value=ast.Name(id="math"), attr="pi" | "tau" | "e"):
            return _is_math(module)
        case ast.Call(func=ast.Attribute(value=ast.Name(id="math"), attr=name)):
            return name in NUMBERS and _is_math(module)
        case ast.Call(func=ast.Name(id="float" | "int" | "len" as name)):
            return name not in module.names and name not in local
        case ast.Call(func=ast.Name(id="abs" | "round" as name), args=[first, *_]):
            return name not in module.names and known(first)
    return False


def _is_math(module: Module) -> bool:
    """Whether the name `math` is the module of Python."""
    match module.names.get("math", ()):
        case (ast.Import(names=names),):
            return any(each.name == "math" and each.asname is None for each in names)
    return False
