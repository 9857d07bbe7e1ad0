"""Loops over initial values of userdata that are not empty and that no state changes."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Mapping, Sequence

from smachac.analysis.accesses import Accesses, inside
from smachac.ir import nodes
from smachac.ir.nodes import Container, Leaf
from smachac.ir.script_code import fields_of, script_code
from smachac.ir.traversal import expressions, remapping

Origin = tuple[str, str]
"""The path of a container and a key that it presets with a list."""

READERS = frozenset(
    ["all", "any", "bool", "enumerate", "len", "list", "map", "max", "min", "range", "reversed",
     "sorted", "str", "sum", "tuple", "zip"]
)  # fmt: skip
"""Functions that read the items of a list."""

READING = frozenset(["copy", "count", "index"])
"""Methods that leave a list as it is."""

EMPTYING = frozenset(["clear", "pop", "remove"])
"""Methods that can empty a list."""


def filled_loops(
    containers: Sequence[tuple[str, Container]], accesses: Callable[[], Mapping[str, Accesses]]
) -> frozenset[str]:
    """The paths of the iterators that surely run at least once: their items are a key whose value
    is a preset list with items, and no state writes the key or can change the list.

    `accesses` returns those of every state, which few machines need; `containers` have parents
    before children.
    """
    loops = [container for container in containers if isinstance(container[1], nodes.Iterator)]
    if not any(
        isinstance(container, nodes.Iterator) and container.items_key for _, container in loops
    ):
        return frozenset()
    lists = _lists(containers, accesses())
    if not any(lists.values()):
        return frozenset()
    changed = {origin for path, node in containers for origin in _changed(node, lists[path])}
    return frozenset(
        path
        for path, node in loops
        if isinstance(node, nodes.Iterator)
        and (origin := lists[path].get(node.items_key)) is not None
        and origin not in changed
    )


def _lists(
    containers: Sequence[tuple[str, Container]], known: Mapping[str, Accesses]
) -> Mapping[str, dict[str, Origin]]:
    """By path of a container, its keys that hold a preset list with items while it runs."""
    found: dict[str, dict[str, Origin]] = {}
    for path, node in containers:
        inputs = {key.name for key in node.inputs}
        own: dict[str, Origin] = {
            preset.key: (path, preset.key)
            for preset in node.userdata
            if isinstance(preset.value.data, tuple)
            and preset.value.data
            and not preset.given
            and preset.key not in inputs
        }
        around = found.get(path.removesuffix(f"/{node.name}"), {})
        if around and inputs:
            names = remapping(node)
            held = {key: around.get(names[key]) for key in inputs}
            own |= {key: origin for key, origin in held.items() if origin is not None}
        if own:
            written = inside(path, node, known).writes
            own = {key: origin for key, origin in own.items() if key not in written}
        found[path] = own
    return found


def _changed(container: Container, lists: Mapping[str, Origin]) -> Iterator[Origin]:
    """The lists that a child of a container can empty."""
    for child in container.children if lists else ():
        if not isinstance(child, Leaf):
            continue
        if child.open:
            yield from lists.values()
            continue
        raw = isinstance(container, nodes.Iterator)
        names = remapping(child)
        own = [*lists] if raw else [key.name for key in child.inputs]
        declared = {key.name for key in child.inputs}
        for key in own:
            origin = lists.get(key if raw else names[key])
            if origin is not None and _can_empty(child, key, declared=key in declared):
                yield origin


def _can_empty(leaf: Leaf, key: str, *, declared: bool) -> bool:
    """Whether a leaf can empty the list in a key, by its class or by code of the script."""
    if not leaf.built_in and not leaf.stand_in:
        facts = leaf.class_facts
        if facts is None and declared:
            return True
        parts = facts.parts if facts is not None else ()
        methods = [part.steps for part in parts if part.key == key]
        if any(steps == (("attribute", name),) for steps in methods for name in EMPTYING):
            return True
    return not all(_only_reads(code.text, key) for code in expressions(leaf))


def _only_reads(text: str, key: str) -> bool:
    """Whether code over userdata uses the list in a key only to read it."""
    found = script_code(text).function
    fields = fields_of(*found) if found is not None else None
    if found is None or fields is None:
        return False
    if key not in fields.read:
        return True
    body, names = found
    if _is_key(body, key, names):
        return False  # the result is the same list
    return all(
        _reads(node, part)
        for node in ast.walk(body)
        for part in ast.iter_child_nodes(node)
        if _is_key(part, key, names)
    )


def _is_key(node: ast.AST, key: str, names: frozenset[str]) -> bool:
    match node:
        case ast.Attribute(value=ast.Name(id=name), attr=attribute):
            return name in names and attribute == key
        case ast.Subscript(value=ast.Name(id=name), slice=ast.Constant(value=value)):
            return name in names and value == key
    return False


def _reads(node: ast.AST, part: ast.AST) -> bool:
    """Whether a part of the code, a list, is only read by the code directly around it."""
    match node:
        case ast.Call(func=ast.Name(id=name)):
            return name in READERS
        case ast.Attribute(attr=name):
            return name in READING
        case ast.comprehension(iter=items):
            return items is part
        case ast.IfExp(test=test):
            return test is part
        case ast.Subscript(value=value):
            return value is part
        case ast.Compare() | ast.FormattedValue() | ast.UnaryOp() | ast.BinOp():
            return True
    return False
