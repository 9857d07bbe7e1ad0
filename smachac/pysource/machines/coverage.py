"""How much of the machines in a Python file is known exactly."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from smachac.diagnostics.source import Span
from smachac.ir.nodes import Leaf, Node
from smachac.ir.traversal import walk
from smachac.pysource.machines.graph import ELSEWHERE, Graph

SEVERAL = "one of several states comes next"
NOT_ALL = "not all of this container is known"


class UnknownPlace(NamedTuple):
    """A place in the code at which something of a machine is not known, and why."""

    span: Span
    reason: str


class Coverage(NamedTuple):
    """The number of states in the machines of a Python file, how many of them are known exactly,
    and the places of the others. A container in another one is a state too; a place that adds an
    unknown number of states counts as one."""

    states: int
    exact: int
    unknown: tuple[UnknownPlace, ...]


def coverage_of(graphs: Sequence[Graph]) -> Coverage:
    """The coverage of some machines. A state that several of them have is one state."""
    places: dict[Span, str] = {}
    states: dict[tuple[Span, str], None] = {}
    for graph in graphs:
        for span, reason in _places(graph):
            places.setdefault(span, reason)
        for _, node in walk(graph.machine.root):
            if node is not graph.machine.root and not _is_made(node):
                states.setdefault((node.span, node.name))
    exact = sum(span not in places for span, _ in states)
    others = len(places.keys() - {span for span, _ in states})
    unknown = (UnknownPlace(span, reason) for span, reason in places.items())
    return Coverage(len(states) + others, exact, tuple(unknown))


def unknown_states(graph: Graph) -> Mapping[str, str]:
    """The states of a machine that are not known exactly, by path, each with the reason. Those that
    stand for what is not known are among them."""
    reasons = dict(reversed(graph.coverage.unknown))
    found: dict[str, str] = {}
    for path, node in walk(graph.machine.root):
        if _is_unknown(node):
            found[path] = NOT_ALL if node.name == ELSEWHERE else SEVERAL
        elif node is not graph.machine.root and node.span in reasons:
            found[path] = reasons[node.span]
    return found


def _places(graph: Graph) -> Iterator[tuple[Span, str]]:
    """The places at which something of a machine is not known."""
    yield from graph.coverage.unknown
    made = [node for _, node in walk(graph.machine.root) if _is_unknown(node)]
    yield from ((node.span, SEVERAL) for node in made if node.name != ELSEWHERE)
    if not graph.coverage.unknown:  # else they name what is not known of the container
        yield from ((node.span, NOT_ALL) for node in made if node.name == ELSEWHERE)


def _is_made(node: Node) -> bool:
    """Whether `graph.py` has made a state: for the unknown part of a container, for a target that
    is one of several, or for the function that selects the outcome of a concurrence."""
    return isinstance(node, Leaf) and node.synthetic


def _is_unknown(node: Node) -> bool:
    """Whether a state was added for a part of the machine that is not known."""
    return isinstance(node, Leaf) and node.synthetic and node.type == ELSEWHERE
