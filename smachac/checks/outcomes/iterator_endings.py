"""Outcomes with which an iterator can end, and the one that it is meant to have."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from smachac.analysis.control_flow import has_no_interface
from smachac.ir import nodes
from smachac.ir.graph import stopped_endings
from smachac.ir.nodes import Outcome
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import outcome_names


def endings(container: nodes.Iterator) -> Iterator[tuple[str, str, str]]:
    """The ways in which an iterator can end: its child (empty after the last item), the outcome
    of that, and the outcome of the iterator."""
    renamed = dict(container.final_map)
    exhausted = container.exhausted_outcome
    yield "", exhausted, renamed.get(exhausted, exhausted)
    loops = frozenset(container.loop_outcomes)
    for child in container.children:
        for name in outcome_names(child):
            if name not in loops:
                yield child.name, name, renamed.get(name, name)


class SuggestedEnding(NamedTuple):
    """The outcome of an iterator after its last item, which the script does not declare and which
    leads nowhere, and the declared outcome that is meant."""

    container: nodes.Iterator
    result: Outcome
    meant: Outcome


def suggested_ending(container: nodes.Iterator) -> SuggestedEnding | None:
    """The outcome that an iterator is meant to have after its last item: the only one that it
    declares and cannot end with."""
    if (
        container.sugar
        or not container.transitions
        or any(map(has_no_interface, container.children))
    ):
        return None
    ways = {result for _, _, result in endings(container)}
    (name, *_) = [result for _, _, result in endings(container)]
    added = [outcome for outcome in container.outcomes if outcome.name == name]
    handled = {step.outcome for step in container.transitions}
    if not added or added[0].span != container.exhausted_span or name in handled:
        return None
    ways |= {*stopped_endings(container).values(), PREEMPTED, container.catches}
    left = [
        outcome
        for outcome in container.outcomes
        if outcome.name not in ways and outcome.name in handled
    ]
    return SuggestedEnding(container, added[0], left[0]) if len(left) == 1 else None
