"""Who uses a userdata key: presets, readers, writers, and the containers that pass it on."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Literal

from smachac.ir import nodes
from smachac.ir.dataflow import Flow, Scope, child_writes
from smachac.ir.graph import START
from smachac.ir.keypaths import around
from smachac.ir.nodes import Key, Leaf, Node
from smachac.ir.userdata import remapping
from smachac.ir.walk import outcome_names
from smachac.source import Span

Kind = Literal["presets", "items", "reads", "writes", "takes in", "hands out"]
"""How a key is used: the container holds it before it starts; an iterator puts its items there; a
leaf; a container, from and to the userdata around it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Use:
    """One use of a key of a container, at its place in a script.

    `path` is the state that uses it, `key` what it calls it there. `outcomes` are those of a
    writer that come with the key; `always` says that they are all it has.
    """

    path: str
    kind: Kind
    key: str
    outcomes: tuple[str, ...] = ()
    always: bool = True
    span: Span = field(compare=False, repr=False)


def uses(flow: Flow, path: str, key: str) -> list[Use]:
    """The uses of one key of the container at a path, in the order of the script."""
    return uses_by_key(flow, path).get(key, [])


def uses_by_key(flow: Flow, path: str) -> dict[str, list[Use]]:
    """The uses of the keys of the container at a path, by key, in the order of the script."""
    scope = flow.scopes[path]
    container = scope.container
    found: dict[str, list[Use]] = {}
    for preset in container.userdata:
        use = Use(path=path, kind="presets", key=preset.key, span=preset.span)
        found.setdefault(preset.key, []).append(use)
    if isinstance(container, nodes.Iterator):
        use = Use(path=path, kind="items", key=container.item_key, span=container.span)
        found.setdefault(use.key, []).append(use)
    for key in scope.reads.get(START, ()):
        use = Use(path=path, kind="reads", key=key, span=container.span)
        found.setdefault(key, []).append(use)
    for child in container.children:
        for key, use in _uses_of(flow, scope, child):
            found.setdefault(key, []).append(use)
    return found


def _uses_of(flow: Flow, scope: Scope, child: Node) -> Iterator[tuple[str, Use]]:
    """The uses that a child makes of the keys of its container."""
    raw = isinstance(scope.container, nodes.Iterator) and isinstance(child, Leaf)
    names = remapping(child)
    path = f"{scope.path}/{child.name}"
    is_leaf = isinstance(child, Leaf)
    kind: Kind = "reads" if is_leaf else "takes in"
    for each in child.inputs:
        span = place_of(child, each)
        yield (
            names.get(each.name, each.name),
            Use(path=path, kind=kind, key=each.name, span=span),
        )
    kind = "writes" if is_leaf else "hands out"
    inner = flow.scopes.get(path)
    known = outcome_names(child) if child.outputs else ()
    endings = [(name, child_writes(child, inner, name, raw=raw)) for name in known]
    for each in child.outputs:
        key = names.get(each.name, each.name)
        written = tuple(
            name for name, writes in endings if writes is not None and key in writes.trusted
        )
        always = written == known
        span = place_of(child, each)
        yield (
            key,
            Use(path=path, kind=kind, key=each.name, outcomes=written, always=always, span=span),
        )


def place_of(node: Node, key: Key) -> Span:
    """Where a script says that a state has a key: its list of keys, its remapping, or its name."""
    remap = next((remap for remap in node.remaps if remap.key == key.name), None)
    if key.span.source is node.span.source:
        return key.span
    return remap.span if remap is not None else node.span


def same_key(flow: Flow, path: str, key: str) -> tuple[tuple[str, str], ...]:
    """The keys of other containers that a key of one comes from or goes to, itself among them.

    In the order of the script.
    """
    found = {(path, key)}
    todo = [(path, key)]
    while todo:
        where, name = todo.pop()
        for pair in _next_to(flow, where, name):
            if pair not in found:
                found.add(pair)
                todo.append(pair)
    order = {path: number for number, path in enumerate(flow.scopes)}
    return tuple(sorted(found, key=lambda pair: (order[pair[0]], pair[1])))


def _next_to(flow: Flow, path: str, key: str) -> Iterator[tuple[str, str]]:
    """The keys one copy away, inwards and outwards."""
    scope = flow.scopes[path]
    outer = around(flow, path)
    for names in (scope.inputs, scope.outputs):
        if outer is not None and key in names:
            yield outer, names[key]
    for name in scope.inner:
        inner = flow.scopes[f"{path}/{name}"]
        for names in (inner.inputs, inner.outputs):
            yield from ((inner.path, own) for own, to in names.items() if to == key)
