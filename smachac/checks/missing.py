"""Userdata that is read where it may be unset, sorted by what is wrong."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Literal, NamedTuple

from smachac.ir import nodes
from smachac.ir.dataflow import Flow, Scope, child_writes
from smachac.ir.graph import Place
from smachac.ir.keypaths import around
from smachac.ir.nodes import Concurrence
from smachac.ir.userdata import remapping
from smachac.ir.walk import outcome_names

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
