"""Control flow inside a container: strongly connected components and shortest witness paths.

The analyses work on absorbed containers, so that one fault gives one finding: an unknown name can
mean every known one, and an open leaf can have every outcome that avoids a finding.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from collections.abc import Set as AbstractSet
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from smachac.diagnostics.diagnostic import PathStep, ended, entered
from smachac.diagnostics.spelling import Guesser, guesser
from smachac.ir import nodes
from smachac.ir.graph import START, can_end, edges, reachable
from smachac.ir.nodes import Concurrence, Leaf, Node, Outcome, StateMachine, Transition
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import leads_to_child, outcome_names
from smachac.records import replace

if TYPE_CHECKING:
    import networkx as nx

Linear: TypeAlias = "StateMachine | nodes.Sequence"
"""A container whose states are connected by transitions."""


def has_no_interface(node: Node) -> bool:
    return isinstance(node, Leaf) and node.open


def children_names(container: nodes.Container) -> frozenset[str]:
    return frozenset([child.name for child in container.children])


def places_of(container: nodes.Container) -> Guesser:
    """The guesser for the targets of transitions inside a container."""
    return guesser([*(child.name for child in container.children), *outcome_names(container)])


def dangling_transitions(
    children: Iterable[Node], names: frozenset[str], exits: frozenset[str]
) -> list[Transition]:
    """The transitions of children that lead neither to one of `names` nor out by one of `exits`."""
    return [
        step for child in children for step in child.transitions if _is_dangling(step, names, exits)
    ]


def _is_dangling(step: Transition, names: frozenset[str], exits: frozenset[str]) -> bool:
    # `leads_to_child` in place: the check of every transition comes here
    return step.target not in exits and (step.target not in names or step.origin == "implicit")


def unknown_outcomes(child: Node) -> list[Transition]:
    """The transitions for outcomes that a state does not have."""
    if has_no_interface(child):
        return []
    declared = {outcome.name for outcome in child.outcomes}
    return [step for step in child.transitions if step.outcome not in declared]


def absorbed(container: Linear) -> Linear:
    """A container in which nothing follows from an unknown name: an unread state, which can be
    followed by every other one, stands for each unknown target of a transition, and a state has the
    unknown outcomes of its transitions too."""
    names = children_names(container)
    lost = dangling_transitions(container.children, names, frozenset(outcome_names(container)))
    if not lost and not any(map(unknown_outcomes, container.children)):
        return container
    spans = {step.target: step.target_span for step in reversed(lost) if step.target not in names}
    missing = (Leaf(name=name, type="", span=spans[name], open=True) for name in reversed(spans))
    children = (*map(_with_unknown_outcomes, container.children), *missing)
    return replace(container, children=children)


def _with_unknown_outcomes(child: Node) -> Node:
    steps = {step.outcome: step for step in unknown_outcomes(child)}
    more = (Outcome(name=name, span=step.span) for name, step in steps.items())
    return replace(child, outcomes=(*child.outcomes, *more)) if steps else child


def outline(
    path: str, container: Linear, endless: AbstractSet[str], known: Linear | None = None
) -> Linear:
    """A container, absorbed, in which open leaves lead out of it and endless states lead nowhere.

    An open leaf can have any outcome, also one that its container has and no transition handles.
    `known` is the absorbed container, if it has been computed.
    """
    if not endless and not any(map(has_no_interface, container.children)):
        return known if known is not None else absorbed(container)
    exits = outcome_names(container)

    def child(node: Node) -> Node:
        if endless and f"{path}/{node.name}" in endless:
            return replace(node, transitions=(), outcomes=())
        if not has_no_interface(node):
            return node
        handled = {step.outcome for step in node.transitions}
        unhandled = [name for name in exits[: len(handled) + 2] if name not in handled]
        if not unhandled:
            return node
        way = next((name for name in unhandled if name != PREEMPTED), unhandled[0])
        more = Transition(outcome=way, target=way, origin="implicit", span=node.span)
        return replace(node, transitions=(*node.transitions, more))

    children = tuple(map(child, container.children))
    if all(new is old for new, old in zip(children, container.children, strict=True)):
        return known if known is not None else absorbed(container)
    return absorbed(replace(container, children=children))


def endless_states(states: Sequence[tuple[str, Node]]) -> frozenset[str]:
    """The paths of the states that never end: with `forever: true`, or without any outcome.

    A container with a trap in it is not among them: the trap is reported inside it.
    """
    found: set[str] = set()
    for path, node in reversed(states):
        if node.outcomes and isinstance(node, Leaf):
            continue  # most states
        if _never_ends(path, node, found):
            found.add(path)
    return frozenset(found)


def _never_ends(path: str, node: Node, inner: set[str]) -> bool:
    if node.catches:
        return False
    match node:
        case Leaf():
            return not node.open and not node.outcomes and not node.transitions
        case StateMachine(forever=True):
            flow = outline(path, node, inner)
            return node.initial in reachable(flow) - can_end(flow)
        case StateMachine() | nodes.Sequence():
            return False
        case Concurrence():
            lasting = [f"{path}/{child.name}" in inner for child in node.children]
            return bool(lasting) and (any(lasting) if node.join == "all" else all(lasting))
    skips = any(edge.source == START and isinstance(edge.target, tuple) for edge in edges(node))
    lasting = [f"{path}/{child.name}" in inner for child in node.children]
    return bool(lasting) and all(lasting) and not skips


MOST_STEPS = 50
"""The most states of a witness path: the last ones are kept."""

SiblingSteps = dict[str, list[tuple[str, str]]]
"""For each state the outcomes that lead to a sibling, with the sibling."""


def steps_of(container: Linear) -> SiblingSteps:
    """The transitions between the states of a container."""
    names = children_names(container)
    steps: SiblingSteps = {child.name: [] for child in container.children}
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


class Trap(NamedTuple):
    """A container with states from which none of its outcomes can be reached: their names, and the
    container as `outline` returns it."""

    container: Linear
    flow: Linear
    stuck: list[str]


def step_graph(names: Iterable[str], steps: SiblingSteps) -> nx.DiGraph:
    """Some states of a container and the steps between them, with the first outcome of each."""
    import networkx as nx

    graph = nx.DiGraph()
    graph.add_nodes_from(names)
    for name in list(graph):
        for outcome, target in steps[name]:
            if target in graph and not graph.has_edge(name, target):
                graph.add_edge(name, target, outcome=outcome)
    return graph


def regions(names: Iterable[str], steps: SiblingSteps) -> list[list[str]]:
    """The strongly connected components, in the order of `names`, as their states are."""
    import networkx as nx

    graph = step_graph(names, steps)
    order = {name: number for number, name in enumerate(graph)}
    parts = nx.strongly_connected_components(graph)
    found = [sorted(part, key=order.__getitem__) for part in parts]
    return sorted(found, key=lambda part: order[part[0]])


def dead_ends(names: Iterable[str], steps: SiblingSteps) -> list[list[str]]:
    """The strongly connected components that no transition leaves."""
    ends = []
    for region in regions(names, steps):
        inside = frozenset(region)
        if all(target in inside for name in region for _, target in steps[name]):
            ends.append(region)
    return ends


Before = Mapping[str, "str | None"]
"""States with the one before each on a shortest path from a start, nearest first."""


def shortest_paths(graph: nx.DiGraph, start: str) -> Before:
    """The shortest paths from a state; none where there is no such state."""
    import networkx as nx

    if start not in graph:
        return {}
    return {start: None, **{name: last for last, name in nx.bfs_edges(graph, start)}}


def way(path: str, graph: nx.DiGraph, before: Before, goal: str) -> list[PathStep]:
    """A shortest path to a state of the container at a path; the state alone if there is none."""
    names = [goal]
    while (last := before.get(names[-1])) is not None:
        names.append(last)
    names = names[: MOST_STEPS + 1][::-1]
    steps = [entered(names[0], f"{path}/{names[0]}")]
    for name, following in pairwise(names):
        outcome = graph.edges[name, following]["outcome"]
        steps += [ended(outcome), entered(following, f"{path}/{following}")]
    return steps


def circle(path: str, region: Sequence[str], steps: SiblingSteps) -> list[PathStep]:
    """The shortest path from the first state of a region back to it; empty where there is none."""
    first = region[0]
    graph = step_graph(region, steps)
    before = shortest_paths(graph, first)
    last = next((name for name in before if graph.has_edge(name, first)), None)
    if last is None:
        return []
    outcome = graph.edges[last, first]["outcome"]
    there = way(path, graph, before, last)[-2 * MOST_STEPS + 1 :]
    return [*there, ended(outcome), entered(first, f"{path}/{first}")]


def unhandled(child: Node) -> list[Outcome]:
    """The outcomes of a state without a transition; none if a transition is for an unknown outcome,
    which can be meant for them."""
    handled = {step.outcome for step in child.transitions}
    left = [outcome for outcome in child.outcomes if outcome.name not in handled]
    return [] if left and unknown_outcomes(child) else left


Unhandled: TypeAlias = "Sequence[tuple[Node, Sequence[Outcome]]]"
"""The states of a container that have outcomes without a transition, with these."""


def unhandled_in(container: Linear) -> Unhandled:
    """The states of a container that have outcomes without a transition."""
    return tuple([(child, left) for child in container.children if (left := unhandled(child))])
