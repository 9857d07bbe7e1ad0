"""Remappings that were copied from another state and not changed: a key that nothing reads (SM305,
SM306), although a state of its name reads the key of another state."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from smachac.checks.messages import calls, other_place
from smachac.diagnostics.diagnostic import Finding
from smachac.diagnostics.spelling import words_of
from smachac.ir.nodes import Container, Leaf, Node, Remap


class CopiedRemap(NamedTuple):
    """A remapping that two states have, the state that is meant to read another key, and the
    other state."""

    child: Node
    remap: Remap
    other: Node


def copied_remap(container: Container, key: str) -> CopiedRemap | None:
    """The remapping in a container that probably should name a key which nothing reads: two states
    read the same key, and only one of them has a word of the unread key in its name or variables.
    """
    groups: dict[tuple[str, str], list[tuple[Node, Remap]]] = {}
    for child in container.children:
        own = {each.name for each in child.inputs} if child.remaps else set()
        for remap in child.remaps:
            if remap.key in own and remap.to != key:
                groups.setdefault((remap.key, remap.to), []).append((child, remap))
    found = []
    for (_, to), alike in groups.items():
        wanted = words_of(key) - words_of(to)
        named = [(child, remap) for child, remap in alike if wanted & words_of(*_names(child))]
        if len(alike) < 2 or len(named) != 1:
            continue
        child, remap = named[0]
        other = next(each for each, _ in alike if each is not child)
        if words_of(key) & words_of(to) or words_of(to) & words_of(*_names(other)):
            found.append(CopiedRemap(child, remap, other))
    return found[0] if len(found) == 1 else None


def _names(node: Node) -> Iterable[str]:
    """The name of a state and the texts of its variables."""
    yield node.name
    for held in node.variables if isinstance(node, Leaf) else ():
        if isinstance(held.value.data, str):
            yield held.value.data


def copied_finding(path: str, found: CopiedRemap, key: str) -> Finding:
    """The finding at a remapping that should name a key which nothing reads."""
    child, remap, other = found
    return Finding(
        span=remap.to_span,
        message=f"`{child.name}` and `{other.name}` both read `{remap.to}`, and nothing reads"
        f" `{key}`",
        arguments=(key, remap.to),
        help=f"write `{remap.key}: {key}`, or remove `{key}` if this is intended",
        effect=f"`{child.name}` works with the value of `{remap.to}`",
        related=(
            *other_place(
                next(each.to_span for each in other.remaps if each.to == remap.to),
                f"`{other.name}` reads it here",
            ),
            *calls(child, remap.to_span),
        ),
        node=f"{path}/{child.name}",
    )
