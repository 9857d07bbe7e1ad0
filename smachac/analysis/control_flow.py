"""Containers as far as their flow can be judged, so that one fault is reported once.

A misspelt name is read as the name it is nearest to; what is not known of an open leaf is taken to
be fine.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import replace
from typing import TypeAlias

from smachac.analysis.context import containers, once, states
from smachac.diagnostics.source import assert_never
from smachac.diagnostics.spelling import Guesser, guesser
from smachac.ir import nodes
from smachac.ir.graph import START, can_end, edges, reachable
from smachac.ir.nodes import (
    Concurrence,
    Leaf,
    Machine,
    Node,
    Outcome,
    StateMachine,
    Transition,
)
from smachac.ir.outcome_names import PREEMPTED, is_failure
from smachac.ir.traversal import leads_to_child, outcome_names

Linear: TypeAlias = "StateMachine | nodes.Sequence"
"""A container whose states follow one another along transitions."""


def linear(machine: Machine) -> Iterator[tuple[str, Linear]]:
    """The containers with transitions, and their paths."""
    for path, container in containers(machine):
        if isinstance(container, StateMachine | nodes.Sequence):
            yield path, container


def is_open(node: Node) -> bool:
    return isinstance(node, Leaf) and node.open


def fails(node: Node, outcome: str) -> bool:
    """Whether a state has failed when it ends so; tries that are used up (`retry:`) have."""
    if isinstance(node, nodes.Iterator) and node.sugar == "retry":
        return outcome == node.exhausted_outcome or is_failure(outcome)
    return is_failure(outcome)


def children_names(container: nodes.Container) -> frozenset[str]:
    return frozenset(child.name for child in container.children)


def places_of(container: nodes.Container) -> Guesser:
    """Guesses what a transition inside a container was meant to lead to."""
    return guesser([*(child.name for child in container.children), *outcome_names(container)])


def leads_somewhere(transition: Transition, names: frozenset[str], exits: frozenset[str]) -> bool:
    return leads_to_child(transition, names) or transition.target in exits


def unknown_outcomes(child: Node) -> list[tuple[Transition, str | None]]:
    """The transitions from outcomes that a state does not have, with the outcome meant."""
    declared = {outcome.name for outcome in child.outcomes}
    unknown = [step for step in child.transitions if step.outcome not in declared]
    if not unknown or is_open(child):
        return []
    guess = guesser(outcome_names(child))
    return [(step, guess(step.outcome)) for step in unknown]


def mended(container: Linear) -> Linear:
    """A container with misspelt targets and outcomes put right, where a near name exists.

    A state that lists no outcome at all has those of its transitions.
    """
    names = children_names(container)
    exits = frozenset(outcome_names(container))
    guess = places_of(container)

    def target(step: Transition) -> Transition:
        if leads_somewhere(step, names, exits):
            return step
        return replace(step, target=guess(step.target) or step.target)

    def child(node: Node) -> Node:
        unknown = unknown_outcomes(node)
        lost = [step for step in node.transitions if not leads_somewhere(step, names, exits)]
        if not unknown and not lost:
            return node
        wrong = {id(step): meant for step, meant in unknown}
        steps = [
            replace(step, outcome=wrong.get(id(step)) or step.outcome) for step in node.transitions
        ]
        outcomes = node.outcomes or tuple(Outcome(name=s.outcome, span=s.span) for s in steps)
        return replace(node, outcomes=outcomes, transitions=tuple(map(target, steps)))

    children = tuple(map(child, container.children))
    if all(new is old for new, old in zip(children, container.children, strict=True)):
        return container
    return replace(container, children=children)


def outline(container: Linear, endless: AbstractSet[int]) -> Linear:
    """A mended container in which open leaves can leave and endless states cannot.

    An open leaf may have any outcome: one that its container has and it does not handle leaves.
    """
    exits = outcome_names(container)

    def child(node: Node) -> Node:
        if id(node) in endless:
            return replace(node, transitions=(), outcomes=())
        if not is_open(node):
            return node
        handled = {step.outcome for step in node.transitions}
        unhandled = [name for name in exits[: len(handled) + 2] if name not in handled]
        if not unhandled:
            return node
        way = next((name for name in unhandled if name != PREEMPTED), unhandled[0])
        more = Transition(outcome=way, target=way, origin="implicit", span=node.span)
        return replace(node, transitions=(*node.transitions, more))

    # Endless states are known by identity, which mending would change.
    outlined = replace(container, children=tuple(map(child, container.children)))
    return mended(outlined)


@once
def endless_states(machine: Machine) -> frozenset[int]:
    """The states, by `id`, that never end and are meant so, or have no outcome at all.

    A container with a trap of its own is not among them: the trap is reported inside it.
    """
    found: set[int] = set()
    for _, node in reversed(states(machine)):
        if _never_ends(node, found):
            found.add(id(node))
    return frozenset(found)


def _never_ends(node: Node, inner: set[int]) -> bool:
    if node.catches:
        return False
    match node:
        case Leaf():
            return not node.open and not node.outcomes and not node.transitions
        case StateMachine(forever=True):
            flow = outline(node, inner)
            return node.initial in reachable(flow) - can_end(flow)
        case StateMachine() | nodes.Sequence():
            return False
        case Concurrence():
            lasting = [id(child) in inner for child in node.children]
            return bool(lasting) and (all(lasting) if node.join == "any" else any(lasting))
        case nodes.Iterator():
            skips = any(edge.source == START and edge.kind == "exhausted" for edge in edges(node))
            return not skips and any(id(child) in inner for child in node.children)
    return assert_never(node)


MOST_STEPS = 50
"""A witness path keeps so many of its last states."""

Steps = dict[str, list[tuple[str, str]]]
"""The outcomes of each state that lead to a sibling, and to which."""


def steps_of(container: Linear) -> Steps:
    """The steps inside a container."""
    names = children_names(container)
    steps: Steps = {child.name: [] for child in container.children}
    for child in container.children:
        for step in child.transitions:
            if leads_to_child(step, names):
                steps[child.name].append((step.outcome, step.target))
    return steps


def stuck_states(container: Linear) -> list[str]:
    """The states that can be entered and from which the container cannot be left."""
    ends = can_end(container)
    if len(ends) == len(container.children):
        return []
    stuck = reachable(container) - ends
    return list(dict.fromkeys(child.name for child in container.children if child.name in stuck))


def regions(names: Iterable[str], steps: Steps) -> list[list[str]]:
    """The strongly connected parts of a graph; they and their states in the order of `names`."""
    import networkx as nx

    order = {name: number for number, name in enumerate(names)}
    graph = nx.DiGraph()
    graph.add_nodes_from(order)
    graph.add_edges_from((a, b) for a in order for _, b in steps[a] if b in order)
    parts = nx.strongly_connected_components(graph)
    found = [sorted(part, key=order.__getitem__) for part in parts]
    return sorted(found, key=lambda part: order[part[0]])


def dead_ends(names: Iterable[str], steps: Steps) -> list[list[str]]:
    """The regions that no step leaves."""
    ends = []
    for region in regions(names, steps):
        inside = frozenset(region)
        if all(target in inside for name in region for _, target in steps[name]):
            ends.append(region)
    return ends


def ways_from(start: str, steps: Steps) -> dict[str, tuple[str, str]]:
    """Shortest ways: for each state that follows `start`, the state and outcome before it."""
    before: dict[str, tuple[str, str]] = {}
    todo = [start]
    for name in todo:
        for outcome, target in steps.get(name, ()):
            if target not in before:
                before[target] = (name, outcome)
                if target != start:
                    todo.append(target)
    return before


def way(start: str, goal: str, before: Mapping[str, tuple[str, str]]) -> list[str]:
    """The states on the way to `goal`, and between them the outcomes, in brackets.

    Where the goal is the start, the way leads round to it once more.
    """
    found = [goal]
    while len(found) < 2 * MOST_STEPS and found[-1] in before:
        name, outcome = before[found[-1]]
        found += [f"({outcome})", name]
        if name == start:
            break
    return found[::-1]


def circle(region: Sequence[str], steps: Steps) -> list[str]:
    """The shortest way from the first state of a region back to it; empty where there is none."""
    inside = frozenset(region)
    within = {name: [step for step in steps[name] if step[1] in inside] for name in region}
    before = ways_from(region[0], within)
    return way(region[0], region[0], before) if region[0] in before else []
