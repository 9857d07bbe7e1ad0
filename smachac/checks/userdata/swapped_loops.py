"""Loops whose list and item have changed places."""

from __future__ import annotations

from itertools import chain

from smachac.analysis.unset_reads import Missing
from smachac.ir import nodes
from smachac.ir.graph import START
from smachac.ir.traversal import OuterNames, remapping


def swapped_loop(missing: Missing) -> nodes.Iterator | None:
    """The loop over a key that nothing sets, where it calls its item as a key that is set, and a
    state in it reads the item under the name of that key: both have changed places."""
    scope = missing.scope
    if missing.cause not in ("nowhere", "remapped"):
        return None
    for vertex in missing.vertices:
        node = scope.container if vertex == START else scope.children.get(str(vertex))
        if not isinstance(node, nodes.Iterator) or not node.item_key:
            continue
        if (remapping(node) if vertex != START else OuterNames())[node.items_key] != missing.key:
            continue
        read = {key.name for child in node.children for key in child.inputs}
        if missing.key not in read or node.item_key in read:
            continue
        if node.item_key in scope.held or node.item_key in scope.inputs:
            return node
        steps = chain.from_iterable(scope.steps.values() if vertex != START else ())
        if any(node.item_key in step.writes.perhaps for step in steps):
            return node
    return None
