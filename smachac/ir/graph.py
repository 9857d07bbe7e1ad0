"""Containers and machines as graphs: which state can follow which, and on what.

`edges` is the one reading of a container's control flow; graphs and searches are made from it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

from smachac.diagnostics.source import assert_never
from smachac.ir import nodes
from smachac.ir.nodes import Concurrence, Container, Leaf, Machine, Node, Transition
from smachac.ir.traversal import containers, leads_to_child, outcome_names

if TYPE_CHECKING:
    import networkx as nx

Place: TypeAlias = "str | tuple[str, ...]"
"""A child by its name, `START`, or an exit `("outcome", name)`."""

START: Place = ("start",)

Kind = Literal[
    "enter",
    "written",
    "implicit",
    "connector",
    "rule",
    "default",
    "loop",
    "exhausted",
    "break",
    "caught",
]
"""Why control passes: the container starts; a transition (its origin); a rule of a concurrence or
its default; an iterator goes on, has no more items, or is ended by its child; an exception ends the
container."""


class Edge(NamedTuple):
    """Control passes from one place of a container to another.

    `outcome` is that of the child it leaves, empty for `START`. `transition` is the edge of the
    machine, where one stands behind it.
    """

    source: Place
    target: Place
    outcome: str
    kind: Kind
    transition: Transition | None = None


def exit_place(outcome: str) -> Place:
    """The place that stands for leaving the container with an outcome."""
    return ("outcome", outcome)


def edges(container: Container) -> Iterator[Edge]:
    """Every edge inside a container that can be taken, in the order of the script.

    A child's edge counts only for an outcome that the child declares; an open leaf may have any.
    Edges to nowhere are left out.
    """
    match container:
        case nodes.StateMachine() | nodes.Sequence():
            yield from _transition_edges(container)
        case Concurrence():
            yield from _concurrence_edges(container)
        case nodes.Iterator():
            yield from _iterator_edges(container)
        case _:
            assert_never(container)


def caught_edges(container: Container) -> Iterator[Edge]:
    """How a container is left when something in it raises an exception that it catches.

    Not among `edges`: no state leads there, and nothing is handed out.
    """
    if container.catches:
        yield Edge(START, exit_place(container.catches), container.catches, "caught")


def _live_transitions(child: Node) -> Sequence[Transition]:
    if _is_open(child):
        return child.transitions
    declared = {outcome.name for outcome in child.outcomes}
    return [step for step in child.transitions if step.outcome in declared]


def _is_open(child: Node) -> bool:
    return isinstance(child, Leaf) and child.open


def is_unread(child: Node) -> bool:
    """Whether a state stands for one that could not be read: it may go anywhere."""
    return isinstance(child, Leaf) and child.open and not child.type


def _transition_edges(container: nodes.StateMachine | nodes.Sequence) -> Iterator[Edge]:
    names = frozenset(child.name for child in container.children)
    exits = frozenset(outcome_names(container))
    if container.initial in names:
        yield Edge(START, container.initial, "", "enter")
    for child in container.children:
        for step in _live_transitions(child):
            if leads_to_child(step, names):
                yield Edge(child.name, step.target, step.outcome, step.origin, step)
            elif step.target in exits:
                target = exit_place(step.target)
                yield Edge(child.name, target, step.outcome, step.origin, step)


def _concurrence_edges(container: Concurrence) -> Iterator[Edge]:
    exits = frozenset(outcome_names(container))
    wanted: dict[str, dict[tuple[str, str], None]] = {}
    for rule in container.rules:
        for condition in rule.when:
            pairs = wanted.setdefault(condition.child, {})
            pairs[condition.outcome, rule.outcome] = None
    for child in container.children:
        yield Edge(START, child.name, "", "enter")
        declared = outcome_names(child)
        for outcome, result in wanted.get(child.name, {}):
            if result in exits and (_is_open(child) or outcome in declared):
                yield Edge(child.name, exit_place(result), outcome, "rule")
        if container.default_outcome in exits:
            outcomes = declared or (("",) if _is_open(child) else ())
            for outcome in outcomes:
                yield Edge(child.name, exit_place(container.default_outcome), outcome, "default")


def _iterator_edges(container: nodes.Iterator) -> Iterator[Edge]:
    exits = frozenset(outcome_names(container))
    renamed = dict(container.final_map)
    looping = frozenset(container.loop_outcomes)
    exhausted = renamed.get(container.exhausted_outcome, container.exhausted_outcome)
    for child in container.children:
        yield Edge(START, child.name, "", "enter")
        for outcome in _possible_outcomes(container, child):
            if outcome in looping:
                yield Edge(child.name, child.name, outcome, "loop")
                if exhausted in exits:
                    yield Edge(child.name, exit_place(exhausted), outcome, "exhausted")
            elif renamed.get(outcome, outcome) in exits:
                target = exit_place(renamed.get(outcome, outcome))
                yield Edge(child.name, target, outcome, "break")
    if exhausted in exits and not _surely_has_items(container):
        yield Edge(START, exit_place(exhausted), "", "exhausted")


def stopped_endings(container: nodes.Iterator) -> dict[str, str]:
    """How an iterator ends that is asked to stop (smach-semantics P9): the looping outcomes of its
    child, and the outcomes of the iterator that come of them then. Not among `edges`."""
    renamed = dict(container.final_map)
    own = {name for child in container.children[:1] for name in outcome_names(child)}
    return {name: renamed.get(name, name) for name in container.loop_outcomes if name in own}


def _possible_outcomes(container: nodes.Iterator, child: Node) -> Iterable[str]:
    if not _is_open(child):
        return outcome_names(child)
    mapped = (first for first, _ in container.final_map)
    known = (*outcome_names(child), *container.loop_outcomes, *mapped, *outcome_names(container))
    return dict.fromkeys(known)


def _surely_has_items(container: nodes.Iterator) -> bool:
    items = container.items
    return items is not None and isinstance(items.data, tuple) and bool(items.data)


def reachable(container: Container) -> frozenset[str]:
    """The children that can be entered.

    An initial state that does not exist hides nothing, nor does a state that could not be read.
    Linear in the size of the container.
    """
    names = [child.name for child in container.children]
    if not isinstance(container, (nodes.StateMachine, nodes.Sequence)):
        return frozenset(names)
    if container.initial not in names:
        return frozenset(names)
    followers: dict[Place, list[Place]] = {}
    for edge in edges(container):
        followers.setdefault(edge.source, []).append(edge.target)
    found = _children_from([START], followers)
    unread = any(child.name in found and is_unread(child) for child in container.children)
    return frozenset(names) if unread else found


def can_end(container: Container) -> frozenset[str]:
    """The children from which the container can be left.

    What has a fault of its own counts as a way out, so that one fault is not reported twice: a
    transition to nowhere, an outcome without a transition. Linear in the size of the container.
    """
    if not isinstance(container, (nodes.StateMachine, nodes.Sequence)):
        ending = (child for child in container.children if child.outcomes or _is_open(child))
        return frozenset(child.name for child in ending)
    names = frozenset(child.name for child in container.children)
    before: dict[Place, list[Place]] = {}
    leaving: list[Place] = []
    for child in container.children:
        steps = _live_transitions(child)
        handled = {step.outcome for step in steps}
        loose = any(outcome.name not in handled for outcome in child.outcomes)
        if loose or (_is_open(child) and not steps):
            leaving.append(child.name)
        for step in steps:
            if leads_to_child(step, names):
                before.setdefault(step.target, []).append(child.name)
            else:
                leaving.append(child.name)
    return _children_from(leaving, before)


def _children_from(places: list[Place], follow: dict[Place, list[Place]]) -> frozenset[str]:
    seen = set(places)
    todo = list(places)
    while todo:
        for place in follow.get(todo.pop(), ()):
            if place not in seen:
                seen.add(place)
                todo.append(place)
    return frozenset(place for place in seen if isinstance(place, str))


def container_graph(container: Container) -> nx.MultiDiGraph:
    """One container: its children, `START` and an exit for each outcome it declares.

    Every edge carries the `Edge` it stands for, as the attribute `edge`; `kind` and `outcome`
    are given beside it. Children carry `node`.
    """
    import networkx as nx

    graph = nx.MultiDiGraph()
    graph.add_node(START)
    for child in container.children:
        graph.add_node(child.name, node=child)
    graph.add_nodes_from(map(exit_place, outcome_names(container)))
    for edge in chain(edges(container), caught_edges(container)):
        graph.add_edge(edge.source, edge.target, edge=edge, kind=edge.kind, outcome=edge.outcome)
    return graph


def flat_graph(machine: Machine) -> nx.MultiDiGraph:
    """The whole machine: a path stands for being entered, `("outcome", path, name)` for a
    container that ends so.

    Leaves are left from their path, containers from their ends, so that walks through the graph
    keep outcome and transition together. Edges are labelled as in `container_graph`; entering
    a container is an edge of kind "enter".
    """
    import networkx as nx

    graph = nx.MultiDiGraph()
    graph.add_node(machine.root.name, node=machine.root)
    for path, container in containers(machine.root):
        inside = {child.name: child for child in container.children}
        for name, child in inside.items():
            graph.add_node(f"{path}/{name}", node=child)
        graph.add_nodes_from(("outcome", path, name) for name in outcome_names(container))
        for edge in chain(edges(container), caught_edges(container)):
            source = _flat_source(edge, path, inside)
            target = _flat_target(edge.target, path)
            graph.add_edge(source, target, edge=edge, kind=edge.kind, outcome=edge.outcome)
    return graph


def _flat_source(edge: Edge, path: str, inside: dict[str, Node]) -> Place:
    if not isinstance(edge.source, str):
        return path
    here = f"{path}/{edge.source}"
    is_leaf = isinstance(inside[edge.source], Leaf)
    return here if is_leaf else ("outcome", here, edge.outcome)


def _flat_target(target: Place, path: str) -> Place:
    if isinstance(target, str):
        return f"{path}/{target}"
    return ("outcome", path, target[1])
