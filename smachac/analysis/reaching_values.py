"""Reaching definitions: the written values that can arrive at a read."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from smachac.analysis.null_guards import excludes_null
from smachac.analysis.type_inference import Cell, Clash, TypeFlow
from smachac.analysis.type_lattice import Misfit, MisfitKind
from smachac.ir import nodes
from smachac.ir.graph import START, Vertex, edges
from smachac.ir.nodes import Leaf, Node, StateMachine
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import outputs_to
from smachac.ir.types import ANY
from smachac.records import replace

MOST_VISITS = 1_000_000
"""States looked at in one run; beyond them a value is taken to arrive."""


def reaching_clashes(clashes: Iterable[Clash]) -> dict[MisfitKind, list[Clash]]:
    """The clashes whose value can be there when it is read, by kind."""
    searches = _Searches()
    found: dict[MisfitKind, list[Clash]] = {"type": [], "length": [], "unit": []}
    for clash in clashes:
        reaching = searches.reaching(clash)
        if reaching is not None:
            found[clash.misfit.kind].append(reaching)
    return found


class Read(NamedTuple):
    """A child of the container at `path` reads a key of the container."""

    path: str
    container: StateMachine | nodes.Sequence
    key: str
    child: str


def last_writers(reads: Iterable[Read]) -> Iterator[tuple[Read, tuple[Vertex, ...]]]:
    """For each read the children that may have been the last to write the key before it; with the
    start, if none of them need be."""
    searches = _Searches()
    for read in reads:
        if searches.visits <= MOST_VISITS:
            yield read, searches.search(read.container, read.path, read.key, read.child)


def reaching_flows(flows: Iterable[TypeFlow]) -> list[TypeFlow]:
    """The flows of literals whose value can be there when it is read."""
    searches = _Searches()
    found = []
    for flow in flows:
        here = Misfit("type", flow.type, flow.cell.declared)
        clash = searches.reaching(Clash(flow=flow, cell=flow.cell, misfit=here))
        found += [clash.flow] if clash is not None else []
    return found


class _Searches:
    """The searches over the containers of one machine, and their results."""

    def __init__(self) -> None:
        self.visits = 0
        self.steps: dict[str, dict[Vertex, list[tuple[Vertex, str]]]] = {}
        self.children: dict[str, dict[str, Node]] = {}
        self.found: dict[tuple[str, str, str | None], tuple[Vertex, ...] | None] = {}
        self.flows: dict[tuple[Cell, object], dict[Vertex, TypeFlow]] = {}
        self.guarded: dict[tuple[str, str, str | None], bool] = {}

    def reaching(self, clash: Clash) -> Clash | None:
        """The clash, with flows that can happen; None where the value cannot arrive."""
        nullable = _is_nullable(clash)
        seen: set[TypeFlow] = set()
        todo: list[tuple[TypeFlow, tuple[TypeFlow, ...]]] = [(clash.flow, ())]
        while todo:
            flow, after = todo.pop()
            if flow in seen:
                continue
            seen.add(flow)
            if nullable and after and self.is_guarded(flow.cell, after[0].cell):
                continue
            sources = self.sources(flow.cell, after)
            alike = self.alike(flow)
            coming = [alike[vertex] for vertex in sources if vertex in alike] if sources else []
            for other in coming if sources is not None else [flow]:
                if other.before is None:
                    return replace(clash, flow=_linked(other, after))
                todo.append((other.before, (other, *after)))
        return None

    def alike(self, flow: TypeFlow) -> dict[Vertex, TypeFlow]:
        """The flows of one cell with one mark, by the vertex they come from."""
        which = flow.cell, flow.mark
        if which not in self.flows:
            every = flow.cell.flows.get(flow.mark, [flow])
            self.flows[which] = {_stop(flow): flow for flow in reversed(every)}
        return self.flows[which]

    def sources(self, cell: Cell, after: tuple[TypeFlow, ...]) -> tuple[Vertex, ...] | None:
        """The vertices from which a value that flows into the next cell can come; None for any."""
        container = cell.node
        linear = isinstance(container, nodes.StateMachine | nodes.Sequence)
        if not after or not linear or cell.role != "scope" or cell.declared != ANY:
            return None
        assert isinstance(container, nodes.StateMachine | nodes.Sequence)
        which = cell.path, cell.key, _child(cell, after[0].cell)
        if which not in self.found:
            spent = self.visits > MOST_VISITS
            self.found[which] = None if spent else self.search(container, *which)
        return self.found[which]

    def search(
        self, container: nodes.Container, path: str, key: str, goal: str | None
    ) -> tuple[Vertex, ...]:
        """The children that may have been the last to write a key before a child reads it, or
        before the end (no goal); and the start, where none need be."""
        # By hand: all searches in a container share `steps_back`. networkx needs a graph for each
        # key and takes 8.9 ms instead of 6.6 ms for 1,000 states and 87 ms instead of 63 ms for
        # 10,000, that is 2 % of a check with one fault, 30 % with ten; its import adds 128 ms to a
        # check of 10 states, which takes 211 ms (python bench/searches.py).
        steps = self.steps_back(path, container)
        children = self.children[path]
        todo: list[Vertex] = [goal] if goal is not None else []
        todo += [vertex for vertex in steps if goal is None and isinstance(vertex, tuple)]
        seen: set[Vertex] = set(todo)
        sources: dict[Vertex, None] = {}
        while todo:
            self.visits += 1
            for before, outcome in steps.get(todo.pop(), ()):
                if before == START or replaces(children[str(before)], key, outcome):
                    sources[before] = None
                elif before not in seen:
                    seen.add(before)
                    todo.append(before)
        return tuple(sources)

    def is_guarded(self, cell: Cell, reader: Cell) -> bool:
        """Whether a null in a key of a container cannot arrive at a child: on every path the value
        has been compared with None, or replaced by one that cannot be null."""
        container = cell.node
        if cell.role != "scope" or not isinstance(container, nodes.StateMachine | nodes.Sequence):
            return False
        which = cell.path, cell.key, _child(cell, reader)
        if which not in self.guarded:
            spent = self.visits > MOST_VISITS
            self.guarded[which] = not spent and self.search_guards(container, *which)
        return self.guarded[which]

    def search_guards(
        self, container: nodes.Container, path: str, key: str, goal: str | None
    ) -> bool:
        """Whether every path from the start to a child excludes a null, and there is a path."""
        steps = self.steps_back(path, container)
        children = self.children[path]
        todo: list[Vertex] = [goal] if goal is not None else []
        seen: set[Vertex] = set(todo)
        guarded = False
        while todo:
            self.visits += 1
            for before, outcome in steps.get(todo.pop(), ()):
                if before == START:
                    return False
                child = children[str(before)]
                if replaces(child, key, outcome):
                    if _may_write_null(child, key):
                        return False
                    guarded = True
                elif excludes_null(child, key, outcome):
                    guarded = True
                elif before not in seen:
                    seen.add(before)
                    todo.append(before)
        return guarded

    def steps_back(
        self, path: str, container: nodes.Container
    ) -> dict[Vertex, list[tuple[Vertex, str]]]:
        """For each vertex of a container, the stops before it and their outcomes."""
        if path not in self.steps:
            found: dict[Vertex, list[tuple[Vertex, str]]] = {}
            for edge in edges(container):
                found.setdefault(edge.target, []).append((edge.source, edge.outcome))
            self.steps[path] = found
            self.children[path] = {child.name: child for child in container.children}
        return self.steps[path]


def _stop(flow: TypeFlow) -> Vertex:
    """The child that a value in a cell of a container comes from, or the start."""
    if flow.before is None:
        return START
    return _child(flow.cell, flow.before.cell) or START


def _is_nullable(clash: Clash) -> bool:
    """Whether a value clashes because it may be null where the reader needs one that is not."""
    return clash.misfit.given.name in ("optional", "none") and clash.flow.type.name in (
        "optional",
        "none",
    )


def _may_write_null(child: Node, key: str) -> bool:
    """Whether an output of a state that is the key of its container is declared as nullable."""
    return any(output.type.name == "optional" for output in outputs_to(child, key))


def _linked(flow: TypeFlow, after: tuple[TypeFlow, ...]) -> TypeFlow:
    """The last of several flows, each with the one before it."""
    for other in after:
        flow = other if other.before is flow else replace(other, before=flow, first=flow.origin)
    return flow


def _child(cell: Cell, other: Cell) -> str | None:
    """The child of a container's key that the other cell belongs to, if it is inside."""
    inside = f"{cell.path}/"
    return other.path[len(inside) :] if other.path.startswith(inside) else None


def replaces(child: Node, key: str, outcome: str) -> bool:
    """Whether a state that ends with an outcome has written a key of its container."""
    own = [output.name for output in outputs_to(child, key)]
    if outcome == child.catches and outcome:
        return False
    if not isinstance(child, Leaf):
        return bool(own)
    if child.open and not child.outputs:
        return True
    listed = {name for _, names in child.writes for name in names}
    here = {name for ending, names in child.writes for name in names if ending == outcome}
    return any(name in here if name in listed else outcome != PREEMPTED for name in own)
