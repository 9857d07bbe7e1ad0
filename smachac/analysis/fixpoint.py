"""Which keys are set along the paths of one container: fixpoints over sets of keys as bits."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from heapq import heappop, heappush
from typing import NamedTuple, TypeAlias

from smachac.analysis.accesses import Writes
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


CELLS = 400_000_000
"""Bits that are kept at a time (50 MB): more keys than fit are judged in turn."""

Asked: TypeAlias = Mapping[Place, Iterable[str]]
"""At each place the keys that are of interest there."""


def may_be_unset(
    asked: Asked, steps: Steps, order: Order, *, sure: bool = False
) -> dict[Place, tuple[str, ...]]:
    """The keys asked for that some path from the start leaves unset, by places where there are any.

    By what is trusted to be written; `sure`: by what surely is.
    """

    def kept(bits: _Bits, writes: Writes) -> tuple[int, int]:
        if sure:
            return bits.whole & ~bits.mask(writes.sure), 0
        return 0 if writes.anything else bits.whole & ~bits.mask(writes.trusted), 0

    return _some_path(asked, steps, order, kept, from_start=True)


def may_be_set(asked: Asked, steps: Steps, order: Order) -> dict[Place, tuple[str, ...]]:
    """The keys asked for that some path from the start sets, by places where there are any."""

    def added(bits: _Bits, writes: Writes) -> tuple[int, int]:
        return bits.whole, bits.whole if writes.anything else bits.mask(writes.perhaps)

    return _some_path(asked, steps, order, added, from_start=False)


class _Bits:
    """Keys of one container as bits of whole numbers."""

    __slots__ = ("_known", "of", "whole")

    def __init__(self, keys: Iterable[str]) -> None:
        self.of = {key: 1 << number for number, key in enumerate(keys)}
        self.whole = (1 << len(self.of)) - 1
        self._known: dict[frozenset[str], int] = {}

    def mask(self, keys: frozenset[str]) -> int:
        """The bits of those keys that have one."""
        if keys not in self._known:
            self._known[keys] = sum(self.of.get(key, 0) for key in keys)
        return self._known[keys]


def _some_path(
    asked: Asked,
    steps: Steps,
    order: Order,
    effect: Callable[[_Bits, Writes], tuple[int, int]],
    *,
    from_start: bool,
) -> dict[Place, tuple[str, ...]]:
    """The keys that arrive at places on some path, when `effect` says which bits stay on a step and
    which are added, and all begin `from_start` or none."""
    here = {place: tuple(dict.fromkeys(keys)) for place, keys in asked.items() if place in order}
    keys = list(dict.fromkeys(key for several in here.values() for key in several))
    size = max(1000, CELLS // len(order))
    found: dict[Place, list[str]] = {}
    for first in range(0, len(keys), size):
        bits = _Bits(keys[first : first + size])
        moves = {
            place: [(step.target, *effect(bits, step.writes)) for step in leading]
            for place, leading in steps.items()
        }
        arrived = _spread(bits.whole if from_start else 0, moves, order)
        for place, several in here.items():
            mask = arrived[place]
            some = [key for key in several if bits.of.get(key, 0) & mask]
            if some:
                found.setdefault(place, []).extend(some)
    return {place: tuple(several) for place, several in found.items()}


Moves = Mapping[Place, list[tuple[Place, int, int]]]
"""From each place the targets, the bits that stay on the way, and those that are added."""


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
