"""Outcomes of iterators after a preempt request, and renames whose names have changed places."""

from __future__ import annotations

from smachac.analysis.control_flow import has_no_interface
from smachac.ir import nodes
from smachac.ir.graph import stopped_endings
from smachac.ir.nodes import Container
from smachac.ir.traversal import outcome_names


def inverted_renames(container: Container) -> list[tuple[str, str]]:
    """The entries of the final outcome map of an iterator in which the two names have changed
    places: its state ends with the second one only."""
    if not isinstance(container, nodes.Iterator) or any(map(has_no_interface, container.children)):
        return []
    ends = {name for child in container.children for name in outcome_names(child)}
    ends.add(container.exhausted_outcome)
    own = outcome_names(container)
    return [pair for pair in container.final_map
            if pair[0] not in ends and pair[1] in ends and pair[0] in own]  # fmt: skip


def undeclared_stops(container: nodes.Iterator) -> list[str]:
    """The undeclared outcomes with which an iterator ends after a preempt request."""
    if container.catches or not container.item_key:  # without an item: SM004 or SM005
        return []
    own = outcome_names(container)
    ends = stopped_endings(container)
    return [name for name, result in ends.items() if result not in own]
