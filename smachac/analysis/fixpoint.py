"""Fixpoints over the vertices of one container: the sets of keys that are set, as bits."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from heapq import heappop, heappush
from typing import NamedTuple, TypeAlias

from smachac.analysis.accesses import NOTHING, Writes
from smachac.ir.graph import START, Vertex


class KeyStep(NamedTuple):
    """Control passes to `target` on `outcome`; `writes` are the keys that are set then."""

    target: Vertex
    outcome: str
    writes: Writes


KeySteps: TypeAlias = Mapping[Vertex, tuple[KeyStep, ...]]
"""The steps from each vertex of a container, in the order of the script."""


Order: TypeAlias = Mapping[Vertex, int]
"""The reachable vertices in reverse postorder, with their numbers."""


def flow_order(steps: KeySteps) -> Order:
    """The order in which control flows from the start: reverse postorder."""
    # By hand, as every check comes here (see ir/graph.py on the import of networkx).
    seen: set[Vertex] = {START}
    left: list[Vertex] = []
    stack = [(START, iter(steps.get(START, ())))]
    while stack:
        vertex, leading = stack[-1]
        for following, _, _ in leading:
            if following not in seen:
                seen.add(following)
                stack.append((following, iter(steps.get(following, ()))))
                break
        else:
            left.append(vertex)
            stack.pop()
    return {vertex: number for number, vertex in enumerate(reversed(left))}


def looping(steps: KeySteps, order: Order) -> frozenset[Vertex]:
    """The vertices that a path can come back to."""
    backwards = any(
        order[step.target] <= number
        for vertex, number in order.items()
        for step in steps.get(vertex, ())
    )
    if not backwards:
        return frozenset()
    import networkx as nx

    graph = nx.DiGraph()
    graph.add_edges_from((p, step.target) for p in order for step in steps.get(p, ()))
    parts = nx.strongly_connected_components(graph)
    return frozenset(p for part in parts for p in part if len(part) > 1 or graph.has_edge(p, p))


CELLS = 400_000_000
"""The most bits that are kept at a time (50 MB); more keys are analysed in several passes."""

Asked: TypeAlias = Mapping[Vertex, Iterable[str]]
"""At each vertex the keys that are of interest there."""


def may_be_unset(
    asked: Asked, steps: KeySteps, order: Order, *, sure: bool = False
) -> dict[Vertex, tuple[str, ...]]:
    """Of the keys of interest at each vertex, those that some path from the start leaves unset.

    Trusted writes count; with `sure`, only sure writes count.
    """

    def left(bits: _Bits, writes: Writes, unset: int) -> int:
        if sure:
            return unset & ~bits.mask(writes.sure)
        return 0 if writes.anything else unset & ~bits.mask(writes.trusted)

    return _some_path(asked, steps, order, left, from_start=True)


def may_be_set(asked: Asked, steps: KeySteps, order: Order) -> dict[Vertex, tuple[str, ...]]:
    """Of the keys of interest at each vertex, those that some path from the start sets."""

    def more(bits: _Bits, writes: Writes, set_: int) -> int:
        return bits.whole if writes.anything else set_ | bits.mask(writes.perhaps)

    return _some_path(asked, steps, order, more, from_start=False)


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


Effect: TypeAlias = "Callable[[_Bits, Writes, int], int]"
"""The bits after a step that writes something, from those before it."""


def _some_path(
    asked: Asked,
    steps: KeySteps,
    order: Order,
    effect: Effect,
    *,
    from_start: bool,
) -> dict[Vertex, tuple[str, ...]]:
    """Of the keys of interest at each vertex, those that arrive on some path; at the start all
    bits are set or none."""
    here = {vertex: tuple(dict.fromkeys(keys)) for vertex, keys in asked.items() if vertex in order}
    keys = list(dict.fromkeys([key for several in here.values() for key in several]))
    size = max(1000, CELLS // len(order))
    found: dict[Vertex, list[str]] = {}
    for first in range(0, len(keys), size):
        bits = _Bits(keys[first : first + size])
        arrived = _spread(bits, bits.whole if from_start else 0, steps, order, effect)
        for vertex, several in here.items():
            mask = arrived[order[vertex]]
            some = [key for key in several if bits.of.get(key, 0) & mask]
            if some:
                found.setdefault(vertex, []).extend(some)
    return {vertex: tuple(several) for vertex, several in found.items()}


def _spread(
    bits: _Bits, start: int, steps: KeySteps, order: Order, effect: Effect
) -> Sequence[int]:
    """The union over all paths of the bits that arrive, by the numbers of the vertices. Each vertex
    is visited in the order of the flow, and again after a change by a step backwards."""
    vertices = list(order)
    found = [0] * len(vertices)
    found[0] = start
    todo = list(range(len(vertices)))  # a heap
    waiting = set(todo)
    while todo:
        number = heappop(todo)
        waiting.remove(number)
        here = found[number]
        for following, _, writes in steps.get(vertices[number], ()):
            target = order[following]
            before = found[target]
            after = before | (here if writes is NOTHING else effect(bits, writes, here))
            if after != before:
                found[target] = after
                if target not in waiting:
                    waiting.add(target)
                    heappush(todo, target)
    return found
