"""Whether a value can get from where it is written to where it is read, and is not replaced on the
way: what a rule asks before it complains of the two."""

from __future__ import annotations

from dataclasses import replace

from smachac.analysis.type_inference import Clash, Flow, Place
from smachac.ir import nodes
from smachac.ir.graph import START, edges
from smachac.ir.graph import Place as Stop
from smachac.ir.nodes import Leaf, Node
from smachac.ir.traversal import remapping
from smachac.ir.types import ANY

MOST_VISITS = 1_000_000
"""States looked at in one run; beyond them a value is taken to arrive."""

PREEMPTED = "preempted"


class Arrivals:
    """The searches of one run of the rules, with what they found and the edges they went along."""

    def __init__(self) -> None:
        self.visits = 0
        self.steps: dict[int, dict[Stop, list[tuple[Stop, str]]]] = {}
        self.children: dict[int, dict[str, Node]] = {}
        self.found: dict[tuple[int, str, str | None], tuple[Stop, ...] | None] = {}
        self.flows: dict[tuple[int, object], dict[Stop, Flow]] = {}

    def arrived(self, clash: Clash) -> Clash | None:
        """The clash, by a way that the value can come; None where it cannot be there."""
        seen: set[int] = set()
        todo: list[tuple[Flow, tuple[Flow, ...]]] = [(clash.flow, ())]
        while todo:
            flow, after = todo.pop()
            if id(flow) in seen:
                continue
            seen.add(id(flow))
            sources = self.sources(flow.place, after)
            alike = self.alike(flow)
            coming = [alike[stop] for stop in sources if stop in alike] if sources else []
            for each in coming if sources is not None else [flow]:
                if each.before is None:
                    return replace(clash, flow=_linked(each, after))
                todo.append((each.before, (each, *after)))
        return None

    def alike(self, flow: Flow) -> dict[Stop, Flow]:
        """The flows of one place that are of one type, by the stop they come from."""
        which = id(flow.place), flow.mark
        if which not in self.flows:
            every = flow.place.flows.get(flow.mark, [flow])
            self.flows[which] = {_stop(each): each for each in reversed(every)}
        return self.flows[which]

    def sources(self, place: Place, after: tuple[Flow, ...]) -> tuple[Stop, ...] | None:
        """From where the value can come that the next place takes; None for anywhere."""
        container = place.node
        linear = isinstance(container, nodes.StateMachine | nodes.Sequence)
        if not after or not linear or place.role != "scope" or place.declared != ANY:
            return None
        assert isinstance(container, nodes.StateMachine | nodes.Sequence)
        which = id(container), place.key, _child(place, after[0].place)
        if which not in self.found:
            spent = self.visits > MOST_VISITS
            self.found[which] = None if spent else self.search(container, *which[1:])
        return self.found[which]

    def search(self, container: nodes.Container, key: str, goal: str | None) -> tuple[Stop, ...]:
        """The children that may have been the last to write a key before a child reads it, or
        before the end (no goal); and the start, where none need be."""
        steps = self.steps_back(container)
        children = self.children[id(container)]
        todo: list[Stop] = [goal] if goal is not None else []
        todo += [stop for stop in steps if goal is None and isinstance(stop, tuple)]
        seen: set[Stop] = set(todo)
        sources: dict[Stop, None] = {}
        while todo:
            self.visits += 1
            for before, outcome in steps.get(todo.pop(), ()):
                if before == START or replaces(children[str(before)], key, outcome):
                    sources[before] = None
                elif before not in seen:
                    seen.add(before)
                    todo.append(before)
        return tuple(sources)

    def steps_back(self, container: nodes.Container) -> dict[Stop, list[tuple[Stop, str]]]:
        """For each stop of a container, the stops before it and their outcomes."""
        if id(container) not in self.steps:
            found: dict[Stop, list[tuple[Stop, str]]] = {}
            for edge in edges(container):
                found.setdefault(edge.target, []).append((edge.source, edge.outcome))
            self.steps[id(container)] = found
            self.children[id(container)] = {child.name: child for child in container.children}
        return self.steps[id(container)]


def _stop(flow: Flow) -> Stop:
    """The child that a value in a key of a container comes from, or the start."""
    if flow.before is None:
        return START
    return _child(flow.place, flow.before.place) or START


def _linked(flow: Flow, after: tuple[Flow, ...]) -> Flow:
    """The last of several flows, each with the one before it."""
    for each in after:
        flow = each if each.before is flow else replace(each, before=flow)
    return flow


def _child(place: Place, other: Place) -> str | None:
    """The child of a container's key that the other place belongs to, if it is inside."""
    inside = f"{place.path}/"
    return other.path[len(inside) :] if other.path.startswith(inside) else None


def replaces(child: Node, key: str, outcome: str) -> bool:
    """Whether a state that ends with an outcome has written a key of its container."""
    names = remapping(child)
    own = [output.name for output in child.outputs if names.get(output.name, output.name) == key]
    if outcome == child.catches and outcome:
        return False
    if not isinstance(child, Leaf):
        return bool(own)
    if child.open and not child.outputs:
        return True
    told = {name for _, names in child.writes for name in names}
    here = {name for ending, names in child.writes for name in names if ending == outcome}
    return any(name in here if name in told else outcome != PREEMPTED for name in own)
