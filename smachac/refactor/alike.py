"""Machines in a form in which two that behave the same are equal."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from smachac.ir.nodes import Leaf, Machine, Node, Transition
from smachac.ir.walk import leads_to_child

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
