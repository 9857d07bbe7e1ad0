"""Calls of functions of the project whose arguments have changed places: an argument has the name
of a parameter that gets another one."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.spelling import SHORTEST_PART, words_of
from smachac.ir.class_facts import ClassFault, FaultKind
from smachac.pysource.modules import Module, OwnClass, find_class, names_of
from smachac.pysource.own_objects import Objects
from smachac.pysource.silent_results import called_function
from smachac.pysource.user_code import UserCode

SWAPPED_ARGUMENTS = FaultKind(
    name="swapped arguments",
    message="the arguments of `{word}` have changed places",
    help="write `{near}`",
    effect="{more}",
    accepted=True,
)

TURNED = frozenset(
    [
        "start",
        "goal",
        "source",
        "target",
        "src",
        "dst",
        "dest",
        "destination",
        "origin",
        "from",
        "to",
        "begin",
        "end",
        "first",
        "second",
        "third",
        "left",
        "right",
        "min",
        "max",
        "low",
        "high",
        "lower",
        "upper",
        "minimum",
        "maximum",
        "old",
        "new",
        "before",
        "after",
        "current",
        "previous",
        "next",
        "parent",
        "child",
        "width",
        "height",
        "length",
        "depth",
        "rows",
        "columns",
        "row",
        "column",
        "horizontal",
        "vertical",
        "expected",
        "actual",
        "base",
        "pose",
        "poses",
        "position",
        "point",
        "frame",
        "here",
        "there",
        "home",
        "one",
        "two",
        "other",
        "same",
        "forward",
        "backward",
        "inner",
        "outer",
        "near",
        "far",
        "top",
        "bottom",
        "front",
        "back",
        "prefix",
        "suffix",
    ]
)
"""Words of parameters that a correct program can pass in the other order, as for the way back."""

ANYTHING = frozenset(
    [
        "value",
        "values",
        "item",
        "items",
        "data",
        "number",
        "object",
        "thing",
        "message",
        "text",
        "name",
        "key",
        "word",
        "result",
        "args",
        "arg",
        "parameter",
        "param",
        "argument",
        "element",
        "entry",
        "list",
        "default",
    ]
)
"""Words of parameters that can get any value."""


class MethodCode(NamedTuple):
    """A method of a class of a state type or of a base class of it: the class with its base
    classes, the module and the class of the method, its nodes that are checked, and the objects
    that the classes make."""

    own: OwnClass
    module: Module
    class_node: ast.ClassDef
    method: ast.FunctionDef
    nodes: Sequence[ast.AST]
    objects: Objects


class _Place(NamedTuple):
    """A parameter with the argument that it gets."""

    parameter: str
    value: ast.expr


def swapped_arguments(code: MethodCode) -> Iterator[ClassFault]:
    """The calls in a method of a class two of whose arguments have changed places."""
    for call in code.nodes:
        if not isinstance(call, ast.Call) or len(call.args) < 2:
            continue
        if not any(_name(each) for each in call.args):
            continue
        called = called_code(code, call)
        if called is None or called is code.method:
            continue
        places = _places(call, called)
        pair = _pair(places, called) if places is not None else None
        if pair is not None:
            yield _fault(code.module, call, places or [], pair)


def called_code(code: MethodCode, call: ast.Call) -> ast.FunctionDef | None:
    """The function or method of the project that a call in a method of a class runs, also that of
    an object, or the constructor; None for one with a decorator."""
    called = code.objects.called
    if call not in called:
        called[call] = _called_code(code, call)
    return called[call]


def _called_code(code: MethodCode, call: ast.Call) -> ast.FunctionDef | None:
    own, module, node, method, _, objects = code
    function = called_function(own, module, method, call.func, objects.library)
    called = function[1] if function is not None else objects.method(module, node, call.func)
    called = called or _constructor(module, call.func, objects.library)
    if called is None or called.decorator_list:
        return None
    head = call.func.value if isinstance(call.func, ast.Attribute) else None
    of_object = function is None or (isinstance(head, ast.Name) and head.id == "self")
    first = [each.arg for each in (*called.args.posonlyargs, *called.args.args)][:1]
    return called if of_object == (first == ["self"]) else None


def takes_self(call: ast.Call, function: ast.FunctionDef) -> bool:
    """Whether the first parameter of a function is the object of the call."""
    taken = [*function.args.posonlyargs, *function.args.args]
    bound = isinstance(call.func, ast.Attribute) or function.name == "__init__"
    return bound and [each.arg for each in taken[:1]] == ["self"]


def _constructor(module: Module, called: ast.expr, library: UserCode) -> ast.FunctionDef | None:
    """The constructor of the class of the project that an expression names."""
    if not isinstance(called, ast.Name) or called.id not in module.names:
        return None
    found = find_class(module, called.id, library)
    bound = names_of(found[1].body)[0].get("__init__", ()) if isinstance(found, tuple) else ()
    match bound:
        case (ast.FunctionDef() as maker,):
            return maker
    return None


def _places(call: ast.Call, function: ast.FunctionDef) -> list[_Place] | None:
    """The parameters that get the arguments without a name; None if they are not known."""
    if any(isinstance(each, ast.Starred) for each in call.args):
        return None
    names = [each.arg for each in (*function.args.posonlyargs, *function.args.args)]
    names = names[1:] if takes_self(call, function) else names
    if len(names) < len(call.args):
        return None
    return [_Place(name, value) for name, value in zip(names, call.args, strict=False)]


def _name(node: ast.expr) -> str:
    """The last part of a name, in lower case: `flow` of `self.flow`; empty for other code."""
    match node:
        case ast.Name(id=name) | ast.Attribute(attr=name):
            return name.casefold().lstrip("_")
        case ast.Subscript(slice=ast.Constant(value=str() as name)):
            return name.casefold()
    return ""


def _pair(places: Sequence[_Place], function: ast.FunctionDef) -> tuple[int, int] | None:
    """The positions of two arguments that have changed places."""
    names = [each.parameter.casefold() for each in places]
    given = [_name(each.value) for each in places]
    for at, name in enumerate(given):
        other = names.index(name) if name in names else at
        if other == at or len(name) < SHORTEST_PART or given.count(name) > 1:
            continue
        if given[other] == names[other] or isinstance(places[other].value, ast.Constant):
            continue
        if given[other] in names and given[other] != names[at]:
            continue
        if not _can_be_turned(names[at], names[other], function):
            return at, other
    return None


def _can_be_turned(one: str, other: str, function: ast.FunctionDef) -> bool:
    """Whether a correct program can pass one parameter in place of another one: they mean the same
    kind of thing, or the function uses both in the same way."""
    some, more = words_of(one), words_of(other)
    if not (some | more).isdisjoint(TURNED | ANYTHING) or not some.isdisjoint(more):
        return True
    kinds = [ast.unparse(each.annotation)
             for each in (*function.args.posonlyargs, *function.args.args)
             if each.arg.casefold() in (one, other) and each.annotation]  # fmt: skip
    if len(kinds) == 2 and kinds[0] == kinds[1] and kinds[0] not in ("float", "int", "str"):
        return True
    for each in ast.walk(function):
        match each:
            case ast.BinOp(left=left, op=ast.Add() | ast.Mult(), right=right):
                if {_name(left), _name(right)} == {one, other}:
                    return True
            case ast.Call(func=ast.Name(id="min" | "max"), args=args):
                if {one, other} <= {_name(arg) for arg in args}:
                    return True
    return False


def _fault(
    module: Module, call: ast.Call, places: Sequence[_Place], pair: tuple[int, int]
) -> ClassFault:
    def text(node: ast.expr) -> str:
        return " ".join(module.text.span(node).text.split())

    first, last = sorted(pair)
    written = [text(each) for each in call.args]
    gets = [f"`{places[at].parameter}` gets the value of `{written[at]}`" for at in (first, last)]
    written[first], written[last] = written[last], written[first]
    written += [f"{each.arg}={text(each.value)}" if each.arg else f"**{text(each.value)}"
                for each in call.keywords]  # fmt: skip
    head = text(call.func)
    start, end = module.text.span(call.args[first]), module.text.span(call.args[last])
    return ClassFault(
        kind=SWAPPED_ARGUMENTS,
        name=Word(head, Span(start.source, start.start, end.end)),
        near=f"{head}({', '.join(written)})",
        more=", and ".join(gets),
    )
