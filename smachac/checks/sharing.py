"""What states share: which keys of the userdata around it each reads and writes, and what in it
does so. What a leaf does to its own keys is ir/accesses.py's."""

from __future__ import annotations

from typing import NamedTuple

from smachac.checks.once import states
from smachac.ir import nodes
from smachac.ir.nodes import Leaf, Machine, Node
from smachac.ir.userdata import remapping

Keys = dict[str, Node]
"""Keys, under the names they have around the state, with the leaf or container that is behind it:
the innermost whose access it is."""


class Accesses(NamedTuple):
    """What a state may read and may write of the userdata around it."""

    reads: Keys
    writes: Keys


def accesses(machine: Machine) -> dict[int, Accesses]:
    """The accesses of every state, by `id`.

    A leaf may read and write the keys it declares, at any time. A container copies its inputs when
    it starts, and its outputs when it ends (smach-semantics V1, V4); it counts as reading what
    something in it reads, and as writing what it hands on or something in it has put there.
    """
    found: dict[int, Accesses] = {}
    for _, node in reversed(states(machine)):
        found[id(node)] = around(node, inside(node, found))
    return found


def inside(node: Node, known: dict[int, Accesses]) -> Accesses:
    """What is read and written of a state's own userdata by what is in it."""
    if isinstance(node, Leaf):
        return Accesses(
            {key.name: node for key in node.inputs}, {key.name: node for key in node.outputs}
        )
    reads: Keys = {}
    writes: Keys = {}
    for child in node.children:
        for key, origin in known[id(child)].reads.items():
            reads.setdefault(key, origin)
        for key, origin in known[id(child)].writes.items():
            writes.setdefault(key, origin)
    if isinstance(node, nodes.Iterator):
        writes.setdefault(node.item_key, node)
        if node.items_key:
            reads.setdefault(node.items_key, node)
    return Accesses(reads, writes)


def around(node: Node, own: Accesses) -> Accesses:
    """The accesses to its own userdata as far as they go to the userdata around it."""
    if isinstance(node, Leaf):
        return Accesses(_renamed(node, own.reads), _renamed(node, own.writes))
    inputs = {key.name for key in node.inputs}
    held = {*inputs, *(preset.key for preset in node.userdata)}
    outputs = [key.name for key in node.outputs]
    reads = {key.name: own.reads[key.name] for key in node.inputs if key.name in own.reads}
    written = (key for key in outputs if key in own.writes or key in held)
    writes = {key: own.writes.get(key, node) for key in written}
    return Accesses(_renamed(node, reads), _renamed(node, writes))


def _renamed(node: Node, keys: Keys) -> Keys:
    names = remapping(node)
    found: Keys = {}
    for key, origin in keys.items():
        found.setdefault(names.get(key, key), origin)
    return found
