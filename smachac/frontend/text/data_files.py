"""YAML files of plain data beside a script (robots, scenes, faults), with places of mistakes."""

from __future__ import annotations

from typing import Any

from smachac.diagnostics.source import Span
from smachac.frontend.text.yaml_tree import Map, Seq, Tree


def plain(tree: Tree) -> Any:
    """The data of a tree: dictionaries, lists and values. The first of duplicate keys counts, as in
    `span_at`."""
    if isinstance(tree, Map):
        found: dict[Any, Any] = {}
        for entry in tree.entries:
            if entry.key.value not in found:
                found[entry.key.value] = plain(entry.value)
        return found
    if isinstance(tree, Seq):
        return [plain(item) for item in tree.items]
    return tree.value


def span_at(tree: Tree, place: tuple[str | int, ...], *, key: bool = False) -> Span:
    """The span of the value at a place, or of the deepest value on the way to it.

    A place that ends with a key of a mapping whose value is a mapping or a list is that key, with
    `key` each key is.
    """
    span = tree.span
    for step in place:
        if isinstance(tree, Map):
            entry = next((entry for entry in tree.entries if str(entry.key.value) == step), None)
            if entry is None:
                return span
            tree = entry.value
            span = entry.key.span if key or isinstance(tree, Map | Seq) else tree.span
        elif isinstance(tree, Seq) and isinstance(step, int) and step < len(tree.items):
            tree = tree.items[step]
            span = tree.span
        else:
            return span
    return span
