"""The control flow of a whole machine: which event can follow which, through all containers."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property, partial
from typing import NamedTuple

from smachac.analysis.outcome_rules import (
    SoundConcurrence,
    UndecidedError,
    sound_concurrence,
    space,
    unstopped_spaces,
)
from smachac.analysis.possible_outcomes import Endings
from smachac.diagnostics.diagnostic import PathStep, ended, entered
from smachac.ir.graph import START, Edge, Event, edges, exit_vertex, machine_graph
from smachac.ir.nodes import Concurrence, Container, Node
from smachac.ir.script_paths import NO_SUGAR, PlainPaths, steps_in_script
from smachac.ir.traversal import outcome_names


class Arrival(NamedTuple):
    """Where an outcome leads in the end.

    `through` are the containers that end on the way, with their outcomes. `target` is the path of
    the state that is entered then, empty where the machine has ended.
    """

    through: tuple[Event, ...]
    target: str


class Routes:
    """The control flow of a whole machine: which event can follow which.

    `root` is the machine itself; `nodes` are its states by path. Of two states with one path the
    first counts. In a concurrence, an end of a child leads to the results that can come of it.
    """

    def __init__(self, states: Sequence[tuple[str, Node]], known: Endings) -> None:
        self.root = states[0][1]
        self.nodes = dict(reversed(states))
        self.graph = machine_graph(states, partial(_possible_edges, known))

    @cached_property
    def before(self) -> Mapping[Event, Event | None]:
        """Every event that can come, nearest first, with the one before it on a shortest path."""
        import networkx as nx

        start: Event = (self.root.name, "")
        return {start: None, **{event: last for last, event in nx.bfs_edges(self.graph, start)}}

    def after(self, event: Event) -> Iterable[Event]:
        """The events that can follow one at once."""
        return self.graph.adj.get(event, ())  # type: ignore[no-any-return]

    def arrivals(self, path: str, outcome: str) -> list[Arrival]:
        """Where an outcome of a state can lead, through the ends of containers."""
        # networkx 3.0 does not export it at its top.
        from networkx.algorithms.traversal.breadth_first_search import generic_bfs_edges

        start: Event = (path, outcome)
        through: dict[Event, tuple[Event, ...]] = {start: ()}
        for last, event in generic_bfs_edges(self.graph, start, self._ends_after):
            through[event] = (*through[last], event)
        found: list[Arrival] = []
        for here, ends in through.items():
            if ends and here[0] == self.root.name:
                found.append(Arrival(ends, ""))
            targets = (event[0] for event in self.after(here) if not event[1])
            found += (Arrival(ends, target) for target in targets)
        return found

    def _ends_after(self, event: Event) -> Iterator[Event]:
        """The ends of containers that can follow an event at once."""
        return (pair for pair in self.after(event) if pair[1])


def _possible_edges(known: Endings, path: str, container: Container) -> Iterator[Edge]:
    """The edges of a container; those of a concurrence as far as they can be taken."""
    concurrence = sound_concurrence(path, container) if isinstance(container, Concurrence) else None
    if concurrence is None:
        yield from edges(container)
        return
    exits = outcome_names(container)
    for child in container.children:
        yield Edge(START, child.name, "", "enter")
        for outcome in outcome_names(child):
            for result in _results(concurrence, known, child.name, outcome):
                if result in exits:
                    yield Edge(child.name, exit_vertex(result), outcome, "rule")


def _results(
    concurrence: SoundConcurrence, ends: Endings, child: str, outcome: str
) -> Iterable[str]:
    """The results of a concurrence that are possible when a child ends with an outcome: without a
    preempt request, else with one; all results where that cannot be decided."""
    unstopped = [
        entry for entry, first in unstopped_spaces(concurrence, *ends) if first in ("", child)
    ]
    spaces = [entry for entry in unstopped if outcome in entry[child]] or [
        space(concurrence, ends.ever)
    ]
    given = {child: outcome}
    found: dict[str, None] = {}
    try:
        for entry in spaces:
            for number, rule in enumerate(concurrence.written):
                both = {**given, **concurrence.rules.conditions[number]}
                wanted = both[child] == outcome
                if (
                    wanted
                    and concurrence.rules.find(entry, both, concurrence.larger(number)) is not None
                ):
                    found[rule.outcome] = None
            if concurrence.rules.find(entry, given, concurrence.rules.all) is not None:
                found[concurrence.node.default_outcome] = None
    except UndecidedError:
        found = {}
    return found or [
        *(rule.outcome for rule in concurrence.written),
        concurrence.node.default_outcome,
    ]


def path_to(
    before: Mapping[Event, Event | None], last: Event, plain: PlainPaths = NO_SUGAR
) -> tuple[str, ...]:
    """A shortest path to an event: the states that are entered, by their names in the script, and
    in brackets the outcomes between them. Where containers end together with a leaf, the outcome is
    that of the leaf, with its time limit and tries. `plain` are the plain paths."""
    events: list[Event] = []
    here: Event | None = last
    while here is not None:
        events.append(here)
        here = before[here]
    found: list[PathStep] = []
    ending = ""  # the plain path of the state whose outcome is the last step
    for path, outcome in events[-2::-1]:
        if path in plain.added:
            continue
        if not outcome:
            found.append(entered(path.rpartition("/")[2], path))
            continue
        state = plain.get(path, path)
        if found and found[-1].is_outcome and state == ending:
            found[-1] = ended(outcome)
        elif found and not found[-1].is_outcome:
            found.append(ended(outcome))
            ending = state
    return tuple(label for _, label in steps_in_script(plain, found))
