"""Ways through one container: its regions, and the shortest path that shows a fault."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from smachac.checks.outline import Linear, children_names
from smachac.ir.graph import can_end, reachable
from smachac.ir.walk import leads_to_child

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
