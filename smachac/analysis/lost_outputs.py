"""Lost outputs: keys that are written inside a container and read outside, but are no outputs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain
from typing import NamedTuple

from smachac.analysis.def_use import around, place_in
from smachac.analysis.definite_assignment import DataFlow, FactOf, UserdataScope
from smachac.analysis.unset_reads import MOST_STEPS, Missing, Reader, reader_at
from smachac.diagnostics.spelling import guesser
from smachac.ir.graph import Vertex
from smachac.ir.nodes import Key, Leaf, Node
from smachac.ir.traversal import remapping


class Lost(NamedTuple):
    """A key that is written inside the container `keeper` and is no output, but `reader` reads it.

    `own` is what the keeper calls it. `is_missing`: the reader finds nothing else. `misspelt` is an
    output key of the keeper that nothing in it sets and that is probably meant for it.
    """

    keeper: UserdataScope
    own: str
    writer: Node
    written: Key
    reader: Reader
    key: str
    is_missing: bool
    misspelt: Key | None = None


def lost_outputs(flow: DataFlow, lost_keys: Iterable[Missing], fact_of: FactOf) -> tuple[Lost, ...]:
    """The outputs that containers keep to themselves, in the order of the script. `lost_keys` are
    those of them without which a reader finds nothing."""
    return tuple(_lost(flow, lost_keys, fact_of))


def _lost(flow: DataFlow, lost_keys: Iterable[Missing], fact_of: FactOf) -> Iterator[Lost]:
    reported: set[tuple[str, str]] = set()
    for missing in lost_keys:
        lost = _missed(flow, missing)
        reported.add((lost.keeper.path, lost.own))
        yield lost
    left = MOST_STEPS
    for scope in flow.scopes.values():
        outer = around(flow, scope.path)
        if outer is None or scope.path not in flow.entered or scope.container.sugar:
            continue
        kept: tuple[tuple[Node, Key, str], ...] = fact_of(_kept, scope.path, scope)
        for writer, written, own in kept:
            around_it = flow.scopes[outer]
            key = remapping(scope.container).get(own, own)
            read = fact_of(_read, outer, around_it)
            if key not in read or left <= 0 or (scope.path, own) in reported:
                continue
            left -= len(around_it.steps) + len(around_it.reads)
            vertex = _read_after(around_it, place_in(outer, scope.path), key)
            if vertex is not None:
                reader = reader_at(around_it, vertex, key)
                yield Lost(scope, own, writer, written, reader, key, False)


def _missed(flow: DataFlow, missing: Missing) -> Lost:
    keeper = flow.scopes[missing.other]
    for writer in keeper.container.children:
        names = remapping(writer)
        for written in writer.outputs:
            own = names.get(written.name, written.name)
            if own not in keeper.outputs and _name_at(flow, keeper, own, missing) == missing.key:
                reader = reader_at(missing.scope, missing.vertices[0], missing.key)
                meant = _misspelt(keeper, own)
                return Lost(keeper, own, writer, written, reader, missing.key, True, meant)
    raise AssertionError("a keeper writes what it keeps")


def _misspelt(keeper: UserdataScope, own: str) -> Key | None:
    """The output key of a container that no state in it sets and whose name is near to a key."""
    children = keeper.container.children
    set_ = {remapping(each).get(key.name, key.name) for each in children for key in each.outputs}
    set_ |= {*keeper.inputs, *(preset.key for preset in keeper.container.userdata)}
    unset = {key.name: key for key in keeper.container.outputs if key.name not in set_}
    return unset.get(guesser(unset)(own) or "")


def _name_at(flow: DataFlow, scope: UserdataScope, own: str, missing: Missing) -> str:
    """What a key would be called in the container where it is missing."""
    path: str | None = scope.path
    while path is not None and path != missing.scope.path:
        own = remapping(flow.scopes[path].container).get(own, own)
        path = around(flow, path)
    return own


def _read(scope: UserdataScope) -> frozenset[str]:
    """The keys that something in a container reads."""
    return frozenset(chain(*scope.reads.values()))


def _kept(scope: UserdataScope) -> tuple[tuple[Node, Key, str], ...]:
    """The keys that leaves of a container write and that are no outputs of it. A key that is also
    read in the container counts only if it is an input, because then it has one name outside."""
    container = scope.container
    read = {
        names.get(key.name, key.name)
        for child in container.children
        for names in [remapping(child)]
        for key in child.inputs
    }
    found: list[tuple[Node, Key, str]] = []
    for child in container.children:
        for key in child.outputs if isinstance(child, Leaf) else ():
            own = remapping(child).get(key.name, key.name)
            is_local = own in read and own not in scope.inputs
            if key.span.source is child.span.source and own not in scope.outputs and not is_local:
                found.append((child, key, own))
    return tuple(found)


def _read_after(scope: UserdataScope, start: str, key: str) -> Vertex | None:
    """A vertex that reads a key after another one and before anything writes it."""
    # By hand: networkx needs a graph for each key and takes 3.7 ms instead of 0.9 ms for 1,000
    # states and 40 ms instead of 10 ms for 10,000, that is 2 % of a check with one fault, 22 % with
    # ten; its import adds 128 ms to a check of 10 states, which takes 226 ms (bench/searches.py).
    todo: list[Vertex] = [start]
    seen: set[Vertex] = set(todo)
    for vertex in todo:
        for step in scope.steps.get(vertex, ()):
            if key in step.writes.trusted or step.writes.anything or step.target in seen:
                continue
            if key in scope.reads.get(step.target, ()):
                return step.target
            seen.add(step.target)
            todo.append(step.target)
    return None
