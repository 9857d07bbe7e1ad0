"""Equivalence of machines: equal up to the text they come from, or up to the renaming of one
name."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from smachac.ir import nodes
from smachac.ir.nodes import Data, Expression, Leaf, Machine, Node, Struct, Transition
from smachac.ir.traversal import leads_to_child, outcome_names, remapping
from smachac.records import dataclass, field, replace

NodeMap = Callable[[Node], Node]
"""A function from nodes to nodes."""


def same_machine(one: Machine, other: Machine) -> bool:
    """Whether two machines are equal except for the text they come from."""
    return (
        normalized(one.root) == normalized(other.root)
        and one.base == other.base
        and one.variables == other.variables
    )


def normalized(node: Node) -> Node:
    """A node in normal form: sorted transitions and remaps, without their origin in the script."""
    remaps = {remap.key: remap for remap in node.remaps if remap.key != remap.to}
    node = replace(node, remaps=tuple(remaps[key] for key in sorted(remaps)))
    if isinstance(node, Leaf):
        return node
    names = frozenset(child.name for child in node.children)
    children = tuple(_normalized_transitions(normalized(child), names) for child in node.children)
    return replace(node, children=children)


def _normalized_transitions(child: Node, names: frozenset[str]) -> Node:
    steps = {step.outcome: step for step in reversed(child.transitions)}
    led = (_normalized_transition(steps[outcome], names) for outcome in sorted(steps))
    return replace(child, transitions=tuple(led))


def _normalized_transition(step: Transition, names: frozenset[str]) -> Transition:
    inside = leads_to_child(step, names)
    return replace(step, origin="written" if inside else "implicit")


def map_nodes(node: Node, change: NodeMap) -> Node:
    """Apply a function to a node and all nodes below it, inner ones first."""
    if not isinstance(node, Leaf):
        children = tuple([map_nodes(child, change) for child in node.children])
        node = replace(node, children=children)
    return change(node)


@dataclass(slots=True)
class MachineShape:
    """A machine in three parts: its structure without names, all names, and all code.

    The order of the names does not depend on the names themselves.
    """

    structure: list[Any] = field(default_factory=list)
    names: list[str] = field(default_factory=list)
    code: list[str] = field(default_factory=list)


def equal_after_rename(before: Machine, after: Machine, old: str, new: str) -> bool:
    """Whether two machines are equal if one name is `new` instead of `old`."""
    one, other = shape_of(before), shape_of(after)
    word = re.compile(rf"\b{re.escape(old)}\b")
    return (
        one.structure == other.structure
        and len(one.names) == len(other.names)
        and all(a == b or (a, b) == (old, new) for a, b in zip(one.names, other.names, strict=True))
        and all(
            a == b or word.sub(new, a) == word.sub(new, b)
            for a, b in zip(one.code, other.code, strict=True)
        )
    )


def shape_of(machine: Machine) -> MachineShape:
    """The shape of a machine."""
    found = MachineShape()
    found.structure.append(machine.base)
    found.names.append(machine.root.name)
    for variable in machine.variables:
        found.structure.append(variable.name)
        _data(variable.value.data, found)
    _node(machine.root, {}, found)
    return found


class _Numbers(dict[str, int]):
    """Names, numbered in the order of their first use."""

    def __missing__(self, name: str) -> int:
        self[name] = len(self)
        return self[name]


def _node(node: Node, around: dict[str, int], found: MachineShape) -> None:
    """Add a node to a shape. Its keys are numbered in the container around it, `around`."""
    outer = remapping(node)
    inner = _Numbers()
    own = _positions(outcome_names(node))
    found.names += outcome_names(node)
    found.structure.append((type(node).__name__, node.type, node.doc, len(own), node.claims))
    for keys in (node.inputs, node.outputs):
        found.names += [key.name for key in keys]
        linked = [(str(key.type), inner[key.name], around[outer[key.name]]
                   if around is not inner and isinstance(around, _Numbers) else -1)
                  for key in keys]  # fmt: skip
        found.structure.append(linked)
    if isinstance(node, Leaf):
        found.structure.append((node.open, node.blocking))
        for variable in node.variables:
            found.structure.append((variable.name, str(variable.type)))
            _data(variable.value.data, found)
        for outcome, written in node.writes:
            found.structure.append((_position(outcome, own), [inner[key] for key in written]))
        return
    _container(node, inner, own, found)


def _container(
    node: nodes.Container, inner: _Numbers, own: Mapping[str, int], found: MachineShape
) -> None:
    """Add the parts that only containers have, and their children."""
    for preset in node.userdata:
        found.structure.append((inner[preset.key], str(preset.type)))
        found.names.append(preset.key)
        _data(preset.value.data, found)
    names = _positions(child.name for child in node.children)
    found.names += [child.name for child in node.children]
    found.structure.append((node.sugar, len(node.children)))
    theirs = {child.name: _positions(outcome_names(child)) for child in reversed(node.children)}
    match node:
        case nodes.StateMachine():
            found.structure.append((_position(node.initial, names), node.forever))
        case nodes.Sequence():
            found.structure.append(_position(node.initial, names))
        case nodes.Concurrence():
            rules = [
                (
                    _position(rule.outcome, own),
                    [
                        (
                            _position(condition.child, names),
                            _position(condition.outcome, theirs.get(condition.child, {})),
                        )
                        for condition in rule.when
                    ],
                )
                for rule in node.rules
            ]
            found.structure.append((_position(node.default_outcome, own), rules, node.join))
        case nodes.Iterator():
            ends = theirs[node.children[0].name] if names else {}
            pairs = [(_position(a, ends), a == node.exhausted_outcome, _position(b, own))
                     for a, b in node.final_map]  # fmt: skip
            loops = [_position(name, ends) for name in node.loop_outcomes]
            keys = (inner[node.items_key] if node.items_key else -1, inner[node.item_key])
            found.structure.append((loops, pairs, keys, _position(node.exhausted_outcome, own)))
            if node.items is not None:
                _data(node.items.data, found)
        case _:  # of a kind without a case above, only an unchanged container is equal
            found.structure.append(node)
    inside = frozenset(names)
    for child in node.children:
        steps = []
        for step in child.transitions:
            to = _position(step.target, names if leads_to_child(step, inside) else own)
            leads = leads_to_child(step, inside)
            steps.append((_position(step.outcome, theirs[child.name]), leads, to))
        found.structure.append(sorted(steps))
        _node(child, inner, found)


def _position(name: str, names: Mapping[str, int]) -> int:
    """The position of a name, -1 if it is unknown."""
    return names.get(name, -1)


def _positions(names: Iterable[str]) -> dict[str, int]:
    """The first position of each name."""
    return {name: at for at, name in reversed(list(enumerate(names)))}


def _data(data: Data, found: MachineShape) -> None:
    """Add a value to a shape."""
    match data:
        case Expression(text=text):
            found.code.append(text)
            found.structure.append("code")
        case Struct(entries=entries):
            found.structure.append(("struct", len(entries)))
            for key, value in entries:
                found.names.append(key)
                _data(value, found)
        case tuple():
            found.structure.append(("list", len(data)))
            for value in data:
                _data(value, found)
        case str():
            found.names.append(data)
            found.structure.append("text")
        case _:
            found.structure.append((type(data).__name__, data))
