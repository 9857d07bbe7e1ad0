"""Lost outputs: keys that are written inside a container and read outside, but are no outputs."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from itertools import chain
from typing import NamedTuple

from smachac.analysis.def_use import around, place_in
from smachac.analysis.definite_assignment import DataFlow, FactOf, UserdataScope
from smachac.analysis.unset_reads import MOST_LEVELS, MOST_STEPS, Missing, Reader, reader_at
from smachac.analysis.uses import Use
from smachac.diagnostics.spelling import guesser
from smachac.ir import nodes
from smachac.ir.graph import Vertex
from smachac.ir.leaf import functions, variable_of
from smachac.ir.nodes import Concurrence, Key, Leaf, Node, Sequence, StateMachine
from smachac.ir.script_code import fields_of, script_code
from smachac.ir.script_paths import sugared_child
from smachac.ir.traversal import outer_inputs, outer_outputs, remapping


class Lost(NamedTuple):
    """A key that is written inside the container `keeper` and is no output, but `reader` reads it.

    `written` is the use that writes it. `is_missing`: the reader finds nothing else. `misspelt` is
    an output key of the keeper that nothing in it sets and that is probably meant for it.
    """

    keeper: UserdataScope
    written: Use
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
        reported.add((lost.keeper.path, lost.written.outer))
        yield lost
    left = MOST_STEPS
    for scope in flow.scopes.values():
        outer = around(flow, scope.path)
        if outer is None or scope.path not in flow.entered or scope.container.sugar:
            continue
        inner: tuple[_InnerWrite, ...] = fact_of(_inner_writes, scope.path, scope)
        for written, is_named in inner:
            own, writer = written.outer, written.node
            if left <= 0 or (scope.path, own) in reported:
                continue
            levels = [
                level
                for level in _levels(flow, scope, own, writer)
                if level.key in fact_of(_read, level.scope.path, level.scope)
            ]
            left -= sum(len(level.scope.steps) + len(level.scope.reads) for level in levels)
            if not is_named and levels:
                left -= len(scope.steps) + len(scope.reads)
                if not _is_for_outside(scope, writer, own):
                    continue
            whole = not _is_leaf(writer)
            for level, vertex in chain(_after(levels), _again(scope, own, writer, levels)):
                if whole and not _is_leaf(level.scope.children[str(vertex)]):
                    continue  # a container can count on its own
                reader = reader_at(level.scope, vertex, level.key)
                reported.add((scope.path, own))
                yield Lost(scope, written, reader, level.key, False)
                break


class _InnerWrite(NamedTuple):
    """A key that a state of a container writes and that is no output of the container. `is_named`:
    the script lists or renames it; if not, it is an input of the container, or the state is one,
    and only the interface of the state type lists it."""

    written: Use
    is_named: bool


def _is_for_outside(scope: UserdataScope, writer: Node, own: str) -> bool:
    """Whether no state in a container needs a key that is set there, but for changing it."""
    return _is_dead(scope, writer, own) or _accumulates(scope, writer, own)


def _accumulates(scope: UserdataScope, writer: Node, own: str) -> bool:
    """Whether a loop changes a key from item to item, and has no other state that reads it."""
    is_loop = isinstance(scope.container, nodes.Iterator) and not scope.container.sugar
    return is_loop and own in outer_inputs(writer)


class _Level(NamedTuple):
    """A container around the keeper of a key: the place of the keeper in it, and the name that the
    key has there."""

    scope: UserdataScope
    place: str
    key: str


def _after(levels: Iterable[_Level]) -> Iterator[tuple[_Level, Vertex]]:
    """The states that read the old value of a key after its keeper, innermost first."""
    for level in levels:
        vertex = _read_after(level.scope, level.place, level.key)
        if vertex is not None:
            yield level, vertex


def _levels(flow: DataFlow, scope: UserdataScope, own: str, writer: Node) -> Iterator[_Level]:
    """The containers around the keeper of a key in which a state can read what the keeper loses,
    innermost first.

    A container made for a field of a state passes every key on. Another one passes the key on as an
    output that nothing else in it sets; then the key must also be of no use inside the keeper, or
    be changed from item to item.
    """
    inner, key = scope, own
    for _ in range(MOST_LEVELS):
        path = around(flow, inner.path)
        if path is None:
            return
        outer = flow.scopes[path]
        place, key = place_in(path, inner.path), remapping(inner.container)[key]
        yield _Level(outer, place, key)
        if not outer.container.sugar:
            is_set = key in outer.uses.written
            if key not in outer.outputs or is_set or not _is_for_outside(scope, writer, own):
                return
        inner = outer


def _is_dead(scope: UserdataScope, writer: Node, own: str) -> bool:
    """Whether no state in the container reads a key after the writer has set it."""
    if isinstance(scope.container, Concurrence):
        return not any(own in keys for vertex, keys in scope.reads.items() if vertex != writer.name)
    return _read_after(scope, writer.name, own, again=True, written=True) is None


def _again(
    scope: UserdataScope, own: str, writer: Node, levels: Iterable[_Level]
) -> Iterator[tuple[_Level, Vertex]]:
    """The keeper of a key, where it runs again and takes in the old value of a key that it sets for
    no other purpose, or that it counts for a condition and that nothing around it sets."""
    dead = own in scope.inputs and _is_dead(scope, writer, own)
    if own not in scope.inputs or not (dead or _counts_once(scope, writer, own)):
        return
    for level in levels:
        writers = level.scope.uses.writers(level.key)
        if not dead and any(use.node.name != level.place for use in writers):
            return
        if _read_after(level.scope, level.place, level.key, again=True) == level.place:
            yield level, level.place
        if not level.scope.container.sugar:
            return


def _counts_once(scope: UserdataScope, writer: Node, own: str) -> bool:
    """Whether a state counts a key at most once in each run of its container, and a condition of
    the container reads the key: a count that begins again in each run has no other use."""
    if not isinstance(writer, Leaf) or not isinstance(scope.container, StateMachine | Sequence):
        return False
    written = scope.uses.writers(own)
    if not any(use.node is writer and _counts(writer, use.key) for use in written):
        return False
    readers = (str(vertex) for vertex, keys in scope.reads.items() if own in keys)
    decided = any(
        isinstance(leaf := scope.children.get(name), Leaf) and variable_of(leaf, "conditions")
        for name in readers
    )
    return decided and not _is_in_a_loop(scope, writer.name)


def _counts(leaf: Leaf, key: str) -> bool:
    """Whether a callback of a leaf adds to the old value of a key or subtracts from it."""
    code = (functions(leaf, "callbacks") or {}).get(key)
    found = script_code(code.text).function if code is not None else None
    if found is None or not isinstance(found[0], ast.BinOp):
        return False
    if not isinstance(found[0].op, ast.Add | ast.Sub):
        return False
    left, right = found[0].left, found[0].right
    for old, step in ((left, right), (right, left)):
        fields = (
            fields_of(old, found[1]) if isinstance(old, ast.Attribute | ast.Subscript) else None
        )
        if fields is not None and fields.read == (key,):
            return isinstance(step, ast.Constant | ast.List)
    return False


def _is_in_a_loop(scope: UserdataScope, start: str) -> bool:
    """Whether a way leads from a vertex of a container back to it."""
    todo: list[Vertex] = [start]
    seen: set[Vertex] = set()
    for vertex in todo:
        for step in scope.steps.get(vertex, ()):
            if step.target not in seen:
                seen.add(step.target)
                todo.append(step.target)
    return start in seen


def _missed(flow: DataFlow, missing: Missing) -> Lost:
    keeper = flow.scopes[missing.other]
    written, own = next(
        (use, use.outer)
        for use in keeper.uses.all
        if use.writes
        and use.outer not in keeper.outputs
        and _name_at(flow, keeper, use.outer, missing) == missing.key
    )
    reader = reader_at(missing.scope, missing.vertices[0], missing.key)
    return Lost(keeper, written, reader, missing.key, True, _misspelt(keeper, own))


def _misspelt(keeper: UserdataScope, own: str) -> Key | None:
    """The output key of a container that no state in it sets and whose name is near to a key."""
    set_ = keeper.uses.written | keeper.uses.given
    unset = {key.name: key for key in keeper.container.outputs if key.name not in set_}
    return unset.get(guesser(unset)(own) or "")


def _name_at(flow: DataFlow, scope: UserdataScope, own: str, missing: Missing) -> str:
    """What a key would be called in the container where it is missing."""
    path: str | None = scope.path
    while path is not None and path != missing.scope.path:
        own = remapping(flow.scopes[path].container)[own]
        path = around(flow, path)
    return own


def _read(scope: UserdataScope) -> frozenset[str]:
    """The keys that something in a container reads."""
    return frozenset(chain(*scope.reads.values()))


def _inner_writes(scope: UserdataScope) -> tuple[_InnerWrite, ...]:
    """The keys that states of a container write and that are no outputs of it. A key that is also
    read in the container counts only if it is an input, because then it has one name outside."""
    read = {use.outer for use in scope.uses.all if use.reads and use.node is not scope.container}
    found: list[_InnerWrite] = []
    for use in scope.uses.all:
        own, child, key = use.outer, use.node, use.declared
        if not use.writes or own in scope.outputs or (own in read and own not in scope.inputs):
            continue
        if not _is_leaf(child):
            if _is_set_in(child, use.key):
                found.append(_InnerWrite(use, False))
            continue
        is_named = key is not None and key.span.source is child.span.source
        if not is_named and all(input_.name != use.key for input_ in child.inputs):
            is_named = any(remap.key == use.key for remap in child.remaps)
        if is_named or own in scope.inputs:
            found.append(_InnerWrite(use, is_named))
    return tuple(found)


def _is_set_in(node: Node, key: str) -> bool:
    """Whether a leaf in a node has an output that becomes an output of the node."""
    if isinstance(node, Leaf):
        return any(output.name == key for output in node.outputs)
    return any(
        outer == key and _is_set_in(child, output.name)
        for child in node.children
        for output, outer in zip(child.outputs, outer_outputs(child), strict=True)
    )


def _is_leaf(node: Node) -> bool:
    """Whether a node is a leaf in the script: it can have containers made of sugar around it."""
    while not isinstance(node, Leaf) and (inside := sugared_child(node)) is not None:
        node = inside
    return isinstance(node, Leaf)


def _read_after(
    scope: UserdataScope, start: str, key: str, *, again: bool = False, written: bool = False
) -> Vertex | None:
    """A vertex that reads a key after another one and before anything else writes it. `again`: this
    can be the first one itself. `written`: the first one writes the key."""
    # By hand: networkx needs a graph for each key and takes 3.7 ms instead of 0.9 ms for 1,000
    # states and 40 ms instead of 10 ms for 10,000, that is 2 % of a check with one fault, 22 % with
    # ten; its import adds 128 ms to a check of 10 states, which takes 226 ms (bench/searches.py).
    todo: list[Vertex] = [start]
    seen: set[Vertex] = set() if again else {start}
    for vertex in todo:
        for step in scope.steps.get(vertex, ()):
            is_own = written and vertex == start
            if step.target in seen or (key in step.writes.trusted and not is_own):
                continue
            if step.writes.anything:
                continue
            if key in scope.reads.get(step.target, ()):
                return step.target
            seen.add(step.target)
            todo.append(step.target)
    return None
