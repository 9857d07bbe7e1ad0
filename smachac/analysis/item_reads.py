"""Reads of the list of a loop that mean its item: `remapping: {pose: poses}` in an Iterator over
`poses`, where an item fits the reader and nothing reads the item under its own name."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from smachac.analysis.data_types import type_of_data
from smachac.analysis.type_inference import Clash
from smachac.analysis.type_lattice import is_unknown, item_of, misfit
from smachac.diagnostics.source import Span
from smachac.ir import nodes
from smachac.ir.nodes import Container, Leaf, Node
from smachac.ir.traversal import inputs_from, remapping


class ItemRead(NamedTuple):
    """A clash of the list `items` with a reader that needs an item.

    `node` at `path` is the state whose key `key` is remapped to the list, at `span`; `item` is the
    name of the item there. `lacking` are the containers that must declare it as an input.
    `declared` are the paths of those that do, each with its name for the item.
    """

    clash: Clash
    path: str
    node: Node
    key: str
    items: str
    item: str
    span: Span
    lacking: tuple[str, ...]
    declared: tuple[tuple[str, str], ...]


def item_reads(clashes: Iterable[Clash], containers: Mapping[str, Container]) -> Iterator[ItemRead]:
    """The clashes that are reads of the list in place of the item."""
    for clash in clashes:
        if clash.cell.role == "input" and isinstance(clash.cell.node, Leaf):
            found = _item_read(clash, clash.cell.node, containers)
            if found is not None:
                yield found


class _Level(NamedTuple):
    """A state on the way from a loop to a reader: its own key, and that of its container."""

    path: str
    node: Node
    key: str
    outer: str


def _item_read(clash: Clash, leaf: Leaf, containers: Mapping[str, Container]) -> ItemRead | None:
    levels: list[_Level] = []
    path, key = clash.cell.path, clash.cell.key
    node: Node = leaf
    while True:
        outer = remapping(node)[key]
        levels.insert(0, _Level(path, node, key, outer))
        path = path.rpartition("/")[0]
        around = containers.get(path)
        if around is None:
            return None
        if isinstance(around, nodes.Iterator):
            if around.items_key != outer or not around.item_key or not _fits_item(clash):
                return None
            return None if _reads(around, around.item_key) else _at(clash, around, levels)
        node, key = around, outer


def _fits_item(clash: Clash) -> bool:
    """Whether the items of a list fit the reader of the list."""
    value, wanted = clash.flow.value, clash.cell.declared
    if isinstance(value, tuple):
        return bool(value) and all(misfit(type_of_data(other), wanted) is None for other in value)
    item = item_of(clash.flow.type)
    return not is_unknown(item) and misfit(item, wanted) is None


def _reads(node: Container, name: str) -> bool:
    """Whether a state in a container can read a key of it."""
    for child in node.children:
        own = inputs_from(child, name)
        if not isinstance(child, Leaf):
            if any(_reads(child, key.name) for key in own):
                return True
            continue
        words = child.class_facts.reads if child.class_facts is not None else ()
        names = remapping(child)
        if child.open or own or any(names[word.text] == name for word in words):
            return True
    return False


def _at(clash: Clash, loop: nodes.Iterator, levels: list[_Level]) -> ItemRead | None:
    """The read at the outermost remapping on the way to the reader."""
    item = loop.item_key
    lacking: list[str] = []
    declared: list[tuple[str, str]] = []
    for path, node, key, _ in levels:
        found = next((remap for remap in node.remaps if remap.key == key), None)
        if found is not None:
            return ItemRead(
                clash, path, node, key, found.to, item, found.to_span, tuple(lacking),
                tuple(declared),
            )  # fmt: skip
        own = inputs_from(node, item)
        if own:
            item = own[0].name
            declared.append((path, item))
        elif not isinstance(node, Leaf):
            lacking.append(node.name)
    return None
