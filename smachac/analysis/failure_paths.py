"""Failure paths: where each failure leads, which state catches it, and how the machine ends."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Literal

from smachac.diagnostics.diagnostic import PathStep, ended, entered
from smachac.diagnostics.source import Span
from smachac.ir import nodes
from smachac.ir.graph import Event, is_unread
from smachac.ir.nodes import Concurrence, Leaf, Node
from smachac.ir.outcome_names import PREEMPTED, fails, successes
from smachac.ir.script_paths import PlainPaths, steps_in_script
from smachac.ir.traversal import outcome_names
from smachac.records import dataclass, field, replace

TYPE_CHECKING = False  # annotations only: few machines have routes
if TYPE_CHECKING:
    from smachac.analysis.successors import Arrival, Routes

Answer = Literal["caught", "repeated", "ignored", "not caught", "lost"]
"""What becomes of a failure: another state follows than after a success; the state, or one that
contains it, runs again; the same follows as after a success; the machine ends; there is no
transition."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Failure:
    """A state ends with an outcome of failure, and one way on from there.

    `path` is the state, `way` the states and outcomes that the failure passes, as in a witness
    path. `next` is the path of the state that is entered then, empty where there is none; both are
    paths of the script. `ends`
    are the outcomes that the machine can end with from there on, while nobody asks it to stop;
    `good`, those that mean success.
    """

    path: str
    outcome: str
    answer: Answer
    way: tuple[str, ...]
    next: str = ""
    ends: tuple[str, ...] = ()
    good: tuple[str, ...] = ()
    span: Span = field(compare=False, repr=False)


def starts_failure(node: Node, outcome: str) -> bool:
    """Whether an outcome begins a failure: that of a leaf, of exhausted tries or a time limit."""
    if outcome and outcome == node.catches:
        return True
    match node:
        case Leaf():
            return fails(node, outcome)
        case nodes.Iterator(sugar="retry"):
            return outcome == node.exhausted_outcome and fails(node, outcome)
        case Concurrence(sugar="timeout"):
            return outcome == node.default_outcome
    return False


def failures(
    states: Iterable[tuple[str, Node]], routes: Routes, plain: PlainPaths
) -> Iterator[Failure]:
    """Every failure that can begin, in the order of the script; one for each way that it takes.
    `plain` are the plain paths.

    A failure begins where a leaf ends with an outcome of failure (`fails`), tries are used
    up, or a time limit is over. Linear in the states, but for the depth of containers.
    """
    ends = _possible_ends(routes)
    for path, node in states:
        if node is not routes.nodes[path] or is_unread(node):
            continue
        for name in outcome_names(node):
            if starts_failure(node, name) and (path, name) in routes.before:
                for failure in _failures(routes, ends, path, node, name, plain):
                    next = plain.get(failure.next, failure.next)
                    yield replace(failure, path=plain.get(path, path), next=next)


def _failures(
    routes: Routes,
    ends: Mapping[Event, frozenset[str]],
    path: str,
    node: Node,
    name: str,
    plain: PlainPaths,
) -> Iterator[Failure]:
    root = routes.root
    order = outcome_names(root)
    good = successes(root)
    span = next((step.span for step in node.transitions if step.outcome == name), node.span)
    arrivals = routes.arrivals(path, name)
    good_ways = _after_success(routes, path, node)
    # In a concurrence a success leads wherever the failure of another branch does.
    same = len(good_ways) == 1 or good_ways == {
        (arrival.target, _final(arrival)) for arrival in arrivals
    }
    alike = good_ways if same else set[tuple[str, str]]()
    for arrival in arrivals:
        last: Event = (arrival.target, "") if arrival.target else arrival.through[-1]
        final = [end for end in order if end in ends.get(last, ())]
        yield Failure(
            path=path,
            outcome=name,
            answer=_answer(root, arrival, path, alike),
            way=_way(path, name, arrival, plain),
            next=arrival.target,
            ends=tuple(final),
            good=tuple(end for end in final if end in good),
            span=span,
        )
    if not arrivals:
        way = (plain.get(path, path).rpartition("/")[2], f"({name})")
        yield Failure(path=path, outcome=name, answer="lost", way=way, span=span)


def _answer(root: Node, arrival: Arrival, path: str, alike: set[tuple[str, str]]) -> Answer:
    if arrival.target and f"{path}/".startswith(f"{arrival.target}/"):
        return "repeated"
    final = _final(arrival)
    if (arrival.target, final) in alike and not fails(root, final):
        return "ignored"
    return "caught" if arrival.target else "not caught"


def _final(arrival: Arrival) -> str:
    """The outcome of the machine, if it ends."""
    return "" if arrival.target else arrival.through[-1][1]


def _after_success(routes: Routes, path: str, node: Node) -> set[tuple[str, str]]:
    """Where the successes of a state lead."""
    arrivals = (arrival for name in successes(node) for arrival in routes.arrivals(path, name))
    return {(arrival.target, _final(arrival)) for arrival in arrivals}


def _way(path: str, outcome: str, arrival: Arrival, plain: PlainPaths) -> tuple[str, ...]:
    """The states that a failure passes, in brackets how they end; last where it leads, which may
    be an outcome of the machine."""
    ends = [(path, outcome), *(arrival.through if arrival.target else arrival.through[:-1])]
    way: list[PathStep] = []
    for inner, name in ends:
        way += [entered(inner.rpartition("/")[2], inner), ended(name)]
    target = arrival.target
    way.append(entered(target.rpartition("/")[2] or _final(arrival), target or None))
    return tuple(label for _, label in steps_in_script(plain, way))


def _possible_ends(routes: Routes) -> dict[Event, frozenset[str]]:
    """The outcomes of the machine that each event can lead to without a preempt request."""
    import networkx as nx

    stopped = {(path, PREEMPTED) for path, node in routes.nodes.items() if isinstance(node, Leaf)}
    possible = nx.DiGraph(routes.graph.subgraph(routes.before.keys() - stopped))
    root = routes.root
    found: dict[Event, frozenset[str]] = {}
    for name in dict.fromkeys(outcome_names(root)):
        end = (root.name, name)
        for event in {end, *nx.ancestors(possible, end)} if end in possible else ():
            found[event] = found.get(event, frozenset()) | {name}
    return found
