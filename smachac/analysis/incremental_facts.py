"""Facts about the states of a machine, kept for the machine after a change.

A function finds something at each state of a preorder, by the path and the node. What it found at a
container and below it holds for the next machine too, if the container is the same object there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from typing import NamedTuple, TypeAlias

from smachac.ir.nodes import Leaf, Node

Fact: TypeAlias = "Callable[..., Iterable[object]]"
"""What there is at a state, by its path, its node and more arguments."""


class Preorder:
    """Some states of a machine with their paths, parents before children: the root, and of the
    children of these states those that `belongs` chooses, by the node alone."""

    def __init__(self, nodes: Sequence[tuple[str, Node]], belongs: Callable[[Node], bool]) -> None:
        self.nodes = nodes
        self._belongs = belongs

    @cached_property
    def numbers(self) -> dict[str, int]:
        """The numbers of the states by path."""
        return {path: number for number, (path, _) in enumerate(self.nodes)}

    @cached_property
    def ends(self) -> Sequence[int]:
        """For each state the number after that of the last one below it."""
        ends = [0] * len(self.nodes)
        following: list[int] = []  # the ends of the siblings that follow, the next one last
        for number in range(len(self.nodes) - 1, -1, -1):
            _, node = self.nodes[number]
            count = 0 if isinstance(node, Leaf) else sum(map(self._belongs, node.children))
            end = number + 1
            if count:
                end = following[-count]
                del following[-count:]
            ends[number] = end
            following.append(end)
        return ends


class IncrementalResult(NamedTuple):
    """What a function found at the states of a preorder: `begins` has for each state the number of
    the things found before."""

    states: Preorder
    begins: Sequence[int]
    things: tuple[object, ...]


def found_at(
    states: Preorder, fact: Fact, given: tuple[object, ...], before: IncrementalResult | None
) -> IncrementalResult:
    """What a function finds at states, in their order. `before`: what it found in the machine
    before a change; what holds still is taken from there."""
    begins: list[int] = []
    things: list[object] = []
    if before is None:
        for path, node in states.nodes:
            begins.append(len(things))
            things.extend(fact(path, node, *given))
        return IncrementalResult(states, begins, tuple(things))
    while len(begins) < len(states.nodes):
        path, node = states.nodes[len(begins)]
        number = before.states.numbers.get(path)
        if isinstance(node, Leaf) or number is None or before.states.nodes[number][1] is not node:
            begins.append(len(things))
            things.extend(fact(path, node, *given))
            continue
        end = before.states.ends[number]
        first = before.begins[number]
        last = before.begins[end] if end < len(before.begins) else len(before.things)
        more = len(things) - first
        begins.extend([begin + more for begin in before.begins[number:end]])
        things.extend(before.things[first:last])
    return IncrementalResult(states, begins, tuple(things))
