"""Transitions of failures to a state that reads a key which is unset then (SM301), where the
outcome of the container that is meant is never reached (SM203)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from smachac.analysis.context import Context
from smachac.analysis.control_flow import Linear, children_names, unhandled_in
from smachac.analysis.fixpoint import flow_order, may_be_unset
from smachac.analysis.unset_reads import Missing
from smachac.ir.graph import Vertex
from smachac.ir.nodes import Leaf, Outcome, StateMachine, Transition
from smachac.ir.outcome_names import PREEMPTED, fails
from smachac.ir.traversal import outcome_names


class Misled(NamedTuple):
    """A transition for a failure to a state that reads a key which is unset then, and the only
    outcome of failure of the container to which no transition leads."""

    step: Transition
    meant: Outcome


def misled_failures(context: Context) -> Mapping[tuple[str, str], Misled]:
    """Such transitions by the path of the container and the key. The state before sets the key on
    another outcome, and no other state leaves it unset."""
    missing = context.missing_keys("unset")
    if not missing:
        return {}
    linear = zip(context.linear, context.corrected, strict=True)
    wholes = {path: whole for (path, _), whole in linear if isinstance(whole, StateMachine)}
    found: dict[tuple[str, str], Misled] = {}
    for each in missing:
        whole = wholes.get(each.scope.path)
        if whole is None:
            continue
        possible = linear_outcomes(context, each.scope.path, whole)
        if possible is None:
            continue
        unled = [outcome for outcome in whole.outcomes
                 if outcome.name not in possible and outcome.name != PREEMPTED]  # fmt: skip
        steps = [*_failures_to_readers(each)] if len(unled) == 1 else []
        if len(steps) == 1 and fails(whole, unled[0].name):
            found[each.scope.path, each.key] = Misled(steps[0], unled[0])
    return found


def _failures_to_readers(missing: Missing) -> Iterator[Transition]:
    """The transitions for failures to a state that reads a missing key, of states that set the key
    on another outcome, and are entered without it."""
    scope, key = missing.scope, missing.key
    before: dict[Vertex, set[str]] = {}
    for vertex, steps in scope.steps.items():
        if vertex in scope.children and any(key in step.writes.trusted for step in steps):
            before[vertex] = {step.outcome for step in steps
                              if step.target in missing.vertices
                              and key not in step.writes.trusted}  # fmt: skip
    asked = {vertex: [key] for vertex, outcomes in before.items() if outcomes}
    unset = may_be_unset(asked, scope.steps, flow_order(scope.steps)) if asked else {}
    for vertex in unset:
        node = scope.children[str(vertex)]
        for step in node.transitions if unset[vertex] else ():
            written = step.origin == "written" and step.outcome in before[vertex]
            if written and step.outcome != PREEMPTED and fails(node, step.outcome):
                yield step


def linear_outcomes(context: Context, path: str, whole: Linear) -> frozenset[str] | None:
    """The outcomes with which a corrected state machine or sequence can end; None where another
    fault makes that unknown."""
    if context.of_container(unhandled_in, path, whole):
        return None
    return context.of_container(_outcomes_if_handled, path, whole)


def _outcomes_if_handled(container: Linear) -> frozenset[str] | None:
    """The outcomes with which a container can end; None if a transition leads nowhere."""
    names = children_names(container)
    exits = frozenset(outcome_names(container))
    found = {step.target for child in container.children for step in child.transitions}
    if not found <= names | exits:
        return None
    handled = [
        frozenset(step.outcome for step in child.transitions)
        for child in container.children
        if isinstance(child, Leaf) and child.open
    ]
    if handled:
        found |= exits.difference(frozenset.intersection(*handled))
    return frozenset(found)
