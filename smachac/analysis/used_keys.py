"""The keys of a container that something in it can use."""

from __future__ import annotations

from smachac.analysis.definite_assignment import UserdataScope
from smachac.ir import nodes
from smachac.ir.nodes import Leaf


def sees_everything(scope: UserdataScope) -> bool:
    """Whether a state in a container can read any key."""
    raw = isinstance(scope.container, nodes.Iterator)
    for child in scope.container.children:
        if isinstance(child, Leaf):
            if raw or child.open:
                return True
        elif isinstance(child, nodes.Iterator) and not child.item_key:
            return True
    return False


def used_in(scope: UserdataScope) -> set[str]:
    """The keys that a state in a container declares as inputs, also where it has the value at a
    wrong place, that its class reads, or over which it iterates, and the outputs of the
    container."""
    found = {*scope.uses.read, *scope.outputs}
    for child in scope.container.children:
        if isinstance(child, Leaf):
            found.update(child.misplaced_keys)
            if child.class_facts is not None:
                found.update(word.text for word in child.class_facts.reads)
    return found
