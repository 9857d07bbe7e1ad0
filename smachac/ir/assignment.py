"""Which keys are set along the paths of one container: fixpoints over sets of keys as bits."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from heapq import heappop, heappush
from typing import NamedTuple, TypeAlias

from smachac.ir.accesses import Writes
from smachac.ir.graph import START, Place


class Step(NamedTuple):
    """Control passes to `target` on `outcome`, and the keys that are set by then."""

    target: Place
    outcome: str
    writes: Writes


Steps: TypeAlias = Mapping[Place, tuple[Step, ...]]
"""The steps from each place of a container, in the order of the script."""


Order: TypeAlias = Mapping[Place, int]
"""The places that can be reached, each before what follows it, but for loops."""


def flow_order(steps: Steps) -> Order:
    """The order in which control flows from the start."""
    seen: set[Place] = {START}
    left: list[Place] = []
    stack = [(START, iter(steps.get(START, ())))]
    while stack:
        place, leading = stack[-1]
        following = next((step.target for step in leading if step.target not in seen), None)
        if following is None:
            left.append(place)
            stack.pop()
        else:
            seen.add(following)
            stack.append((following, iter(steps.get(following, ()))))
    return {place: number for number, place in enumerate(reversed(left))}


def looping(steps: Steps, order: Order) -> frozenset[Place]:
    """The places that a path can come back to."""
    backwards = any(
        order[step.target] <= order[place] for place in order for step in steps.get(place, ())
    )
    if not backwards:
        return frozenset()
    import networkx as nx

    graph = nx.DiGraph()
    graph.add_edges_from((p, step.target) for p in order for step in steps.get(p, ()))
    parts = nx.strongly_connected_components(graph)
    return frozenset(p for part in parts for p in part if len(part) > 1 or graph.has_edge(p, p))


class Bits:
    """Keys of one container as bits of whole numbers."""

    __slots__ = ("_known", "of", "whole")

    def __init__(self, keys: Iterable[str]) -> None:
        self.of = {key: 1 << number for number, key in enumerate(dict.fromkeys(keys))}
        self.whole = (1 << len(self.of)) - 1
        self._known: dict[frozenset[str], int] = {}

    def mask(self, keys: frozenset[str]) -> int:
        """The bits of those keys that have one."""
        if keys not in self._known:
            self._known[keys] = sum(self.of.get(key, 0) for key in keys)
        return self._known[keys]

    def among(self, keys: Iterable[str], mask: int) -> list[str]:
        """The keys, in their order, whose bit is in the mask."""
        return [key for key in keys if self.of.get(key, 0) & mask]


Moves = Mapping[Place, list[tuple[Place, int, int]]]
"""From each place the targets, the bits that stay on the way, and those that are added."""


def may_be_unset(
    bits: Bits, steps: Steps, order: Order, *, sure: bool = False
) -> Mapping[Place, int]:
    """The keys that some path from the start leaves unset, at each place that can be reached.

    By what is trusted to be written; `sure`: by what surely is.
    """

    def kept(writes: Writes) -> int:
        if sure:
            return bits.whole & ~bits.mask(writes.sure)
        return 0 if writes.anything else bits.whole & ~bits.mask(writes.trusted)

    moves = {
        place: [(step.target, kept(step.writes), 0) for step in leading]
        for place, leading in steps.items()
    }
    return _spread(bits.whole, moves, order)


def may_be_set(bits: Bits, steps: Steps, order: Order) -> Mapping[Place, int]:
    """The keys that some path from the start sets."""

    def added(writes: Writes) -> int:
        return bits.whole if writes.anything else bits.mask(writes.perhaps)

    moves = {
        place: [(step.target, bits.whole, added(step.writes)) for step in leading]
        for place, leading in steps.items()
    }
    return _spread(0, moves, order)


def _spread(start: int, moves: Moves, order: Order) -> Mapping[Place, int]:
    """The union over all paths of the bits that arrive, by rounds in the order of the flow."""
    places = list(order)
    found: dict[Place, int] = {START: start}
    todo = [order[START]]
    waiting = set(todo)
    while todo:
        number = heappop(todo)
        waiting.discard(number)
        here = found[places[number]]
        for target, kept, added in moves.get(places[number], ()):
            before = found.get(target)
            after = (here & kept) | added | (before or 0)
            if before != after:
                found[target] = after
                if order[target] not in waiting:
                    waiting.add(order[target])
                    heappush(todo, order[target])
    return found
