"""Hypothesis strategy for machines that pass userdata, and all their runs by brute force.

The leaves are ScriptedStates: they set the keys of their steps and do not fail when a key is
missing, so that every run continues.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator as Iter
from dataclasses import replace
from typing import Any, Literal

from hypothesis import strategies as st

from smachac.analysis.accesses import leaf_writes
from smachac.diagnostics.source import NOWHERE
from smachac.ir.graph import Edge, edges
from smachac.ir.nodes import (
    Concurrence,
    Condition,
    Container,
    Iterator,
    Key,
    Leaf,
    Machine,
    Node,
    Outcome,
    OutcomeRule,
    Preset,
    Remap,
    Sequence,
    StateMachine,
    Struct,
    Transition,
    Value,
    Variable,
)
from smachac.ir.traversal import containers, outcome_names, remapping
from tests.support.typed_machines import as_built_in

NAMES = ("a", "b", "c")
OUTCOMES = ("done", "failed", "preempted")
"""A state that is asked to stop may end with the last one at any visit."""

_keys = st.lists(st.sampled_from(NAMES), max_size=2, unique=True)
_remaps = st.dictionaries(st.sampled_from(NAMES), st.sampled_from(NAMES), max_size=2)
_exits = st.lists(st.sampled_from(OUTCOMES), min_size=1, max_size=2, unique=True)
_sets = st.lists(st.sampled_from(NAMES), max_size=3, unique=True)
_few = st.integers(1, 3)
_flag = st.booleans()
_JOINS: st.SearchStrategy[Literal["all", "any", "rule"]] = st.sampled_from(["all", "any", "rule"])


def value(data: Any) -> Value:
    return Value(data=data, span=NOWHERE)


class _Building:
    def __init__(self, draw: st.DrawFn, *, linear: bool) -> None:
        self.draw = draw
        self.kinds = 4 if linear else 5
        self.made = 0

    def common(self) -> dict[str, Any]:
        self.made += 1
        return {
            "name": f"S{self.made}",
            "outcomes": tuple(Outcome(name=n, span=NOWHERE) for n in self.draw(_exits)),
            "inputs": tuple(Key(name=n, span=NOWHERE) for n in self.draw(_keys)),
            "outputs": tuple(Key(name=n, span=NOWHERE) for n in self.draw(_keys)),
            "remaps": tuple(
                Remap(key=key, to=to, span=NOWHERE) for key, to in self.draw(_remaps).items()
            ),
            "span": NOWHERE,
        }

    def node(self, depth: int) -> Node:
        kind = self.draw(st.integers(0, self.kinds)) if depth else 0
        if kind < 2:
            return self.leaf()
        return self.container(depth, kind)

    def leaf(self) -> Leaf:
        common = self.common()
        names = [outcome.name for outcome in common["outcomes"]]
        steps = []
        for name in [*self.draw(st.lists(st.sampled_from(names), max_size=2)), *names]:
            sets = tuple((key, 1) for key in self.draw(_sets))
            steps.append(Struct(entries=(("outcome", name), ("set", Struct(entries=sets)))))
        told = Variable(name="steps", value=value(tuple(steps)), span=NOWHERE)
        return as_built_in(Leaf(type="ScriptedState", variables=(told,), **common))

    def container(self, depth: int, kind: int) -> Container:
        common = self.common()
        presets = self.draw(st.lists(st.sampled_from(NAMES), max_size=1))
        common["userdata"] = tuple(Preset(key=key, value=value(0), span=NOWHERE) for key in presets)
        count = 1 if kind == 3 else self.draw(_few)
        children = [self.node(depth - 1) for _ in range(count)]
        if kind == 3:
            return self.iterator(common, children[0])
        if kind == 5:
            return self.concurrence(common, children)
        exits = [outcome.name for outcome in common["outcomes"]]
        targets = st.sampled_from([*(child.name for child in children), *exits])
        linked = tuple(
            replace(
                child,
                transitions=tuple(
                    Transition(outcome=name, target=self.draw(targets), span=NOWHERE)
                    for name in outcome_names(child)
                ),
            )
            for child in children
        )
        if kind == 4:
            return Sequence(type="Sequence", children=linked, initial=linked[0].name, **common)
        return StateMachine(type="StateMachine", children=linked, initial=linked[0].name, **common)

    def iterator(self, common: dict[str, Any], child: Node) -> Iterator:
        loops = tuple(name for name in outcome_names(child) if self.draw(_flag))
        items = tuple(range(self.draw(st.integers(0, 2))))
        own = {*(name for name in outcome_names(child) if name not in loops), "exhausted"}
        common["outcomes"] = tuple(Outcome(name=name, span=NOWHERE) for name in sorted(own))
        if isinstance(child, Leaf):
            child = replace(child, remaps=())
        return Iterator(
            type="Iterator",
            children=(child,),
            items=value(items),
            item_key=self.draw(st.sampled_from(NAMES)),
            loop_outcomes=loops,
            **common,
        )

    def concurrence(self, common: dict[str, Any], children: list[Node]) -> Concurrence:
        exits = [outcome.name for outcome in common["outcomes"]]
        rules = []
        for outcome in exits:
            when = tuple(
                Condition(
                    child=child.name,
                    outcome=self.draw(st.sampled_from(outcome_names(child))),
                    span=NOWHERE,
                )
                for child in children
                if self.draw(_flag)
            )
            rules.append(OutcomeRule(outcome=outcome, when=when, span=NOWHERE))
        return Concurrence(
            type="Concurrence",
            children=tuple(children),
            default_outcome=exits[0],
            rules=tuple(rules),
            join=self.draw(_JOINS),
            **common,
        )


@st.composite
def data_machines(draw: st.DrawFn, linear: bool = False) -> Machine:
    """A machine three levels deep with userdata under a few names; `linear`: no concurrences."""
    building = _Building(draw, linear=linear)
    root = building.container(3, 2)
    assert isinstance(root, StateMachine)
    return Machine(root=replace(root, inputs=(), remaps=(), name="sm"))


Slots = frozenset[tuple[str, str]]
"""The keys that are set, with the path of their container."""


class Brute:
    """Everything that can happen in a machine without concurrences, by going through all of it.

    A leaf may have any of its outcomes, and set what it perhaps sets or only what it surely does.
    `entries` are, for each path, the keys that are set each time it is entered.
    """

    def __init__(self, machine: Machine) -> None:
        self.entries: dict[str, set[Slots]] = {}
        self._known: dict[tuple[str, Slots], set[tuple[str, Slots]]] = {}
        root = machine.root
        held = {(path, preset.key) for path, node in containers(root) for preset in node.userdata}
        self._inside(root, "sm", frozenset(held))

    def _enter(self, node: Node, path: str, raw: bool, slots: Slots) -> set[tuple[str, Slots]]:
        self.entries.setdefault(path, set()).add(slots)
        if (path, slots) not in self._known:
            around = path.rpartition("/")[0]
            self._known[path, slots] = (
                self._leaf(node, around, raw, slots)
                if isinstance(node, Leaf)
                else self._container(node, path, around, slots)
            )
        return self._known[path, slots]

    def _leaf(self, leaf: Leaf, around: str, raw: bool, slots: Slots) -> set[tuple[str, Slots]]:
        names = remapping(leaf)
        found = set()
        for outcome in outcome_names(leaf):
            writes = leaf_writes(leaf, outcome, raw=raw)
            maybe = sorted(writes.perhaps - writes.sure)
            for some in itertools.product([False, True], repeat=len(maybe)):
                keys = writes.sure.union(itertools.compress(maybe, some))
                found.add((outcome, slots | {(around, names.get(key, key)) for key in keys}))
        return found

    def _container(
        self, node: Container, path: str, around: str, slots: Slots
    ) -> set[tuple[str, Slots]]:
        names = remapping(node)
        taken = {
            (path, key.name)
            for key in node.inputs
            if (around, names.get(key.name, key.name)) in slots
        }
        found = set()
        for outcome, after in self._inside(node, path, slots | taken):
            handed = {
                (around, names.get(key.name, key.name))
                for key in node.outputs
                if (path, key.name) in after
            }
            found.add((outcome, after | handed))
        return found

    def _inside(self, node: Container, path: str, slots: Slots) -> set[tuple[str, Slots]]:
        children = {child.name: child for child in node.children}
        following: dict[tuple[str, str], list[Edge]] = {}
        for edge in edges(node):
            source = edge.source if isinstance(edge.source, str) else ""
            following.setdefault((source, edge.outcome), []).append(edge)
        ends: set[tuple[str, Slots]] = set()
        todo = [(edge, slots) for edge in following.get(("", ""), [])]
        seen = set(todo)
        while todo:
            edge, now = todo.pop()
            if isinstance(edge.target, tuple):
                ends.add((edge.target[1], now))
                continue
            if isinstance(node, Iterator):
                now |= {(path, node.item_key)}
            child = children[edge.target]
            raw = isinstance(node, Iterator)
            for outcome, after in self._enter(child, f"{path}/{child.name}", raw, now):
                for step in following.get((child.name, outcome), []):
                    if (step, after) not in seen:
                        seen.add((step, after))
                        todo.append((step, after))
        return ends


def keys_of(machine: Machine) -> Iter[tuple[str, str, str]]:
    """Each state with each key its container may have: path of the state, of the container, key."""
    for path, container in containers(machine.root):
        for child in container.children:
            for key in NAMES:
                yield f"{path}/{child.name}", path, key
