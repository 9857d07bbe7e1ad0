"""Userdata that is read where it may be unset, sorted by what is wrong."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Literal, NamedTuple

from smachac.analysis.def_use import Reached, Search, around, place_of, search, way_to
from smachac.analysis.definite_assignment import Flow, Scope, child_writes
from smachac.diagnostics.source import Span
from smachac.ir import nodes
from smachac.ir.graph import Place
from smachac.ir.nodes import Concurrence, Node
from smachac.ir.traversal import outcome_names, remapping

MOST_LEVELS = 50
"""So many containers outwards a key is looked for that something inside keeps."""

Cause = Literal["unset", "nowhere", "lost", "outside", "remapped"]
"""Why a key is not there: some path does not set it; nothing in the container sets it at all; what
sets it does so inside a container that keeps it; a container around has it and it is not taken in;
a remap leads to a name that nothing has."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Missing:
    """A key of a container that is needed at places where it may be unset.

    `other` is the path of the container around that has the key, or of the one inside that keeps
    it.
    """

    scope: Scope
    key: str
    places: tuple[Place, ...]
    cause: Cause
    other: str = ""


def missing_keys(flow: Flow, *causes: Cause) -> Iterator[Missing]:
    """The keys that are missing for one of those causes, in the order of the script."""
    return (each for each in _all_missing(flow) if each.cause in causes)


@lru_cache(maxsize=1)
def _all_missing(flow: Flow) -> tuple[Missing, ...]:
    provided = cache(lambda path: _provided(flow.scopes[path]))
    found = [
        (scope, key, tuple(places))
        for scope in flow.scopes.values()
        if scope.path in flow.entered
        for key, places in _unset_reads(flow, scope).items()
    ]
    kept = _kept_inside(flow, {(scope.path, key) for scope, key, _ in found})
    sorted_out = []
    for scope, key, places in found:
        cause: Cause = "unset"
        other = ""
        if not provided(scope.path).has(key):
            cause, other = "nowhere", kept.get((scope.path, key), "")
            outer = _outside(flow, scope.path, key, provided)
            if outer:
                cause, other = "outside", outer
            elif other:
                cause = "lost"
            elif any(_remapped(scope, place, key) for place in places):
                cause = "remapped"
        sorted_out.append(Missing(scope=scope, key=key, places=places, cause=cause, other=other))
    return tuple(sorted_out)


def _unset_reads(flow: Flow, scope: Scope) -> dict[str, list[Place]]:
    """The keys that may be unset where they are needed.

    What can be handed in is judged outside; what a sibling of a concurrence writes at that time is
    a race (SM405).
    """
    found: dict[str, list[Place]] = {}
    for place, keys in scope.unset.items():
        for key in keys:
            if key not in scope.inputs or key in scope.optional:
                found.setdefault(key, []).append(place)
    if found and isinstance(scope.container, Concurrence):
        writers = sibling_writers(flow, scope)
        return {
            key: places
            for key, places in found.items()
            if all(writers.get(key, set()) <= {place} for place in places)
        }
    return found


def sibling_writers(flow: Flow, scope: Scope) -> dict[str, set[Place]]:
    """By key the children of a concurrence that may write it."""
    found: dict[str, set[Place]] = {}
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


def _provided(scope: Scope) -> Provided:
    container = scope.container
    keys = {*scope.held, *scope.inputs}
    if isinstance(container, nodes.Iterator):
        keys.add(container.item_key)
    for child in container.children:
        names = remapping(child)
        keys.update(names.get(each.name, each.name) for each in child.outputs)
    leading = [step for steps in scope.steps.values() for step in steps]
    keys.update(key for step in leading for key in step.writes.perhaps)
    return Provided(frozenset(keys), any(step.writes.anything for step in leading))


def _outside(flow: Flow, path: str, key: str, provided: Callable[[str], Provided]) -> str:
    """The nearest container around that has a key of that name; empty if there is none."""
    outer = around(flow, path)
    while outer is not None and key not in provided(outer).keys:
        outer = around(flow, outer)
    return outer or ""


def _remapped(scope: Scope, place: Place, key: str) -> bool:
    return any(
        remap.to == key
        for child in scope.container.children
        if child.name == place
        for remap in child.remaps
    )


