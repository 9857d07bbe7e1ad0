"""Reads of userdata keys that can be unset, with the cause."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from collections.abc import Set as AbstractSet
from functools import cache
from typing import Literal, NamedTuple

from smachac.analysis.accesses import NOTHING
from smachac.analysis.def_use import Reached, Search, around, search, way_to
from smachac.analysis.definite_assignment import DataFlow, UserdataScope, child_writes
from smachac.diagnostics.diagnostic import PathStep
from smachac.diagnostics.source import NOWHERE, Span
from smachac.ir import nodes
from smachac.ir.graph import Vertex
from smachac.ir.nodes import Concurrence, Node
from smachac.ir.script_paths import name_in_script
from smachac.ir.traversal import outcome_names, remapping
from smachac.records import dataclass

MOST_LEVELS = 50
"""The most containers outwards in which a key that is no output is searched."""

Cause = Literal["unset", "nowhere", "lost", "outside", "remapped"]
"""Why a key is unset: some path does not set it; nothing in the container sets it; it is set inside
a container of which it is no output; an outer container has it, but it is no input; a remap refers
to a key that nothing sets."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Missing:
    """A key of a container that is needed at vertices where it may be unset.

    `other` is the path of the container around that has the key, or of the one inside that keeps
    it.
    """

    scope: UserdataScope
    key: str
    vertices: tuple[Vertex, ...]
    cause: Cause
    other: str = ""


def missing_keys(flow: DataFlow) -> tuple[Missing, ...]:
    """The keys that are needed where they may be unset, in the order of the script."""
    provided = cache(lambda path: provided_keys(flow.scopes[path]))
    found = [
        (scope, key, tuple(vertices))
        for scope in flow.scopes.values()
        if scope.path in flow.entered
        for key, vertices in _unset_reads(flow, scope).items()
    ]
    kept = _kept_inside(flow, {(scope.path, key) for scope, key, _ in found})
    sorted_out = []
    for scope, key, vertices in found:
        cause: Cause = "unset"
        other = ""
        if not provided(scope.path).has(key):
            cause, other = "nowhere", kept.get((scope.path, key), "")
            outer = _outside(flow, scope.path, key, provided)
            if outer:
                cause, other = "outside", outer
            elif other:
                cause = "lost"
            elif any(_remapped(scope, vertex, key) for vertex in vertices):
                cause = "remapped"
        sorted_out.append(
            Missing(scope=scope, key=key, vertices=vertices, cause=cause, other=other)
        )
    return tuple(sorted_out)


def _unset_reads(flow: DataFlow, scope: UserdataScope) -> dict[str, list[Vertex]]:
    """The keys that can be unset where they are read.

    What can be handed in is judged outside; what a sibling of a concurrence writes at that time is
    a race (SM405).
    """
    found: dict[str, list[Vertex]] = {}
    for vertex, keys in scope.unset.items():
        for key in keys:
            if key not in scope.inputs or key in scope.optional:
                found.setdefault(key, []).append(vertex)
    if found and isinstance(scope.container, Concurrence):
        writers = sibling_writers(flow, scope)
        return {
            key: vertices
            for key, vertices in found.items()
            if all(writers.get(key, set()) <= {vertex} for vertex in vertices)
        }
    return found


def sibling_writers(flow: DataFlow, scope: UserdataScope) -> dict[str, set[Vertex]]:
    """By key the children of a concurrence that may write it."""
    found: dict[str, set[Vertex]] = {}
    for child in scope.container.children:
        inner = flow.scopes.get(f"{scope.path}/{child.name}")
        for outcome in outcome_names(child):
            writes = child_writes(child, inner, outcome, raw=False)
            for key in writes.perhaps if writes is not None else ():
                found.setdefault(key, set()).add(child.name)
    return found


class Provided(NamedTuple):
    """The keys that something in a container is there to set, or that are handed in."""

    keys: frozenset[str]
    anything: bool

    def has(self, key: str) -> bool:
        return self.anything or key in self.keys


def provided_keys(scope: UserdataScope) -> Provided:
    keys = {*scope.uses.provided}
    written = [
        step.writes
        for steps in scope.steps.values()
        for step in steps
        if step.writes is not NOTHING
    ]
    keys.update(*[writes.perhaps for writes in written])
    return Provided(frozenset(keys), any(writes.anything for writes in written))


def _outside(flow: DataFlow, path: str, key: str, provided: Callable[[str], Provided]) -> str:
    """The nearest container around that has a key of that name; empty if there is none."""
    outer = around(flow, path)
    while outer is not None and key not in provided(outer).keys:
        outer = around(flow, outer)
    return outer or ""


def _remapped(scope: UserdataScope, vertex: Vertex, key: str) -> bool:
    child = scope.children.get(str(vertex))
    return child is not None and any(remap.to == key for remap in child.remaps)


def _kept_inside(
    flow: DataFlow, missing: AbstractSet[tuple[str, str]]
) -> dict[tuple[str, str], str]:
    """For keys that are missing, the container that writes them inside and keeps them."""
    found: dict[tuple[str, str], str] = {}
    for scope in flow.scopes.values() if missing else ():
        for use in scope.uses.all:
            if use.writes and use.outer not in scope.outputs:
                _climb(flow, scope, use.outer, missing, found)
    return found


