"""Functions of the project that return nothing, and whose result a class uses as a value."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator

from smachac.diagnostics.source import Word
from smachac.ir.class_facts import ClassFault, FaultKind
from smachac.pysource.modules.functions import is_plain, returns_of
from smachac.pysource.modules.modules import Module, OwnClass, find_function
from smachac.pysource.modules.source import name_span
from smachac.pysource.modules.syntax_tree import walk_code
from smachac.pysource.modules.user_code import UserCode

NO_RETURN = FaultKind(
    name="no return",
    message="`{word}` never returns a value, but `{name}` uses the result of `{more}`",
    help="end `{word}` with `return ...`",
    near_help="write `{near}`",
    effect="the result is None: code that uses it as a value fails, or goes on without it",
    accepted=True,
)

COLLECTING = frozenset(["append", "add", "insert"])
"""Methods that put their last argument into a collection."""

CONVERTING = frozenset(["float", "int", "len", "abs", "round", "sum"])
"""Functions of Python that need a value."""


def void_calls(own: OwnClass, library: UserCode) -> Iterator[ClassFault]:
    """The functions and methods of the project that end without `return`, although the code of the
    class puts their result into a record or a list, writes it to a key, or calculates with it."""
    done = set[ast.FunctionDef]()
    for module, node in own.classes:
        for method in node.body:
            if not isinstance(method, ast.FunctionDef):
                continue
            for call in _used_calls(method):
                found = called_function(own, module, method, call.func, library)
                if (
                    found is None
                    or found[1] in done
                    or module.text.is_filled(module.text.span(call))
                ):
                    continue
                if is_silent(found[1]):
                    done.add(found[1])
                    yield _fault(found[0], found[1], module, call)


def _used_calls(method: ast.FunctionDef) -> Iterator[ast.Call]:
    """The calls whose result is used as a value, also over a local variable that has one value."""
    every = [*walk_code(method)]
    names = [name for name in every if isinstance(name, ast.Name)]
    bound = Counter(name.id for name in names if not isinstance(name.ctx, ast.Load))
    bound.update(argument.arg for argument in every if isinstance(argument, ast.arg))
    local: dict[str, ast.Call] = {}
    for node in every:
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Call() as call):
                if bound[name] == 1:
                    local[name] = call
    alone = {node.value for node in every if isinstance(node, ast.Expr)}
    for node in every:
        for value in _values(node) if node not in alone or isinstance(node, ast.Call) else ():
            if isinstance(value, ast.Call):
                yield value
            elif isinstance(value, ast.Name) and value.id in local:
                yield local[value.id]


def _values(node: ast.AST) -> list[ast.expr]:
    """The parts of code that must be values other than None."""
    match node:
        case ast.Dict(values=values):
            return values
        case ast.List(elts=values, ctx=ast.Load()) | ast.Set(elts=values):
            return values
        case ast.DictComp(value=value) | ast.AugAssign(value=value):
            return [value]
        case ast.BinOp(left=left, right=right):
            return [left, right]
        case ast.Compare(left=left, ops=ops, comparators=others):
            ordered = all(isinstance(op, ast.Lt | ast.LtE | ast.Gt | ast.GtE) for op in ops)
            return [left, *others] if ordered else []
        case ast.Assign(targets=[ast.Attribute(value=ast.Name(id="userdata" | "ud"))], value=value):
            return [value]
        case ast.Call(func=ast.Attribute(attr=name), args=[*_, last]) if name in COLLECTING:
            return [last]
        case ast.Call(func=ast.Name(id=name), args=[value]) if name in CONVERTING:
            return [value]
    return []


def called_function(
    own: OwnClass, module: Module, method: ast.FunctionDef, called: ast.expr, library: UserCode
) -> tuple[Module, ast.FunctionDef] | None:
    """The function or method of the project that a call runs."""
    match called:
        case ast.Attribute(value=ast.Name(id="self"), attr=name):
            return None if name in own.assigned() else own.method(name)
        case ast.Name(id=head) | ast.Attribute(value=ast.Name(id=head)):
            bound = any(
                (isinstance(node, ast.arg) and node.arg == head)
                or (isinstance(node, ast.Name) and node.id == head
                    and not isinstance(node.ctx, ast.Load))
                for node in walk_code(method)
            )  # fmt: skip
            return (
                None
                if bound or head not in module.names
                else find_function(module, called, library)
            )
    return None


def is_silent(function: ast.FunctionDef) -> bool:
    """Whether a function has code, and none of its paths returns a value."""
    if not is_plain(function) or any(
        returned.value is not None for returned in returns_of(function.body)
    ):
        return False
    real = [node for node in function.body if not _is_of_stub(node)]
    return bool(real) and not isinstance(function.body[-1], ast.Raise | ast.While)


def _is_of_stub(node: ast.stmt) -> bool:
    """Whether a statement is one of a function that is not written yet."""
    if isinstance(node, ast.Pass | ast.Raise):
        return True
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)


def _fault(where: Module, function: ast.FunctionDef, module: Module, call: ast.Call) -> ClassFault:
    """The fault at the last line of the function, if that is the value that is meant, or at its
    name."""
    used = " ".join(module.text.span(call).text.split())
    last = function.body[-1]
    span, near = name_span(where.text, function), None
    if isinstance(last, ast.Expr) and _is_value(last.value):
        span = where.text.span(last)
        near = f"return {' '.join(span.text.split())}"
    return ClassFault(kind=NO_RETURN, name=Word(function.name, span), near=near, more=used)


def _is_value(node: ast.expr) -> bool:
    """Whether an expression alone in a line is probably a value that is meant to be returned."""
    match node:
        case ast.Call(func=ast.Attribute(attr=name)):
            return name in ("get", "copy", "pop", "values", "keys", "items", "index", "count")
        case ast.Call(func=ast.Name(id=name)):
            return name in CONVERTING | {"min", "max", "sorted", "list", "dict", "tuple", "str"}
    return not isinstance(node, ast.Call | ast.Await | ast.Constant | ast.Yield)
