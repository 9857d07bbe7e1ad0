"""Uses of userdata keys: what in a container reads and writes each of its keys."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import Literal, NamedTuple

from smachac.diagnostics.source import NOWHERE, Span
from smachac.ir import nodes
from smachac.ir.nodes import Container, Expression, Key, Leaf, Node, Preset
from smachac.ir.script_code import script_code
from smachac.ir.traversal import remapping
from smachac.records import dataclass, field

UseKind = Literal["presets", "items", "reads", "writes", "copies in", "copies out"]
"""How a key is used: the container holds it before it starts; an iterator puts its items there; a
leaf reads or writes it, or an iterator reads it for its items; a container inside copies it from or
to the userdata around it."""

READS: frozenset[UseKind] = frozenset(["reads", "copies in"])
"""The kinds of uses that read a key."""

WRITES: frozenset[UseKind] = frozenset(["writes", "copies out"])
"""The kinds of uses by which a state writes a key."""


class Use(NamedTuple):
    """One use of the key `outer` of a container, by the state `node` at `path`.

    `key` is the name of the key in the state. `declared` is the input or output of the state, or
    the preset of the container; None for the items and the item of an iterator. A key that is both
    an input and an output of a state has two uses.
    """

    path: str
    node: Node
    kind: UseKind
    key: str
    outer: str
    declared: Key | Preset | None

    @property
    def reads(self) -> bool:
        return self.kind in READS

    @property
    def writes(self) -> bool:
        return self.kind in WRITES

    @property
    def span(self) -> Span:
        """The place of the key in the text of the state, or else that of the state."""
        match self.declared:
            case Key() as key:
                return place_of(self.node, key)
            case Preset(span=span):
                return span
        return self.node.span


@dataclass(frozen=True, kw_only=True)
class KeyUses:
    """The uses of the keys of the container at `path`, in the order of the script: first those by
    the container itself. They are found in one pass over the states, when they are first needed,
    and kept."""

    path: str
    container: Container = field(repr=False)

    @cached_property
    def all(self) -> tuple[Use, ...]:
        """The uses of all keys."""
        return tuple(_uses(self.path, self.container))

    @cached_property
    def by_key(self) -> Mapping[str, list[Use]]:
        """The uses by key of the container."""
        found: dict[str, list[Use]] = {}
        for use in self.all:
            found.setdefault(use.outer, []).append(use)
        return found

    @cached_property
    def by_reader(self) -> Mapping[tuple[str, str], Use]:
        """The uses that read a key, by the name of the state and the key of the container."""
        return {(use.node.name, use.outer): use for use in reversed(self.all) if use.reads}

    @cached_property
    def read(self) -> frozenset[str]:
        """The keys that something in the container reads."""
        return frozenset([use.outer for use in self.all if use.reads])

    @cached_property
    def written(self) -> frozenset[str]:
        """The keys that a state in the container writes."""
        return frozenset([use.outer for use in self.all if use.writes])

    @cached_property
    def given(self) -> frozenset[str]:
        """The inputs and presets of the container, and the item of an iterator."""
        own = frozenset([use.outer for use in self.all if not (use.reads or use.writes)])
        return own.union([key.name for key in self.container.inputs])

    @cached_property
    def provided(self) -> frozenset[str]:
        """The keys that the container gets or presets, or that a state in it writes."""
        return self.given | self.written

    def of(self, key: str) -> list[Use]:
        """The uses of a key."""
        return self.by_key.get(key, [])

    def readers(self, key: str) -> list[Use]:
        """The uses that read a key."""
        return [use for use in self.of(key) if use.reads]

    def writers(self, key: str) -> list[Use]:
        """The uses by which states write a key."""
        return [use for use in self.of(key) if use.writes]


def _uses(path: str, container: Container) -> Iterator[Use]:
    for preset in container.userdata:
        yield Use(path, container, "presets", preset.key, preset.key, preset)
    if isinstance(container, nodes.Iterator):
        item = container.item_key
        yield Use(path, container, "items", item, item, None)
        for name in items_read(container):
            yield Use(path, container, "reads", name, name, None)
    for child in container.children:
        if not (child.inputs or child.outputs):
            continue
        is_leaf, inner = isinstance(child, Leaf), f"{path}/{child.name}"
        names = remapping(child)
        for key in child.inputs:
            kind: UseKind = "reads" if is_leaf else "copies in"
            yield Use(inner, child, kind, key.name, names[key.name], key)
        for key in child.outputs:
            kind = "writes" if is_leaf else "copies out"
            yield Use(inner, child, kind, key.name, names[key.name], key)


def items_read(container: Container) -> tuple[str, ...]:
    """The keys that an iterator reads to get its items."""
    if not isinstance(container, nodes.Iterator):
        return ()
    if container.items_key:
        return (container.items_key,)
    if container.items is not None and isinstance(container.items.data, Expression):
        fields = script_code(container.items.data.text).fields
        return tuple(key for key in fields.read if key not in fields.tested) if fields else ()
    return ()


def place_of(node: Node, key: Key) -> Span:
    """The place of a key of a state: in its list of keys, else its remap, else the state. A list of
    keys in Python is one of a class, which other states can have."""
    source = node.span.source
    if key.span.source is source and source.language != "python" and source is not NOWHERE.source:
        return key.span
    for remap in node.remaps:
        if remap.key == key.name:
            return remap.span
    return node.span
