"""Absorbing Markov chains: expected visits and absorption probabilities.

States are eliminated one after the other (Grassmann, Taksar and Heyman, "Regenerative analysis and
steady state distributions for Markov chains", Operations Research 33, 1985): there are only sums
of numbers that are not negative and quotients of them, so that small probabilities keep their
digits.
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from typing import TypeVar

Label = TypeVar("Label", bound=Hashable)


class EndlessChainError(Exception):
    """A state is reached from which no end of the chain can be reached; `label` is that state."""

    def __init__(self, label: object) -> None:
        super().__init__(f"`{label}` is reached, and no end can be reached from it")
        self.label = label


def absorption(
    rows: Mapping[Label, Mapping[Label, float]], start: Label
) -> tuple[dict[Label, float], dict[Label, float]]:
    """The expected visits of each state that is reached from `start`, and the probability of each
    end. Raises EndlessChainError.

    `rows` has the probabilities of the next state by state; labels without a row are ends.

    The time is linear for chains without cycles, cubic at worst.
    """
    order = _reachable(rows, start)
    own = {label: {to: p for to, p in rows[label].items() if p > 0} for label in order}
    before: dict[Label, set[Label]] = {label: set() for label in order}
    for label in order:
        for to in own[label]:
            if to in before:
                before[to].add(label)
    columns: list[tuple[Label, dict[Label, float]]] = []
    for label in reversed(order[1:]):
        left = {to: p for to, p in own.pop(label).items() if to != label}
        leaving = sum(left.values())
        column: dict[Label, float] = {}
        for source in before.pop(label) - {label}:
            weight = own[source].pop(label) / _positive(leaving, label)
            column[source] = weight
            for to, p in left.items():
                own[source][to] = own[source].get(to, 0.0) + weight * p
                if to in before:
                    before[to].add(source)
        for to in left:
            if to in before:
                before[to].discard(label)
        columns.append((label, column))
    row = own[start]
    leaving = _positive(sum(p for to, p in row.items() if to != start), start)
    visits = {start: 1.0 / leaving}
    for label, column in reversed(columns):
        visits[label] = sum(visits[source] * weight for source, weight in column.items())
    return visits, {to: p / leaving for to, p in row.items() if to != start}


def _positive(leaving: float, label: object) -> float:
    if leaving <= 0:
        raise EndlessChainError(label)
    return leaving


def _reachable(rows: Mapping[Label, Mapping[Label, float]], start: Label) -> list[Label]:
    """The states that are reached with a probability above 0, the start first, each after one that
    leads to it."""
    found, order = {start}, [start]
    for label in order:
        for to, p in rows[label].items():
            if p > 0 and to in rows and to not in found:
                found.add(to)
                order.append(to)
    return order
