"""Keys shared by branches of a concurrence: their values depend on which branch is first."""

from __future__ import annotations

from collections import Counter

from smachac.ir.nodes import Concurrence, Leaf, Machine
from smachac.ir.secret_keys import secret_keys
from smachac.ir.traversal import containers, outer_inputs, outer_outputs, walk


def contended_keys(machine: Machine) -> dict[str, tuple[str, ...]]:
    """The concurrences, by path, with the keys that one branch writes and another reads or writes.

    A branch of an open state type may write any key; it is not counted.
    """
    found = {}
    for path, node in containers(machine.root):
        if isinstance(node, Concurrence):
            users: Counter[str] = Counter()
            written: set[str] = set()
            for child in node.children:
                reads, writes = {*outer_inputs(child)}, {*outer_outputs(child)}
                users.update(reads | writes)
                written |= writes
            if shared := tuple(sorted(key for key in written if users[key] > 1)):
                found[path] = shared
    return found


def deterministic_reads(machine: Machine) -> dict[str, tuple[str, ...]]:
    """The inputs of each leaf, by path, whose values do not depend on the order of branches.
    Secret ones are left out."""
    secret = secret_keys(machine)
    loose = tuple(f"{path}/" for path in contended_keys(machine))
    return {
        path: tuple(key.name for key in node.inputs if key.name not in secret.get(path, ()))
        for path, node in walk(machine.root)
        if isinstance(node, Leaf) and node.inputs and not path.startswith(loose)
    }
