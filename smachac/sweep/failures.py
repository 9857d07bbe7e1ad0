"""Failed runs by the state that failed first.

The states of a failed run end in an order. One of these ends is the first from which the graph
leads to no success any more: the turning point. The failures that come directly before it led to
it, so the earliest of them is the state that failed first.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import NamedTuple

from smachac.ir import graph
from smachac.ir.nodes import Leaf, Machine
from smachac.ir.outcome_names import fails
from smachac.ir.traversal import walk
from smachac.ir.written import WrittenState, written
from smachac.records import dataclass, field
from smachac.sweep.task import Run
from smachac.sweep.variation import Single

BEFORE = 2
"""The ends of states before the first failure that are shown."""

AFTER = 4
"""The ends of states after the turning point that are shown."""


class Step(NamedTuple):
    """The end of a state as it was written: its path and outcome, which is empty for an exception,
    and the badge that the outcome belongs to, in words."""

    path: str
    outcome: str
    badge: str = ""


@dataclass(slots=True, kw_only=True)
class Group:
    """Failures with the same first failure and the same way to the turning point.

    `steps` are those of its first run: `steps[first]` failed first, `steps[turning]` is the turning
    point. `left_out` is the number of steps that follow the last one.
    """

    outcome: str | None
    error: str
    steps: Sequence[Step]
    first: int
    turning: int
    left_out: int = 0
    runs: list[tuple[int, Mapping[str, Single]]] = field(default_factory=list)


class Failures:
    """The failed runs, in groups."""

    def __init__(self, machine: Machine, successes: Collection[str]) -> None:
        self._view = written(machine)
        self._hopeful = _events_before(machine, successes)
        self._groups: dict[tuple[object, ...], Group] = {}

    def add(self, run: Run) -> None:
        """Add a failed run."""
        ends = list(self._ends(run.steps))
        steps = [step for _, step in ends]
        first, turning = self._places(ends)
        error = run.error.partition("\n")[0]
        key = (run.outcome, error, *steps[first : turning + 1])
        group = self._groups.get(key)
        if group is None:
            begin, end = max(0, first - BEFORE), turning + 1 + AFTER
            group = self._groups[key] = Group(
                outcome=run.outcome,
                error=error,
                steps=steps[begin:end],
                first=first - begin,
                turning=turning - begin,
                left_out=max(0, len(steps) - end),
            )
        group.runs.append((run.seed, run.values))

    def groups(self) -> list[Group]:
        """The groups, the most frequent first."""
        return sorted(self._groups.values(), key=lambda group: (-len(group.runs), group.runs[0][0]))

    def _ends(self, ends: Sequence[tuple[str, str]]) -> Iterator[tuple[graph.Event, Step]]:
        """The ends of a run with their steps. An exception that became an outcome is that one."""
        last = {self._view.state(full): place for place, (full, _) in enumerate(ends)}
        for place, (full, outcome) in enumerate(ends):
            path = self._view.state(full)
            state = self._view.states.get(path)
            if state is None or (not outcome and last[path] != place):
                continue
            if outcome and not (self._view.is_whole(full) and is_step(state)):
                continue
            field_ = state.field_of(outcome) if outcome else None
            badge = next((badge.text for badge in state.badges if badge.field == field_), "")
            yield (full, outcome), Step(path, outcome, badge)

    def _places(self, ends: Sequence[tuple[graph.Event, Step]]) -> tuple[int, int]:
        """The places of the first failure and of the turning point among the ends."""
        if not ends:
            return 0, 0
        failed = [place for place, (_, step) in enumerate(ends) if self._failed(step)]
        lost = [
            place
            for place, (event, step) in enumerate(ends)
            if not step.outcome or event not in self._hopeful
        ]
        turning = ((lost[:1] if self._hopeful else failed[-1:]) or [len(ends) - 1])[0]
        first = turning
        while first > 0 and self._failed(ends[first - 1][1]):
            first -= 1
        return first, turning

    def _failed(self, step: Step) -> bool:
        return not step.outcome or fails(self._view.states[step.path].outer, step.outcome)


def is_step(state: WrittenState) -> bool:
    """Whether the ends of a state are steps of a run: a state without states inside, or one that
    can end in another way than the states inside."""
    return isinstance(state.node, Leaf) or bool(state.badges)


def _events_before(machine: Machine, successes: Collection[str]) -> frozenset[graph.Event]:
    """The ends of states, full path and outcome, from which the graph leads to a success."""
    import networkx as nx

    root = machine.root
    events = graph.machine_graph(walk(root), lambda _, node: graph.edges(node))
    found: set[graph.Event] = set()
    for outcome in successes:
        end = (root.name, outcome)
        if end in events:
            found |= {end, *nx.ancestors(events, end)}
    return frozenset(found)
