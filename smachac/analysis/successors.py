"""Where control passes when a state ends: out of its containers, to the state that is next."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from smachac.analysis.outcome_rules import Study, UndecidedError, calm_spaces, space, study
from smachac.analysis.possible_outcomes import Endings, endings
from smachac.ir.graph import START, Place, edges, exit_place
from smachac.ir.nodes import Concurrence, Container, Leaf, Machine, Node
from smachac.ir.traversal import containers, outcome_names, walk

Step = tuple[str, str]
"""A state, by path, that is entered (no outcome) or ends with an outcome."""


class Arrival(NamedTuple):
    """Where an outcome leads in the end.

    `through` are the containers that end on the way, with their outcomes. `target` is the path of
    the state that is entered then, empty where the machine has ended.
    """

    through: tuple[Step, ...]
    target: str


Following = dict[str, dict[Step, None]]
"""What can follow a child at once, by its outcomes."""


@dataclass(slots=True)
class Routes:
    """The ways through a machine. Of two states with one path the first counts.

    `around` is the path of the container of each state.
    """

    machine: Machine
    nodes: dict[str, Node] = field(default_factory=dict)
    around: dict[str, str] = field(default_factory=dict)
    _following: dict[str, dict[str, Following]] = field(default_factory=dict)
    _endings: Endings | None = None

    def __post_init__(self) -> None:
        for path, node in walk(self.machine.root):
            self.nodes.setdefault(path, node)
        for path, container in containers(self.machine.root):
            for child in container.children:
                self.around.setdefault(f"{path}/{child.name}", path)

    def after(self, path: str, outcome: str) -> tuple[Step, ...]:
        """What can follow at once when a state ends with an outcome."""
        outer = self.around.get(path)
        if outer is None:
            return ()
        if outer not in self._following:
            self._following[outer] = self._of_container(outer)
        return tuple(self._following[outer].get(path, {}).get(outcome, ()))

    def _of_container(self, path: str) -> dict[str, Following]:
        container = self.nodes[path]
        assert not isinstance(container, Leaf)
        found: dict[str, Following] = {}
        for source, outcome, target in self._leaving(container):
            following = found.setdefault(f"{path}/{source}", {}).setdefault(outcome, {})
            following[_step(path, target)] = None
        return found

    def _leaving(self, container: Container) -> Iterator[tuple[str, str, Place]]:
        """What the outcomes of children lead to; in a concurrence, as far as that can come."""
        read = study(container) if isinstance(container, Concurrence) else None
        if read is None:
            for edge in edges(container):
                if isinstance(edge.source, str):
                    yield edge.source, edge.outcome, edge.target
            return
        if self._endings is None:
            self._endings = endings(self.machine)
        exits = outcome_names(container)
        for child in container.children:
            for outcome in outcome_names(child):
                for result in _results(read, self._endings, child.name, outcome):
                    if result in exits:
                        yield child.name, outcome, exit_place(result)

    def arrivals(self, path: str, outcome: str) -> list[Arrival]:
        """Where an outcome of a state can lead, through the ends of containers."""
        found: list[Arrival] = []
        through: dict[Step, tuple[Step, ...]] = {(path, outcome): ()}
        todo = deque(through)
        while todo:
            here = todo.popleft()
            if through[here] and here[0] == self.machine.root.name:
                found.append(Arrival(through[here], ""))
            for step in self.after(*here):
                if not step[1]:
                    found.append(Arrival(through[here], step[0]))
                elif step not in through:
                    through[step] = (*through[here], step)
                    todo.append(step)
        return found

    def follow(self, step: Step) -> Iterator[Step]:
        """What can follow a step: an entered container starts, a leaf ends."""
        path, outcome = step
        if outcome:
            yield from self.after(path, outcome)
            return
        node = self.nodes[path]
        if isinstance(node, Leaf):
            known = [*outcome_names(node), *(each.outcome for each in node.transitions)]
            yield from ((path, name) for name in dict.fromkeys(known))
            return
        yield from (_step(path, edge.target) for edge in edges(node) if edge.source == START)
        if node.catches:
            yield path, node.catches

    def ways(self) -> Mapping[Step, Step | None]:
        """Every step that the machine can come to, with the one before it on a shortest way."""
        start: Step = (self.machine.root.name, "")
        before: dict[Step, Step | None] = {start: None}
        todo: deque[Step] = deque([start])
        while todo:
            here = todo.popleft()
            for step in self.follow(here):
                if step not in before:
                    before[step] = here
                    todo.append(step)
        return before


def _step(path: str, target: Place) -> Step:
    """What an edge inside the container at a path leads to."""
    return (f"{path}/{target}", "") if isinstance(target, str) else (path, target[1])


def _results(read: Study, ends: Endings, child: str, outcome: str) -> Iterable[str]:
    """What a concurrence can end with when a child ends so and nobody stops the concurrence, or
    else at all; everything it says where that cannot be decided."""
    calm = [each for each, first in calm_spaces(read, *ends) if first in ("", child)]
    spaces = [each for each in calm if outcome in each[child]] or [space(read, ends.ever)]
    given = {child: outcome}
    found: dict[str, None] = {}
    try:
        for each in spaces:
            for number, rule in enumerate(read.written):
                both = {**given, **read.rules.conditions[number]}
                wanted = both[child] == outcome
                if wanted and read.rules.find(each, both, read.larger(number)) is not None:
                    found[rule.outcome] = None
            if read.rules.find(each, given, read.rules.all) is not None:
                found[read.node.default_outcome] = None
    except UndecidedError:
        found = {}
    return found or [*(rule.outcome for rule in read.written), read.node.default_outcome]


def path_to(ways: Mapping[Step, Step | None], last: Step) -> tuple[str, ...]:
    """The states on a shortest way to a step as they are entered, and in brackets the outcomes
    between them: those of leaves, where containers end with them."""
    steps: list[Step] = []
    here: Step | None = last
    while here is not None:
        steps.append(here)
        here = ways[here]
    found: list[str] = []
    for path, outcome in steps[-2::-1]:
        if not outcome:
            found.append(path.rpartition("/")[2])
        elif found and not found[-1].startswith("("):
            found.append(f"({outcome})")
    return tuple(found)
