"""Rules of an outcome map in which outcomes and states have changed places."""

from __future__ import annotations

from typing import NamedTuple

from smachac.analysis.control_flow import has_no_interface
from smachac.checks.findings import notation
from smachac.ir.nodes import Concurrence, OutcomeRule
from smachac.ir.traversal import outcome_names


class Inverted(NamedTuple):
    """A rule of an outcome map that begins with a state, and what is meant: pairs of an outcome of
    the concurrence and one of the state."""

    rule: OutcomeRule
    meant: tuple[tuple[str, str], ...]


def inverted_rules(container: Concurrence) -> tuple[Inverted, ...]:
    """The rules of an outcome map in which outcomes and states have changed places: `STATE:
    {outcome of the state: outcome of the concurrence}`, or with the two outcomes in the other
    order."""
    declared = frozenset(outcome_names(container))
    children = {child.name: child for child in container.children}
    found = []
    for entry in container.rules:
        child = children.get(entry.outcome)
        if child is None or entry.outcome in declared or not entry.when:
            continue
        if any(part.child in children for part in entry.when):
            continue
        pairs = [(part.child, part.outcome) for part in entry.when]
        own = frozenset(outcome_names(child))
        if not has_no_interface(child) and all(
            one in declared and two in own for one, two in pairs
        ):
            found.append(Inverted(entry, tuple(pairs)))
        elif all(two in declared for _, two in pairs):
            found.append(Inverted(entry, tuple((two, one) for one, two in pairs)))
    return tuple(found)


def transposed_rules(container: Concurrence) -> dict[str, str]:
    """The rules of an outcome map in which the outcome of the concurrence and that of the states
    have changed places, by the outcome that they begin with, and how they are written right."""
    declared = frozenset(outcome_names(container))
    children = {child.name: outcome_names(child) for child in container.children}
    found = {}
    for entry in container.rules:
        results = {part.outcome for part in entry.when}
        if entry.outcome in declared or len(results) != 1 or not results <= declared:
            continue
        if all(entry.outcome in children.get(part.child, ()) for part in entry.when):
            states = [(part.child, entry.outcome) for part in entry.when]
            found[entry.outcome] = (
                f"write `{notation.rule(container, results.pop(), states)}`: a rule begins with an"
                f" outcome of `{container.name}`"
            )
    return found
