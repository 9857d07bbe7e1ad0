"""Type errors in code that runs for each item of a list: comprehensions, and functions of items.

Such code is Python that is no portable expression as a whole, but its parts are: `p["at"]` in
`[p["at"] for p in ud.pads]`. Whether a list has items is not known, so that only some runs evaluate
the code.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from smachac.analysis.expression_errors import Fault, expression_faults
from smachac.analysis.expression_types import Names, type_of
from smachac.analysis.type_lattice import inside, item_of
from smachac.ir.expressions import Expr
from smachac.ir.script_code import fields_of, script_code
from smachac.ir.types import ANY, Type
from smachac.records import dataclass, replace

OVER_ITEMS = frozenset(["max", "min", "sorted"])
"""Functions with a function of an item as their argument `key`."""

OTHER_CODE = (
    ast.Lambda, ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp, ast.JoinedStr,
    ast.NamedExpr, ast.Starred, ast.Slice, ast.Set,
)  # fmt: skip
"""Parts of code that no portable expression has."""

Comprehension = ast.ListComp | ast.SetComp | ast.DictComp | ast.GeneratorExp


@dataclass(frozen=True, slots=True, kw_only=True)
class _Place:
    """A part of the code: the types of its names, the names of items among them with the keys of
    their lists, and the names and keys in the conditions before it."""

    node: ast.AST
    names: Names
    items: dict[str, tuple[str, ...]]
    guards: frozenset[str] = frozenset()


def has_item_code(text: str) -> bool:
    """Whether code may run for each item of a list."""
    return " for " in text or text.count("lambda") > text.startswith("lambda")


def item_faults(text: str, userdata: Type) -> tuple[Fault, ...]:
    """The faults in the code for items of a function over userdata, a record of the keys it
    reads."""
    found = script_code(text).function
    if found is None:
        return ()
    body, parameters = found
    return tuple(_faults(body, dict.fromkeys(sorted(parameters), userdata), parameters))


def item_keys(text: str) -> tuple[str, ...]:
    """The keys of userdata that code reads, if it may run for each item of a list."""
    found = script_code(text).function if has_item_code(text) else None
    fields = fields_of(*found) if found is not None else None
    return fields.read if fields is not None else ()


def _faults(body: ast.expr, names: Names, userdata: frozenset[str]) -> Iterator[Fault]:
    todo = [_Place(node=body, names=names, items={})]
    while todo:
        place = todo.pop()
        tree = _portable(place.node) if place.items else None
        if tree is not None:
            yield from _judged(place, tree, userdata)
        else:
            todo += reversed(list(_inside(place, userdata)))


def _portable(node: ast.AST) -> Expr | None:
    """A part of the code as a portable expression; None if it is other code."""
    other = any(isinstance(part, OTHER_CODE) for part in ast.walk(node))
    return (
        script_code(ast.unparse(node)).portable
        if isinstance(node, ast.expr) and not other
        else None
    )


def _judged(place: _Place, tree: Expr, userdata: frozenset[str]) -> Iterator[Fault]:
    """The faults of a portable part that no condition before it may exclude: one over the same
    names or, for a field that is missing, one with its name."""
    items = tuple(place.items)
    shown = {name: type_ for name, type_ in place.names.items() if name not in userdata}
    keys = next((place.names[name] for name in sorted(userdata) if name in place.names), ANY)
    for fault in expression_faults(tree, keys, tuple(sorted(userdata)), shown):
        named = {*fault.keys, *(name for key in fault.keys for name in place.items.get(key, ()))}
        excluding = {repr(fault.word)} if fault.word else named
        if not fault.length and excluding.isdisjoint(place.guards) and named.intersection(items):
            sources = [key for name in fault.keys for key in place.items.get(name, (name,))]
            yield replace(fault, keys=tuple(dict.fromkeys(sources)), always=False)


def _inside(place: _Place, userdata: frozenset[str]) -> Iterator[_Place]:
    """The parts of a part, each with its names and conditions."""
    node = place.node
    match node:
        case ast.ListComp() | ast.SetComp() | ast.DictComp() | ast.GeneratorExp():
            yield from _comprehension(place, node, userdata)
        case ast.Call(func=function, args=given, keywords=keywords):
            yield replace(place, node=function)
            for value in (*given, *(keyword.value for keyword in keywords)):
                if not isinstance(value, ast.Lambda):
                    yield replace(place, node=value)
            yield from _function_of_items(place, node, userdata)
        case ast.Lambda():
            return
        case ast.IfExp(test=test, body=then, orelse=otherwise):
            yield replace(place, node=test)
            yield _after(replace(place, node=then), [test], userdata)
            yield _after(replace(place, node=otherwise), [test], userdata)
        case ast.BoolOp(values=values):
            for number, value in enumerate(values):
                yield _after(replace(place, node=value), values[:number], userdata)
        case _:
            yield from (replace(place, node=part) for part in ast.iter_child_nodes(node))


def _after(place: _Place, tests: Sequence[ast.expr], userdata: frozenset[str]) -> _Place:
    """A part that runs only if conditions hold, which may exclude a fault in it."""
    if not tests:
        return place
    return replace(
        place, guards=place.guards.union(*(_mentioned(test, userdata) for test in tests))
    )


def _mentioned(node: ast.expr, userdata: frozenset[str]) -> frozenset[str]:
    """The names, the keys of userdata and the texts, in quotes, in code."""
    every = [*ast.walk(node)]
    names = {name.id for name in every if isinstance(name, ast.Name)} - userdata
    texts = {repr(node.value) for node in every if isinstance(node, ast.Constant)}
    return frozenset(names | texts).union(_keys(node, userdata))


def _keys(node: ast.expr, userdata: frozenset[str]) -> tuple[str, ...]:
    fields = fields_of(node, userdata)
    return fields.read if fields is not None else ()


def _comprehension(
    place: _Place, node: Comprehension, userdata: frozenset[str]
) -> Iterator[_Place]:
    """The lists, conditions and elements of a comprehension."""
    for loop in node.generators:
        yield replace(place, node=loop.iter)
        place = _with_item(place, loop.target, loop.iter, userdata)
        for number, test in enumerate(loop.ifs):
            yield _after(replace(place, node=test), loop.ifs[:number], userdata)
        place = _after(place, loop.ifs, userdata)
    elements = [node.key, node.value] if isinstance(node, ast.DictComp) else [node.elt]
    yield from (replace(place, node=element) for element in elements)


def _function_of_items(place: _Place, node: ast.Call, userdata: frozenset[str]) -> Iterator[_Place]:
    """The body of a function that is called with each item of a list."""
    match node:
        case ast.Call(func=ast.Name(id=name), args=[items], keywords=keywords) if (
            name in OVER_ITEMS
        ):
            found = [keyword.value for keyword in keywords if keyword.arg == "key"]
        case ast.Call(func=ast.Name(id="map" | "filter"), args=[function, items]):
            found = [function]
        case _:
            return
    for function in found:
        if isinstance(function, ast.Lambda) and len(function.args.args) == 1:
            item = ast.Name(id=function.args.args[0].arg, ctx=ast.Store())
            yield replace(_with_item(place, item, items, userdata), node=function.body)


def _with_item(
    place: _Place, target: ast.expr, items: ast.expr, userdata: frozenset[str]
) -> _Place:
    """The place in a loop: its names stand for an item of the list."""
    type_, inner = _type(items, place.names), target
    item = item_of(type_)
    match items, target:
        case ast.Call(func=ast.Name(id="enumerate"), args=[value, *_]), ast.Tuple(elts=[_, second]):
            item, inner = item_of(_type(value, place.names)), second
        case ast.Call(func=ast.Name(id="reversed"), args=[value]), _:
            item = item_of(_type(value, place.names))
        case ast.Call(func=ast.Attribute(value=value, attr="values"), args=[]), _:
            owner = _type(value, place.names)
            item = inside(owner) if owner.name == "dict" else ANY
        case ast.Call(func=ast.Attribute(value=value, attr="items"), args=[]), ast.Tuple(
            elts=[_, second]
        ):
            owner = _type(value, place.names)
            item, inner = inside(owner) if owner.name == "dict" else ANY, second
    bound = {node.id for node in ast.walk(target) if isinstance(node, ast.Name)}
    types = dict(place.names) | dict.fromkeys(bound, ANY)
    owners = {name: keys for name, keys in place.items.items() if name not in bound}
    guards = place.guards - bound
    if isinstance(inner, ast.Name):
        types[inner.id] = item
        origins = {
            name
            for node in ast.walk(items)
            if isinstance(node, ast.Name)
            for name in place.items.get(node.id, ())
        }
        owners[inner.id] = tuple(dict.fromkeys([*_keys(items, userdata), *sorted(origins)]))
    return replace(place, names=types, items=owners, guards=guards)


def _type(node: ast.expr, names: Names) -> Type:
    tree = _portable(node)
    return type_of(tree, names) if tree is not None else ANY
