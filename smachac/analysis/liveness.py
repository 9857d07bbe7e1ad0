"""Liveness of userdata keys: values that every path overwrites before a state reads them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from smachac.analysis.definite_assignment import DataFlow, FactOf, UserdataScope
from smachac.analysis.fixpoint import KeyStep
from smachac.ir.graph import START, Vertex
from smachac.ir.nodes import Key, Leaf, Sequence, StateMachine
from smachac.ir.outcome_names import fails
from smachac.ir.traversal import outer_outputs

MOST_VISITS = 1_000_000
"""The most visits of states in one machine; beyond them nothing more is found."""


class DeadStore(NamedTuple):
    """A leaf of the container at `path` sets a key that no path reads before `again` sets it.

    `key` is the output of the leaf, `name` its name in the container.
    """

    path: str
    leaf: Leaf
    key: Key
    name: str
    again: tuple[str, ...]


_Back = Mapping[Vertex, list[tuple[Vertex, KeyStep]]]


def dead_stores(flow: DataFlow, fact_of: FactOf) -> Iterator[DeadStore]:
    """The dead stores in state machines and sequences, in the order of the script.

    The end of a container counts as a read. Only outputs that the script lists at the state count,
    because others come with the state type. A failure overwrites nothing: the value before it can
    be meant as a substitute.
    """
    visits = 0
    for scope in flow.scopes.values():
        container = scope.container
        if not isinstance(container, StateMachine | Sequence) or container.sugar:
            continue
        candidates = fact_of(_candidates, scope.path, scope)
        if not candidates:
            continue
        back = _steps_back(scope)
        for name, writers in candidates.items():
            visits += len(scope.children)
            if visits > MOST_VISITS:
                return
            live = _live(scope, back, name)
            for leaf, key in writers:
                stores = [s for s in scope.steps.get(leaf.name, ()) if name in s.writes.perhaps]
                if stores and not any(step.target in live for step in stores):
                    again = _overwriting(scope, leaf.name, name)
                    if again:
                        yield DeadStore(scope.path, leaf, key, name, again)


def _candidates(scope: UserdataScope) -> dict[str, list[tuple[Leaf, Key]]]:
    """The keys that several states of a container write, with the leaves that list them."""
    found: dict[str, list[tuple[Leaf, Key]]] = {}
    for child in scope.children.values():
        for key, name in zip(child.outputs, outer_outputs(child), strict=True):
            listed = key.span.source is child.span.source
            if isinstance(child, Leaf) and not child.open and listed and child.name in scope.steps:
                found.setdefault(name, []).append((child, key))
    return {name: leaves for name, leaves in found.items() if len(scope.uses.writers(name)) > 1}


def _steps_back(scope: UserdataScope) -> _Back:
    back: dict[Vertex, list[tuple[Vertex, KeyStep]]] = {}
    for vertex, steps in scope.steps.items():
        for step in steps:
            back.setdefault(step.target, []).append((vertex, step))
    return back


def _replaces(scope: UserdataScope, vertex: Vertex, step: KeyStep, name: str) -> bool:
    """Whether a step from a vertex surely sets a key."""
    if not isinstance(vertex, str) or name not in step.writes.trusted:
        return False
    return not fails(scope.children[vertex], step.outcome)


def _live(scope: UserdataScope, back: _Back, name: str) -> set[Vertex]:
    """The vertices at whose entry a key is live: some path reads it before it is set again."""
    live: set[Vertex] = {vertex for vertex in back if isinstance(vertex, tuple) and vertex != START}
    live.update(use.node.name for use in scope.uses.readers(name) if use.path != scope.path)
    for child in scope.children.values():
        if isinstance(child, Leaf) and child.open:
            live.add(child.name)
    todo = list(live)
    while todo:
        for before, step in back.get(todo.pop(), ()):
            if before not in live and not _replaces(scope, before, step, name):
                live.add(before)
                todo.append(before)
    return live


def _overwriting(scope: UserdataScope, start: str, name: str) -> tuple[str, ...]:
    """The states that set a key first after a state, nearest first."""
    found: dict[str, None] = {}
    seen: set[Vertex] = set()
    todo: list[Vertex] = [step.target for step in scope.steps.get(start, ())]
    for vertex in todo:
        if vertex in seen:
            continue
        seen.add(vertex)
        for step in scope.steps.get(vertex, ()):
            if _replaces(scope, vertex, step, name):
                found[str(vertex)] = None
            else:
                todo.append(step.target)
    return tuple(found)
