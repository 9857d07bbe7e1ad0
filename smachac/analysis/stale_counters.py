"""Stale counters: counters of a loop that still have their last value when the loop runs again.

The initial values of a container are set once, and its userdata is kept from one entry to the next
(docs/semantics.md, Userdata). So a loop that begins again finds its counter at the limit, unless a
state sets it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from collections.abc import Set as AbstractSet
from functools import cached_property
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

from smachac.analysis.counters import Counters, Number, Test
from smachac.analysis.def_use import is_exit
from smachac.analysis.definite_assignment import DataFlow, UserdataScope
from smachac.analysis.fixpoint import KeyStep
from smachac.analysis.successors import Routes
from smachac.ir import nodes
from smachac.ir.graph import START, Event, Vertex
from smachac.ir.nodes import Leaf, Preset, Sequence, StateMachine, is_number
from smachac.ir.outcome_names import PREEMPTED, fails
from smachac.records import dataclass

if TYPE_CHECKING:
    import networkx as nx

MOST_VISITS = 300_000
"""The most visits of states in one machine; beyond them nothing more is found."""

MOST_LEVELS = 20
"""The most loops around a loop that are considered."""

MOST_PATHS = 20
"""The most findings with a path through the states around a container."""

MOST_ROUNDS = 10_000
"""The most rounds of a loop that are counted; beyond them nothing is known about its counter."""

Kind = Literal["spent", "endless", "fewer"]
"""What happens the second time: the loop ends in its first round; its test never ends it; it has
fewer rounds, because the count of the last time is not used up."""


class StaleCounter(NamedTuple):
    """A counter of the container at `path` that is not set back before its loop runs again.

    `counter` adds to the key of `preset`, and `test` compares it in order to end the loop, whose
    states are `loop`. `entry` is the state of the loop that is entered first. `before` is the state
    at which the loop around it begins, with which of its outcomes the loop is entered; None: the
    container runs again. `events` lead from the test to the test of the second time.
    """

    path: str
    container: StateMachine | Sequence
    preset: Preset
    counter: Leaf
    test: Leaf
    loop: tuple[str, ...]
    kind: Kind
    entry: str
    before: tuple[str, str] | None
    events: tuple[Event, ...]


def stale_counters(flow: DataFlow, routes: Callable[[], Routes]) -> Iterator[StaleCounter]:
    """The stale counters of a machine, in the order of the script.

    Only what is certain counts: a counter is a number to which one state adds a constant, and the
    test compares it with constants. A state that may set the key to another value ends a search.
    """
    entries = _Entries(routes)
    counters, visits = Counters(flow), _Visits()
    for scope in flow.scopes.values():
        container = scope.container
        if not isinstance(container, StateMachine | Sequence) or not container.userdata:
            continue
        presets = {
            preset.key: preset
            for preset in container.userdata
            if is_number(preset.value.data) and preset.key not in scope.inputs
        }
        loops: _Loops | None = None
        for key in presets:
            for counter, added, test in counters.tests(scope, key):
                loops = loops or _Loops(scope)
                search = _Search(loops, key, counter, test, visits)
                found = search.found(flow, presets[key], added, entries)
                if visits.number > MOST_VISITS:
                    return
                if found is not None:
                    yield found


@dataclass
class _Visits:
    """The visits of states in the searches of one machine."""

    number: int = 0


class _Loop(NamedTuple):
    """States of a container that can all be reached from each other, with the states through which
    they are entered. A loop with one such state contains the loops that do not need it."""

    states: AbstractSet[str]
    first: AbstractSet[Vertex]
    around: _Loop | None


class _Loops:
    """The loops of a container, without the steps after a request to stop or an exception."""

    def __init__(self, scope: UserdataScope) -> None:
        import networkx as nx

        self.scope = scope
        self.steps = {vertex: [*self._steps(vertex)] for vertex in scope.vertices}
        self.graph = nx.DiGraph()
        for vertex, steps in self.steps.items():
            self.graph.add_edges_from((vertex, step.target) for step in steps)
        self.innermost: dict[str, _Loop] = {}
        self._find(self.graph, None, MOST_LEVELS)

    def _steps(self, vertex: Vertex) -> Iterator[KeyStep]:
        child = self.scope.children.get(vertex) if isinstance(vertex, str) else None
        for step in self.scope.steps.get(vertex, ()):
            if child is None or (step.outcome != PREEMPTED and step.outcome != child.catches):
                yield step

    def _find(self, graph: nx.DiGraph, around: _Loop | None, levels: int) -> None:
        """Enter the loops in a part of the graph, outer ones before inner ones."""
        import networkx as nx

        for states in list(nx.strongly_connected_components(graph)):
            name = next(iter(states))
            if len(states) == 1 and not self.graph.has_edge(name, name):
                continue
            first = {to for to in states for last in self.graph.pred[to] if last not in states}
            loop = _Loop(states, first, around)
            self.innermost.update(dict.fromkeys(states, loop))
            if len(first) == 1 and levels:
                self._find(graph.subgraph(states - first), loop, levels - 1)

    def of(self, one: str, other: str) -> _Loop | None:
        """The innermost loop of two states."""
        loop = self.innermost.get(one)
        while loop is not None and other not in loop.states:
            loop = loop.around
        return loop


_Reached: TypeAlias = "dict[Vertex, tuple[Vertex, str, bool]]"
"""Vertices that a search reached, each with the vertex before it, its outcome, and whether the
search began there."""

_Starts: TypeAlias = "list[tuple[Vertex, KeyStep]]"


class _Search:
    """The loop of a counter and its test, and the paths on which the counter keeps its value."""

    def __init__(
        self,
        loops: _Loops,
        key: str,
        counter: Leaf,
        test: Test,
        visits: _Visits,
    ) -> None:
        self.scope = loops.scope
        self.key = key
        self.counter = counter
        self.test = test
        self.visits = visits
        self.steps = loops.steps
        found = loops.of(counter.name, test.leaf.name)
        self.loop = found.states if found is not None else frozenset[str]()
        self.first = found.first if found is not None else frozenset[Vertex]()
        self.headers: list[Vertex] = []
        around = found.around if found is not None else None
        while around is not None:
            self.headers += around.first
            around = around.around

    def keeps(self, vertex: Vertex, step: KeyStep) -> bool:
        """Whether the counter has the value of before after a step, or has been counted on."""
        writes = step.writes
        return vertex == self.counter.name or not (writes.anything or self.key in writes.perhaps)

    def reached(self, starts: _Starts, goal: Vertex = "", avoid: Vertex = "") -> _Reached:
        """The vertices to which the counter's value comes after some steps, nearest first, up to
        the goal."""
        found: _Reached = {}
        todo = [(vertex, step, True) for vertex, step in starts]
        for vertex, step, first in todo:
            here = step.target
            if self.keeps(vertex, step) and here not in found and here != avoid:
                found[here] = (vertex, step.outcome, first)
                if here == goal:
                    break
                todo += [(here, step, False) for step in self.steps[here]]
        self.visits.number += len(todo)
        return found

    def steps_from(self, vertex: Vertex) -> _Starts:
        return [(vertex, step) for step in self.steps[vertex]]

    def found(
        self, flow: DataFlow, preset: Preset, added: Number, entries: _Entries
    ) -> StaleCounter | None:
        """The stale counter, if the counter is one."""
        value = preset.value.data
        ends = self._ending(value, added) if self.loop and is_number(value) else None
        if ends is None:
            return None
        kind, outcome = ends
        name = self.test.leaf.name
        retried = self._retried()
        ways: list[tuple[Kind, _Starts, Vertex]] = []
        if retried or name not in self.first:
            last = [step for step in self.steps_from(name) if step[1].outcome == outcome]
            for header in (*self.headers, START):
                ways.append((kind, last, header))
        if kind == "spent" and self._only_counts():
            ways.append(("fewer", retried, START))
        repeated = self.scope.path in flow.repeated
        for kind, starts, header in ways:
            events = self._again(starts, header, entries) if repeated or header != START else None
            if events is not None:
                return self._stale(preset, kind, header, events)
        return None

    def _stale(
        self, preset: Preset, kind: Kind, header: Vertex, events: tuple[Event, ...]
    ) -> StaleCounter:
        """The stale counter whose loop begins again at `header`."""
        container = self.scope.container
        assert isinstance(container, StateMachine | Sequence)
        entry, before = self._way_in(header)
        return StaleCounter(
            path=self.scope.path,
            container=container,
            preset=preset,
            counter=self.counter,
            test=self.test.leaf,
            loop=tuple(sorted(self.loop)),
            kind=kind,
            entry=entry,
            before=before,
            events=events,
        )

    def _ending(self, value: Number, added: Number) -> tuple[Kind, str] | None:
        """How the loop ends the second time, and the outcome of the test that ended it the first
        time; None if the loop has one round or does not end, or if it begins anew."""
        steps = self.steps[self.test.leaf.name]
        stays = {step.outcome for step in steps if step.target in self.loop}
        decide = self.test.decide
        if not {decide(value), decide(value + added)} <= stays:
            return None
        for _ in range(MOST_ROUNDS):
            value += added
            outcome = decide(value)
            if outcome not in stays:
                break
        else:
            return None
        if decide(value + added) not in stays:
            return "spent", outcome
        far = max((abs(limit) for limit in self.test.limits), default=0) + abs(value) + abs(added)
        endless = decide(far if added > 0 else -far) in stays
        return ("endless", outcome) if endless and self._counts_first() else None

    def _counts_first(self) -> bool:
        """Whether each path to the test counts first."""
        name = self.test.leaf.name
        return name not in self.reached(self.steps_from(START), name, self.counter.name)

    def _retried(self) -> _Starts:
        """The steps with which a state leaves the loop that repeats it after a failure."""
        found: _Starts = []
        for name in sorted(self.loop):
            child = self.scope.children[name]
            inside = [step for step in self.steps[name] if step.target in self.loop]
            if child is not self.test.leaf and any(fails(child, step.outcome) for step in inside):
                out = (step for step in self.steps[name] if step.target not in self.loop)
                found += [(name, step) for step in out if not fails(child, step.outcome)]
        return found

    def _only_counts(self) -> bool:
        """Whether only the counter and its test use the key."""
        return (
            self.key not in self.scope.outputs
            and len({use.path for use in self.scope.uses.readers(self.key)}) == 2
        )

    def _again(
        self, starts: _Starts, header: Vertex, entries: _Entries
    ) -> tuple[Event, ...] | None:
        """A path from steps out of the loop to the place where it begins again, and on to the test,
        on which the counter keeps its value; None if there is none."""
        name, path = self.test.leaf.name, self.scope.path
        back = self.reached(self.steps_from(header), name)
        if not starts or name not in back:
            return None
        out = self.reached(starts, header)
        there = (*self._way(back, name), self._event(name))
        if header in out:
            return (*self._way(out, header), *there)
        for vertex in out if header == START else ():
            between = entries.between((path, vertex[1]), (path, "")) if is_exit(vertex) else None
            if between is not None:
                return (*self._way(out, vertex), *between, *there)
        return None

    def _event(self, name: Vertex, outcome: str = "") -> Event:
        return f"{self.scope.path}/{name}", outcome

    def _way(self, found: _Reached, goal: Vertex) -> tuple[Event, ...]:
        """The events on the path to a vertex that a search found, without the vertex itself."""
        events: list[Event] = []
        first = False
        while not first:
            goal, outcome, first = found[goal]
            if goal != START:
                events += [self._event(goal, outcome), self._event(goal)]
        return tuple(events[::-1])

    def _way_in(self, header: Vertex) -> tuple[str, tuple[str, str] | None]:
        """The state before which the counter is to be set, and the state before it with its
        outcome; None: it is the first state of the container."""
        back = self.reached(self.steps_from(header), self.test.leaf.name)
        if header == START:
            return str(next(iter(back))), None
        entry = next(str(vertex) for vertex in back if vertex in self.loop)
        before, outcome, _ = back[entry]
        return entry, (str(before), outcome)


class _Entries:
    """The ends of containers after which they can be entered again."""

    def __init__(self, routes: Callable[[], Routes]) -> None:
        self._routes = routes
        self._shown = 0

    @cached_property
    def _graph(self) -> nx.DiGraph:
        """The events of the machine, without the loop of an iterator with one item."""
        routes = self._routes()
        graph = routes.graph
        once = [
            ((f"{path}/{child.name}", outcome), (f"{path}/{child.name}", ""))
            for path, node in routes.nodes.items()
            if isinstance(node, nodes.Iterator) and _has_one_item(node)
            for child in node.children
            for outcome in node.loop_outcomes
        ]
        if once:
            graph = graph.copy()
            graph.remove_edges_from(once)
        return graph

    @cached_property
    def _parts(self) -> dict[Event, int]:
        """The strongly connected components of the events."""
        import networkx as nx

        parts = nx.strongly_connected_components(self._graph)
        return {event: number for number, part in enumerate(parts) for event in part}

    def between(self, end: Event, entry: Event) -> tuple[Event, ...] | None:
        """The events after the end of a container up to its next entry; none are given beyond
        the first paths. None if it is not entered again."""
        import networkx as nx

        if end not in self._parts or self._parts[end] != self._parts.get(entry):
            return None
        self._shown += 1
        if self._shown > MOST_PATHS:
            return ()
        return tuple(nx.shortest_path(self._graph, end, entry)[1:])


def _has_one_item(node: nodes.Iterator) -> bool:
    items = node.items
    return items is not None and isinstance(items.data, tuple) and len(items.data) < 2
