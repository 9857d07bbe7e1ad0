"""Entries of a remapping whose keys of the container have changed places."""

from __future__ import annotations

from collections.abc import Iterable

from smachac.analysis.unset_reads import Missing
from smachac.diagnostics.spelling import words_of
from smachac.ir.nodes import Node, Remap
from smachac.ir.traversal import remapping


def swapped_remap(missing: Missing, child: Node, remap: Remap) -> Remap | None:
    """The entry of an output of a state that has changed its place with `remap`, the entry of an
    input, to a key that nothing sets: the container sets the key of the other entry without this
    state, and another state reads the missing key, or the names belong to each other."""
    scope = missing.scope
    outputs = {key.name for key in child.outputs}
    if remap.key in outputs:
        return None
    set_ = {*scope.held, *scope.inputs}
    read = {*scope.outputs}
    for each in scope.container.children:
        if each is not child:
            names = remapping(each)
            set_ |= {names.get(key.name, key.name) for key in each.outputs}
            read |= {names.get(key.name, key.name) for key in each.inputs}
    found = [
        each
        for each in child.remaps
        if each.key in outputs and each.to in set_
        if missing.key in read or _belong_crosswise(remap, each)
    ]
    return found[0] if len(found) == 1 else None


def _belong_crosswise(one: Remap, other: Remap) -> bool:
    first, second = words_of(one.key), words_of(other.key)
    return bool(first & words_of(other.to) and second & words_of(one.to))


def keys_of_swapped(missing: Iterable[Missing]) -> set[tuple[str, str]]:
    """The keys of the other entries of swapped ones, each with the path of its container."""
    return {
        (each.scope.path, other.to)
        for each in missing
        for child in each.scope.container.children
        for remap in child.remaps
        if remap.to == each.key and (other := swapped_remap(each, child, remap)) is not None
    }
