"""Durations: the shortest time in which each state can end, as far as the script states times."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from heapq import heappop, heappush

from smachac.analysis.control_flow import Linear, children_names
from smachac.diagnostics.source import Span, assert_never
from smachac.ir import nodes
from smachac.ir.leaf import variable_of
from smachac.ir.nodes import Concurrence, Container, Data, Leaf, Node, is_number
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import leads_to_child, outcome_names

Ends = Mapping[str, float]
"""The outcomes that a state can end with, each with the seconds that it takes at least. A request
to stop does not count."""


def shortest_ends(containers: Sequence[tuple[str, Container]]) -> dict[str, Ends]:
    """The ends of all containers, by path. An open leaf can have more outcomes than are known."""
    found: dict[str, Ends] = {}
    for path, container in reversed(containers):
        ends = {child.name: ends_of(f"{path}/{child.name}", child, found)
                for child in container.children}  # fmt: skip
        found[path] = _container_ends(container, ends)
        if container.catches:
            found[path] = {**found[path], container.catches: 0.0}
    return found


def ends_of(path: str, node: Node, known: Mapping[str, Ends]) -> Ends:
    """The ends of the state at a path."""
    if not isinstance(node, Leaf):
        return known.get(path, {})
    seconds = duration(node)
    names = {*outcome_names(node), *(step.outcome for step in node.transitions)} - {PREEMPTED}
    return {name: seconds if name != node.catches else 0.0 for name in names}


def duration(leaf: Leaf) -> float:
    """The seconds that a leaf waits, if they stand in the script."""
    held = variable_of(leaf, "duration")
    return number(held.value.data) if held is not None else 0.0


def number(data: Data) -> float:
    """A number of the script; 0 for all else."""
    return float(data) if is_number(data) else 0.0


def _container_ends(container: Container, ends: Mapping[str, Ends]) -> Ends:
    match container:
        case nodes.StateMachine() | nodes.Sequence():
            return _linear_ends(container, ends)
        case Concurrence(sugar="timeout"):
            return _limited_ends(container, ends)
        case Concurrence():
            least = [min(end.values()) for end in ends.values() if end]
            whole = (max if container.join == "all" else min)(least, default=0.0)
            return dict.fromkeys(outcome_names(container), whole)
        case nodes.Iterator():
            return _iterator_ends(container, ends)
    return assert_never(container)


def _linear_ends(container: Linear, ends: Mapping[str, Ends]) -> Ends:
    """The shortest paths from the initial state to the outcomes."""
    names = children_names(container)
    states = {child.name: child for child in reversed(container.children)}
    found: dict[str, float] = {}
    done: set[str] = set()
    queue = [(0.0, container.initial)] if container.initial in names else []
    while queue:
        time, name = heappop(queue)
        if name in done:
            continue
        done.add(name)
        for step in states[name].transitions:
            if step.outcome not in ends[name]:
                continue
            later = time + ends[name][step.outcome]
            if leads_to_child(step, names):
                heappush(queue, (later, step.target))
            else:
                found[step.target] = min(later, found.get(step.target, later))
    return found


def _limited_ends(container: Concurrence, ends: Mapping[str, Ends]) -> Ends:
    """Those of the state under a time limit, and the limit."""
    limit = time_limit(container)
    own = {name: time for name, time in ends.get(container.name, {}).items() if time < limit}
    return {**own, container.default_outcome: limit}


def time_limit(container: Concurrence) -> float:
    """The seconds of a time limit."""
    timer = _timer(container)
    return duration(timer) if timer is not None else 0.0


def time_limit_span(container: Concurrence) -> Span:
    """The place of a time limit in the script."""
    timer = _timer(container)
    held = variable_of(timer, "duration") if timer is not None else None
    return held.value.span if held is not None else container.default_span


def _timer(container: Concurrence) -> Leaf | None:
    """The state that waits in a concurrence made of a time limit."""
    timers = (child for child in container.children if child.name != container.name)
    return next((timer for timer in timers if isinstance(timer, Leaf)), None)


def _iterator_ends(container: nodes.Iterator, ends: Mapping[str, Ends]) -> Ends:
    """An iterator that ends in its first item, and one that does all of them."""
    once = next(iter(ends.values()), {})
    renamed = dict(container.final_map)
    looping = [time for name, time in once.items() if name in container.loop_outcomes]
    items = container.items.data if container.items is not None else None
    count = len(items) if isinstance(items, tuple) else 0
    found: dict[str, float] = {}
    for end, time in _iterator_times(container, once, looping, count):
        name = renamed.get(end, end)
        found[name] = min(time, found.get(name, time))
    return found


def _iterator_times(
    container: nodes.Iterator, once: Ends, looping: Sequence[float], count: int
) -> Iterator[tuple[str, float]]:
    for name, time in once.items():
        if name not in container.loop_outcomes:
            yield name, time
    if looping or not count:
        yield container.exhausted_outcome, count * min(looping, default=0.0) + _pauses(container)


def _pauses(container: nodes.Iterator) -> float:
    """The pauses of a `retry:` with a delay; they are its items."""
    paused = any(
        isinstance(child, nodes.StateMachine) and child.sugar for child in container.children
    )
    items = container.items.data if container.items is not None else None
    if container.sugar != "retry" or not paused or not isinstance(items, tuple):
        return 0.0
    return sum(map(number, items))
