"""Secret keys: keys of userdata whose values are written to no trace, picture, page or report."""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Iterator, Mapping, Set
from typing import TypeAlias

from smachac.ir.nodes import Iterator as IteratorNode
from smachac.ir.nodes import Machine, Node
from smachac.ir.traversal import containers, remapping, walk

SecretKeys: TypeAlias = Mapping[str, Set[str]]
"""The secret keys of each state, by the path of the state, under its own names of the keys."""

_Cell: TypeAlias = tuple[str, str]


def secret_keys(machine: Machine) -> SecretKeys:
    """The secret keys of each state of a machine; of a container, those of its userdata.

    A key is secret if an interface or the userdata of the script declares it (`secret: true`), or
    if a remapping makes it the same key as a secret one, inside or around the state. The items of a
    secret list are secret. A value that code computes from a secret one is not. Linear in the size
    of the machine.
    """
    todo = deque(_declared(machine.root))
    if not todo:
        return {}
    same = _same_keys(machine.root)
    found: defaultdict[str, set[str]] = defaultdict(set)
    while todo:
        path, key = todo.popleft()
        if key not in found[path]:
            found[path].add(key)
            todo.extend(same[path, key])
    for path, node in walk(machine.root):
        if isinstance(node, IteratorNode) and path in found:
            for child in node.children:  # it may write every key of the iterator
                found[f"{path}/{child.name}"] |= found[path]
    return dict(found)


def _declared(root: Node) -> Iterator[_Cell]:
    """The keys that are declared as secret."""
    yield from ((root.name, key) for key in _secret_names(root))
    for path, container in containers(root):
        for child in container.children:
            if child.inputs or child.outputs:
                yield from ((f"{path}/{child.name}", key) for key in _secret_names(child))
        yield from ((path, preset.key) for preset in container.userdata if preset.secret)


def _secret_names(node: Node) -> list[str]:
    """The input and output keys of a node that are declared as secret."""
    return [key.name for key in (*node.inputs, *node.outputs) if key.secret]


def _same_keys(root: Node) -> Mapping[_Cell, list[_Cell]]:
    """The keys that each key is remapped to and from, one container up and one down."""
    same: defaultdict[_Cell, list[_Cell]] = defaultdict(list)
    for path, node in walk(root):
        around = path.rpartition("/")[0]
        names = remapping(node)
        if around:
            for key in {input_.name for input_ in (*node.inputs, *node.outputs)}:
                inner, outer = (path, key), (around, names[key])
                same[inner].append(outer)
                same[outer].append(inner)
        if isinstance(node, IteratorNode) and node.items_key:
            same[path, node.items_key].append((path, node.item_key))
    return same