def _climb(
    flow: DataFlow,
    scope: UserdataScope,
    key: str,
    missing: AbstractSet[tuple[str, str]],
    found: dict[tuple[str, str], str],
) -> None:
    """Look for a container around in which a key that is kept here is missing."""
    here = scope.path
    for _ in range(MOST_LEVELS):
        outer = around(flow, here)
        if outer is None:
            return
        key = remapping(flow.scopes[here].container)[key]
        if (outer, key) in missing:
            found.setdefault((outer, key), scope.path)
        here = outer


MOST_STEPS = 250_000
"""Steps of all searches for one rule: beyond that findings come without a path, so that ten
thousand faults take no longer than they should."""


class Witness(NamedTuple):
    """A vertex of a container that finds a key unset.

    `always`: on every path. `inner` is the state that reads the key, where the vertex is a
    container. `also` are further such vertices.
    """

    reader: Reader
    always: bool
    inner: Reader | None
    path: tuple[PathStep, ...]
    also: tuple[Vertex, ...] = ()


@dataclass(slots=True)
class Searches:
    """Searches for witnesses as long as there are steps left."""

    flow: DataFlow
    left: int = MOST_STEPS

    def witnesses(self, missing: Missing) -> Iterator[Witness]:
        """Each vertex that is the first to find the key unset on some path.

        One for all where nothing sets the key, as that is one fault.
        """
        scope, nothing_sets = missing.scope, missing.cause != "unset"
        if self.left <= 0:
            reader = reader_at(scope, missing.vertices[0], missing.key)
            yield Witness(reader, nothing_sets, None, ())
            return
        found = self._search(scope, missing.key)
        unset = [
            reached.vertex
            for reached in found
            if reached.state == "unset" and missing.key in scope.reads.get(reached.vertex, ())
        ]
        for vertex in unset[:1] if nothing_sets else unset:
            inner, inside, always = self._inside(scope, vertex, missing.key)
            yield Witness(
                reader_at(scope, vertex, missing.key),
                always and Reached(vertex, "set") not in found,
                inner,
                tuple(way_to(scope.path, found, Reached(vertex, "unset")) + inside),
                tuple(value for value in missing.vertices if value != vertex)
                if nothing_sets
                else (),
            )

    def _search(self, scope: UserdataScope, key: str) -> Search:
        found = search(self.flow, scope, key, ["unset"], stops=True)
        read = sum(len(scope.reads.get(reached.vertex, ())) for reached in found)
        self.left -= len(scope.reads) + len(found) + read // 10  # a look at a key is a short step
        return found

    def _inside(
        self, scope: UserdataScope, vertex: Vertex, key: str
    ) -> tuple[Reader | None, list[PathStep], bool]:
        """What reads the key inside a container, the way to it there through states of the script,
        and whether it never finds the key."""
        way: list[PathStep] = []
        always, outermost = True, scope
        while vertex in scope.inner and self.left > 0:
            scope = self.flow.scopes[f"{scope.path}/{vertex}"]
            key = next(own for own, to in scope.inputs.items() if to == key and own in scope.needed)
            found = self._search(scope, key)
            vertex = next(
                reached.vertex
                for reached in found
                if reached.state == "unset" and key in scope.reads.get(reached.vertex, ())
            )
            always = always and Reached(vertex, "set") not in found
            if not scope.container.sugar:  # its states are not in the script
                way += way_to(scope.path, found, Reached(vertex, "unset"))
        inner = reader_at(scope, vertex, key) if scope is not outermost else None
        return inner, way, always


class Reader(NamedTuple):
    """A state that reads a key of its container: the name of the key in the state, the span of that
    name, and the start of a sentence about the read."""

    path: str
    node: Node
    key: str
    span: Span
    words: str


def container_name(scope: UserdataScope, span: Span) -> str:
    """The name of a container in a message: "the sub-script" for the root of a called script, which
    has another name at each call."""
    own = scope.container.span.source
    is_called = own is not span.source and own.language != "python"
    return "the sub-script" if is_called else f"`{scope.container.name}`"


def reader_at(scope: UserdataScope, vertex: Vertex, key: str) -> Reader:
    """The state at a vertex of a container; the container itself where that is its start."""
    node: Node = scope.container
    if not isinstance(vertex, str):
        span = node.items_span if isinstance(node, nodes.Iterator) else node.span
        span = node.span if span.source is NOWHERE.source else span
        return Reader(scope.path, node, key, span, f"`{node.name}` iterates over `{key}`")
    node = scope.children[vertex]
    use = scope.uses.by_reader.get((vertex, key))
    span = node.span if use is None else use.span
    called = f"`{key}`"
    name = key if use is None else use.key
    if name != key:
        called = f"`{name}` (`{key}` in {container_name(scope, span)})"
    words = f"`{name_in_script(node)}` reads {called}"
    return Reader(f"{scope.path}/{vertex}", node, name, span, words)