def _kept_inside(flow: Flow, missing: AbstractSet[tuple[str, str]]) -> dict[tuple[str, str], str]:
    """For keys that are missing, the container that writes them inside and keeps them."""
    found: dict[tuple[str, str], str] = {}
    for scope in flow.scopes.values() if missing else ():
        for child in scope.container.children:
            names = remapping(child)
            for each in child.outputs:
                key = names.get(each.name, each.name)
                if key not in scope.outputs:
                    _climb(flow, scope, key, missing, found)
    return found


def _climb(
    flow: Flow,
    scope: Scope,
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
        key = remapping(flow.scopes[here].container).get(key, key)
        if (outer, key) in missing:
            found.setdefault((outer, key), scope.path)
        here = outer


MOST_STEPS = 250_000
"""Steps of all searches for one rule: beyond that findings come without a path, so that ten
thousand faults take no longer than they should."""


class Witness(NamedTuple):
    """A place of a container that finds a key unset.

    `always`: whichever way it is entered. `inner` is what reads it in the end, where the place is a
    container. `also` are more such places.
    """

    reader: Reader
    always: bool
    inner: Reader | None
    path: tuple[str, ...]
    also: tuple[Place, ...] = ()


@dataclass(slots=True)
class Searches:
    """Searches for witnesses as long as there are steps left."""

    flow: Flow
    left: int = MOST_STEPS

    def witnesses(self, missing: Missing) -> Iterator[Witness]:
        """Each place that is the first to find the key unset on some path.

        One for all where nothing sets the key, as that is one fault.
        """
        scope, nothing_sets = missing.scope, missing.cause != "unset"
        if self.left <= 0:
            reader = reader_at(scope, missing.places[0], missing.key)
            yield Witness(reader, nothing_sets, None, ())
            return
        found = self._search(scope, missing.key)
        unset = [
            each.place
            for each in found
            if each.state == "unset" and missing.key in scope.reads.get(each.place, ())
        ]
        for place in unset[:1] if nothing_sets else unset:
            inner, inside, always = self._inside(scope, place, missing.key)
            yield Witness(
                reader_at(scope, place, missing.key),
                always and Reached(place, "set") not in found,
                inner,
                tuple(way_to(found, Reached(place, "unset")) + inside),
                tuple(each for each in missing.places if each != place) if nothing_sets else (),
            )

    def _search(self, scope: Scope, key: str) -> Search:
        found = search(self.flow, scope, key, ["unset"], stops=True)
        self.left -= len(scope.reads) + len(found)
        return found

    def _inside(
        self, scope: Scope, place: Place, key: str
    ) -> tuple[Reader | None, list[str], bool]:
        """What reads the key inside a container, the way to it there, and whether it never finds
        the key."""
        way: list[str] = []
        always, outermost = True, scope
        while place in scope.inner and self.left > 0:
            scope = self.flow.scopes[f"{scope.path}/{place}"]
            key = next(own for own, to in scope.inputs.items() if to == key and own in scope.needed)
            found = self._search(scope, key)
            place = next(
                each.place
                for each in found
                if each.state == "unset" and key in scope.reads.get(each.place, ())
            )
            always = always and Reached(place, "set") not in found
            way += way_to(found, Reached(place, "unset"))
        inner = reader_at(scope, place, key) if scope is not outermost else None
        return inner, way, always


class Reader(NamedTuple):
    """A state that needs a key of its container, where the script says so, and in words."""

    path: str
    node: Node
    span: Span
    words: str


def container_name(scope: Scope, span: Span) -> str:
    """What a finding calls a container: a sub-script has another name at each call, and a fault
    in it is one fault."""
    is_called = scope.container.span.source is not span.source
    return "the sub-script" if is_called else f"`{scope.container.name}`"


def reader_at(scope: Scope, place: Place, key: str) -> Reader:
    """The state at a place of a container; the container itself where that is its start."""
    node: Node = scope.container
    if not isinstance(place, str):
        return Reader(scope.path, node, node.span, f"`{node.name}` goes through `{key}`")
    node = scope.children[place]
    names = remapping(node)
    own = next((each for each in node.inputs if names.get(each.name, each.name) == key), None)
    span = node.span if own is None else place_of(node, own)
    called = f"`{key}`"
    if own is not None and own.name != key:
        called = f"`{own.name}` (`{key}` of {container_name(scope, span)})"
    return Reader(f"{scope.path}/{place}", node, span, f"`{node.name}` reads {called}")
