"""Machines in a form in which two that behave the same are equal."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from smachac.ir import nodes
from smachac.ir.nodes import Data, Expression, Leaf, Machine, Node, Struct, Transition
from smachac.ir.traversal import leads_to_child, outcome_names, remapping

Change = Callable[[Node], Node]


def same_machine(one: Machine, other: Machine) -> bool:
    """Whether two machines are the same but for the text they come from."""
    return (
        normal(one.root) == normal(other.root)
        and one.base == other.base
        and one.variables == other.variables
    )


def normal(node: Node) -> Node:
    """A node in which it does not show who wrote an edge, or in which order: a script, or the
    language for it."""
    remaps = {remap.key: remap for remap in node.remaps if remap.key != remap.to}
    node = replace(node, remaps=tuple(remaps[key] for key in sorted(remaps)))
    if isinstance(node, Leaf):
        return node
    names = frozenset(child.name for child in node.children)
    children = tuple(_led(normal(child), names) for child in node.children)
    return replace(node, children=children)


def _led(child: Node, names: frozenset[str]) -> Node:
    steps = {step.outcome: step for step in reversed(child.transitions)}
    led = (_step(steps[outcome], names) for outcome in sorted(steps))
    return replace(child, transitions=tuple(led))


def _step(step: Transition, names: frozenset[str]) -> Transition:
    inside = leads_to_child(step, names)
    return replace(step, origin="written" if inside else "implicit")


def rebuilt(node: Node, change: Change) -> Node:
    """A node with every node of it changed, from the inside to the outside."""
    if not isinstance(node, Leaf):
        children = tuple([rebuilt(child, change) for child in node.children])
        node = replace(node, children=children)
    return change(node)


@dataclass(slots=True)
class Skeleton:
    """`bones` hold no names, `names` all there are, in an order that names do not change."""

    bones: list[Any] = field(default_factory=list)
    names: list[str] = field(default_factory=list)
    code: list[str] = field(default_factory=list)


def renamed_alike(before: Machine, after: Machine, old: str, new: str) -> bool:
    """Whether a machine is another one in which something is called `new` instead of `old`."""
    one, other = skeleton(before), skeleton(after)
    word = re.compile(rf"\b{re.escape(old)}\b")
    return (
        one.bones == other.bones
        and len(one.names) == len(other.names)
        and all(a == b or (a, b) == (old, new) for a, b in zip(one.names, other.names, strict=True))
        and all(
            a == b or word.sub(new, a) == word.sub(new, b)
            for a, b in zip(one.code, other.code, strict=True)
        )
    )


def skeleton(machine: Machine) -> Skeleton:
    found = Skeleton()
    found.bones.append(machine.base)
    found.names.append(machine.root.name)
    for variable in machine.variables:
        found.bones.append(variable.name)
        _data(variable.value.data, found)
    _node(machine.root, {}, found)
    return found


class _Numbers(dict[str, int]):
    """Names by the order in which they are first met."""

    def __missing__(self, name: str) -> int:
        self[name] = len(self)
        return self[name]


def _node(node: Node, around: dict[str, int], found: Skeleton) -> None:
    """The bones of a node, whose keys are numbered in the container `around`."""
    outer = remapping(node)
    inner = _Numbers()
    own = _numbered(outcome_names(node))
    found.names += outcome_names(node)
    found.bones.append((type(node).__name__, node.type, node.doc, len(own), node.claims))
    for keys in (node.inputs, node.outputs):
        found.names += [key.name for key in keys]
        linked = [(str(key.type), inner[key.name], around[outer.get(key.name, key.name)]
                   if around is not inner and isinstance(around, _Numbers) else -1)
                  for key in keys]  # fmt: skip
        found.bones.append(linked)
    if isinstance(node, Leaf):
        found.bones.append((node.open, node.blocking))
        for variable in node.variables:
            found.bones.append((variable.name, str(variable.type)))
            _data(variable.value.data, found)
        for outcome, written in node.writes:
            found.bones.append((_at(outcome, own), [inner[key] for key in written]))
        return
    _container(node, inner, own, found)


def _container(
    node: nodes.Container, inner: _Numbers, own: Mapping[str, int], found: Skeleton
) -> None:
    for preset in node.userdata:
        found.bones.append((inner[preset.key], str(preset.type)))
        found.names.append(preset.key)
        _data(preset.value.data, found)
    names = _numbered(child.name for child in node.children)
    found.names += [child.name for child in node.children]
    found.bones.append((node.sugar, len(node.children)))
    theirs = {child.name: _numbered(outcome_names(child)) for child in reversed(node.children)}
    match node:
        case nodes.StateMachine():
            found.bones.append((_at(node.initial, names), node.forever))
        case nodes.Sequence():
            found.bones.append(_at(node.initial, names))
        case nodes.Concurrence():
            rules = [
                (_at(rule.outcome, own), [(_at(each.child, names),
                                           _at(each.outcome, theirs.get(each.child, {})))
                                          for each in rule.when])
                for rule in node.rules
            ]  # fmt: skip
            found.bones.append((_at(node.default_outcome, own), rules, node.join))
        case nodes.Iterator():
            ends = theirs[node.children[0].name] if names else {}
            pairs = [(_at(a, ends), a == node.exhausted_outcome, _at(b, own))
                     for a, b in node.final_map]  # fmt: skip
            loops = [_at(name, ends) for name in node.loop_outcomes]
            keys = (inner[node.items_key] if node.items_key else -1, inner[node.item_key])
            found.bones.append((loops, pairs, keys, _at(node.exhausted_outcome, own)))
            if node.items is not None:
                _data(node.items.data, found)
    inside = frozenset(names)
    for child in node.children:
        steps = []
        for step in child.transitions:
            to = _at(step.target, names if leads_to_child(step, inside) else own)
            leads = leads_to_child(step, inside)
            steps.append((_at(step.outcome, theirs[child.name]), leads, to))
        found.bones.append(sorted(steps))
        _node(child, inner, found)


def _at(name: str, names: Mapping[str, int]) -> int:
    return names.get(name, -1)


def _numbered(names: Iterable[str]) -> dict[str, int]:
    """The first place of each name."""
    return {name: at for at, name in reversed(list(enumerate(names)))}


def _data(data: Data, found: Skeleton) -> None:
    match data:
        case Expression(text=text):
            found.code.append(text)
            found.bones.append("code")
        case Struct(entries=entries):
            found.bones.append(("struct", len(entries)))
            for key, value in entries:
                found.names.append(key)
                _data(value, found)
        case tuple():
            found.bones.append(("list", len(data)))
            for value in data:
                _data(value, found)
        case str():
            found.names.append(data)
            found.bones.append("text")
        case _:
            found.bones.append((type(data).__name__, data))
