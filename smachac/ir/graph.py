"""Control-flow graphs of containers and of whole machines.

`edges` defines the control flow of a container; the graphs and searches are made from it.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from collections.abc import Set as AbstractSet
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

from smachac.diagnostics.source import assert_never
from smachac.ir import nodes
from smachac.ir.nodes import Concurrence, Container, Leaf, Node, Transition
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import ends_preempted, leads_to_child, outcome_names

if TYPE_CHECKING:
    import networkx as nx

Vertex: TypeAlias = "str | tuple[str, ...]"
"""A child by its name, `START`, or an exit `("outcome", name)`."""

START: Vertex = ("start",)

EdgeKind = Literal[
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

    source: Vertex
    target: Vertex
    outcome: str
    kind: EdgeKind
    transition: Transition | None = None


def exit_vertex(outcome: str) -> Vertex:
    """The vertex of the end of a container with an outcome."""
    return ("outcome", outcome)


def edges(container: Container) -> Iterator[Edge]:
    """Every edge inside a container that can be taken, in the order of the script.

    A child's edge counts only for an outcome that the child declares; an open leaf may have any.
    Edges to nowhere are left out.
    """
    match container:
        case nodes.StateMachine() | nodes.Sequence():
            return _transition_edges(container)
        case Concurrence():
            return _concurrence_edges(container)
        case nodes.Iterator():
            return _iterator_edges(container)
    return assert_never(container)


def _live_transitions(child: Node) -> Sequence[Transition]:
    declared = {outcome.name for outcome in child.outcomes}
    live = [step for step in child.transitions if step.outcome in declared]
    return (
        child.transitions
        if len(live) < len(child.transitions) and _has_no_interface(child)
        else live
    )


def _has_no_interface(child: Node) -> bool:
    return isinstance(child, Leaf) and child.open and not child.any_key


def is_unread(child: Node) -> bool:
    """Whether a state could not be read: its outcomes are unknown, and so are its targets."""
    return isinstance(child, Leaf) and child.open and not child.type


def _targets_inside(child: Node, names: frozenset[str]) -> list[str]:
    """The states of its container, which have these names, to which a child can lead."""
    declared = None if _has_no_interface(child) else {outcome.name for outcome in child.outcomes}
    return [  # `leads_to_child` in place, as every check of a state comes here
        step.target
        for step in child.transitions
        if step.target in names
        and step.origin != "implicit"
        and (declared is None or step.outcome in declared)
    ]


def _transition_edges(container: nodes.StateMachine | nodes.Sequence) -> Iterator[Edge]:
    if any(child.name == container.initial for child in container.children):
        yield Edge(START, container.initial, "", "enter")
    for child, steps in transitions(container):
        for target, step in steps:
            yield Edge(child.name, target, step.outcome, step.origin, step)


def transitions(
    container: nodes.StateMachine | nodes.Sequence, known: Collection[str] = ()
) -> Iterator[tuple[Node, list[tuple[Vertex, Transition]]]]:
    """The transitions of each state of a container that can be taken, with the vertices that they
    lead to; none of the states whose names are in `known`."""
    names = frozenset([child.name for child in container.children])
    exits = {outcome.name: exit_vertex(outcome.name) for outcome in container.outcomes}
    for child in container.children:
        steps: list[tuple[Vertex, Transition]] = []
        for step in () if child.name in known else _live_transitions(child):
            if step.target in names and step.origin != "implicit":  # `leads_to_child`
                steps.append((step.target, step))
            elif step.target in exits:
                steps.append((exits[step.target], step))
        yield child, steps


def _concurrence_edges(container: Concurrence) -> Iterator[Edge]:
    exits = frozenset(outcome_names(container))
    wanted: dict[str, dict[tuple[str, str], None]] = {}
    for rule in container.rules:
        for condition in rule.when:
            pairs = wanted.setdefault(condition.child, {})
            pairs[condition.outcome, rule.outcome] = None
    unconditional = dict.fromkeys(rule.outcome for rule in container.rules if not rule.when)
    for child in container.children:
        yield Edge(START, child.name, "", "enter")
        declared = outcome_names(child)
        for outcome, result in wanted.get(child.name, {}):
            if result in exits and (_has_no_interface(child) or outcome in declared):
                yield Edge(child.name, exit_vertex(result), outcome, "rule")
        outcomes = declared or (("",) if _has_no_interface(child) else ())
        for result in unconditional:
            if result in exits:
                yield from (
                    Edge(child.name, exit_vertex(result), name, "rule") for name in outcomes
                )
        if container.default_outcome in exits:
            for outcome in outcomes:
                yield Edge(child.name, exit_vertex(container.default_outcome), outcome, "default")


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
                    yield Edge(child.name, exit_vertex(exhausted), outcome, "exhausted")
            elif renamed.get(outcome, outcome) in exits:
                target = exit_vertex(renamed.get(outcome, outcome))
                yield Edge(child.name, target, outcome, "break")
    if exhausted in exits and not _surely_has_items(container):
        yield Edge(START, exit_vertex(exhausted), "", "exhausted")


def stopped_endings(container: nodes.Iterator) -> dict[str, str]:
    """The outcomes of an iterator after a request to stop, by the outcome of its child: those that
    are not among `edges`. After a looping outcome it ends too; a retry or a loop of a script always
    ends as `preempted` (docs/semantics.md, Iterator and Preemption)."""
    own = {name: None for child in container.children[:1] for name in outcome_names(child)}
    if ends_preempted(container):
        return dict.fromkeys(own, PREEMPTED)
    renamed = dict(container.final_map)
    return {name: renamed.get(name, name) for name in container.loop_outcomes if name in own}


def _possible_outcomes(container: nodes.Iterator, child: Node) -> Iterable[str]:
    if not _has_no_interface(child):
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
    # By hand, because every check comes here: networkx takes as long for 10,000 states (60 ms of
    # CPU time), but its import adds 130 ms to a check of a short script, which takes 310 ms.
    names = frozenset([child.name for child in container.children])
    if not isinstance(container, (nodes.StateMachine, nodes.Sequence)):
        return names
    if container.initial not in names:
        return names
    found = {container.initial}
    waiting: dict[str, list[Node]] = {}  # not entered yet; two states can have one name (SM106)
    for child in container.children:
        if child.name not in found:
            waiting.setdefault(child.name, []).append(child)
            continue
        entered = [child]
        while entered:
            state = entered.pop()
            if is_unread(state):
                return names
            for target in _targets_inside(state, names):
                if target not in found:
                    found.add(target)
                    entered += waiting.pop(target, ())
    return frozenset(found)


def can_end(container: Container) -> frozenset[str]:
    """The children from which the container can be left.

    What has a fault of its own counts as a way out, so that one fault is not reported twice: a
    transition to nowhere, an outcome without a transition. Linear in the size of the container.
    """
    if not isinstance(container, (nodes.StateMachine, nodes.Sequence)):
        ending = (
            child for child in container.children if child.outcomes or _has_no_interface(child)
        )
        return frozenset(child.name for child in ending)
    names = frozenset([child.name for child in container.children])
    found: set[str] = set()
    waiting: dict[str, list[str]] = {}  # by the name of a state, those that lead to it
    for child in reversed(container.children):  # most transitions lead to later states
        if not _leads_on(child, names, found):
            for target in _targets_inside(child, names):
                waiting.setdefault(target, []).append(child.name)
            continue
        ended = [child.name]
        while ended:
            name = ended.pop()
            if name not in found:
                found.add(name)
                ended += waiting.pop(name, ())
    return frozenset(found)


def _leads_on(child: Node, names: frozenset[str], ending: AbstractSet[str]) -> bool:
    """Whether a child leads out of its container, to nowhere, or to one of the states `ending`;
    `names` are those of all states."""
    steps = _live_transitions(child)
    for step in steps:
        if step.target in ending or not leads_to_child(step, names):
            return True
    if _has_no_interface(child):
        return not steps
    return not {step.outcome for step in steps}.issuperset(outcome_names(child))


Event: TypeAlias = "tuple[str, str]"
"""The state at a path is entered (no outcome), or ends with an outcome."""


def machine_graph(
    states: Iterable[tuple[str, Node]],
    edges_of: Callable[[str, Container], Iterable[Edge]],
) -> nx.DiGraph:
    """The whole machine as a graph of events; its nodes are of type `Event`.

    A leaf leads from its entry to each of its ends, a container from its entry to the entries of
    the children that it starts. The end of a child leads on as `edges_of` the container at its
    path says. Of two states with one path the first counts.
    """
    import networkx as nx

    graph = nx.DiGraph()
    known: set[str] = set()
    for path, node in states:
        start = (path, "")
        if path in known:
            continue
        known.add(path)
        graph.add_node(start)
        if isinstance(node, Leaf):
            names = [*outcome_names(node), *(step.outcome for step in node.transitions)]
            graph.add_edges_from((start, (path, name)) for name in names)
            continue
        for edge in edges_of(path, node):
            if edge.source == START:
                graph.add_edge(start, _event(path, edge.target))
            elif edge.outcome:
                graph.add_edge((f"{path}/{edge.source}", edge.outcome), _event(path, edge.target))
        if node.catches:
            graph.add_edge(start, (path, node.catches))
    return graph


def _event(path: str, target: Vertex) -> Event:
    """What an edge inside the container at a path leads to."""
    return (f"{path}/{target}", "") if isinstance(target, str) else (path, target[1])
