"""Where values of userdata are while a machine runs, and what arrives there (see inference.py)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from smachac.ir.fitting import Misfit
from smachac.ir.nodes import Data, Expression, Key, Node
from smachac.ir.types import ANY, Type
from smachac.source import NOWHERE, Span

Role: TypeAlias = Literal["scope", "input", "output", "variable"]


@dataclass(slots=True, eq=False, kw_only=True)
class Place:
    """Where a value can be: a key of a container (`scope`), or one of a leaf, or a variable.

    `path` and `node` are those of the state; a variable of the base has no node. `span` is the
    place in the text that speaks of it. `declared` is `any` where nothing is.
    """

    path: str
    key: str
    role: Role
    node: Node | None
    span: Span
    declared: Type = ANY
    links: list[Place] = field(default_factory=list, repr=False)
    flows: dict[tuple[object, ...], list[Flow]] = field(default_factory=dict, repr=False)
    kinds: set[Type] = field(default_factory=set, repr=False)
    readers: list[Code] = field(default_factory=list, repr=False)
    holds: Type | None = None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Flow:
    """A value that is in a place: its type, and how it came there.

    `how`: the script gives a literal (`value`), the place declares it, or code computes it.
    `before` is the same value one link earlier. `judged`: a declaration on the way accepted it.
    """

    type: Type
    how: Literal["value", "declared", "computed"]
    span: Span
    place: Place
    value: Data = None
    before: Flow | None = None
    judged: bool = False

    @property
    def mark(self) -> tuple[object, ...]:
        """What tells a flow from others in its place; of those alike one is carried along."""
        which = (self.span, id(self.value)) if self.how == "value" else None
        return self.type, self.judged, which

    @property
    def origin(self) -> Flow:
        """The flow where the value came to be."""
        flow = self
        while flow.before is not None:
            flow = flow.before
        return flow


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Clash:
    """A value that arrives where it does not fit; `misfit` are the innermost types."""

    flow: Flow
    place: Place
    misfit: Misfit


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Code:
    """An expression whose type a place gets; `reads` are the places of the keys it names.

    `items`: the place gets the items of what the expression, or the one place, holds.
    """

    place: Place
    span: Span
    reads: Mapping[str, Place]
    expression: Expression | None = None
    items: bool = False


def place_of(node: Node, key: Key) -> Span:
    """Where the script speaks of a key of a state: its declaration, its remap, else the state."""
    if key.span.source is node.span.source and key.span.source is not NOWHERE.source:
        return key.span
    return next((remap.span for remap in node.remaps if remap.key == key.name), node.span)
