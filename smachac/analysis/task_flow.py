"""Task flow of a container: the states of its ordinary task, and what can follow a state.

The ordinary task are the states that can run without a failure and without a request to stop. The
flow has the transitions that are taken while nothing fails: those of a failure only where the state
has no success. It ends at a decision after a stop: a state that leads to several places and runs
only after a stop, or only after failures and stops and waits for the outside world, as for an
operator.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Mapping
from collections.abc import Set as AbstractSet
from typing import NamedTuple, TypeAlias

from smachac.analysis.control_flow import Linear, children_names
from smachac.ir.nodes import Leaf, Node, Transition
from smachac.ir.outcome_names import fails, successes
from smachac.ir.traversal import leads_to_child
from smachac.records import dataclass

UnstoppedOutcomes = Callable[[Node], AbstractSet[str]]
"""The outcomes with which a child can end without a request to stop."""

Way = tuple[tuple[str, str], ...]
"""Outcomes, each with the state that it leads to."""

_Leads: TypeAlias = "list[tuple[str, str]]"


@dataclass(frozen=True, slots=True)
class TaskFlow:
    """`steps` are the outcomes and siblings that can follow each state, `exits` the outcomes of the
    container. `ordinary` are the states of the ordinary task. `unstopped_exits` are the outcomes of
    the container without a stop, also after failures."""

    steps: Mapping[str, _Leads]
    exits: Mapping[str, frozenset[str]]
    ordinary: frozenset[str]
    unstopped_exits: frozenset[str]


def task_flow(container: Linear, unstopped_outcomes: UnstoppedOutcomes) -> TaskFlow:
    """The task flow of a container. Linear in its size."""
    names = children_names(container)
    every: dict[str, _Leads] = {}
    sound: dict[str, _Leads] = {}
    steps: dict[str, _Leads] = {}
    exits: dict[str, frozenset[str]] = {}
    leaving: dict[str, frozenset[str]] = {}
    for child in container.children:
        possible = unstopped_outcomes(child)
        taken = [step for step in child.transitions if step.outcome in possible]
        every[child.name], leaving[child.name] = _parted(taken, names)
        good = [step for step in taken if not fails(child, step.outcome)]
        sound[child.name] = _parted(good or taken, names)[0]
        if not successes(child).isdisjoint(possible):
            taken = good
        steps[child.name], exits[child.name] = _parted(taken, names)
    ordinary = reached([container.initial], steps)
    faultless = reached([container.initial], sound)
    unstopped = reached([container.initial], every)
    for child in container.children:
        name = child.name
        several = len({target for _, target in steps[name]} | exits[name]) > 1
        asks = name not in faultless and isinstance(child, Leaf) and child.blocking
        if several and (name not in unstopped or (asks and not child.claims)):
            steps[name], exits[name] = [], frozenset()
    unstopped_exits = frozenset(end for name in unstopped for end in leaving.get(name, ()))
    return TaskFlow(steps, exits, ordinary, unstopped_exits)


def _parted(steps: Iterable[Transition], names: frozenset[str]) -> tuple[_Leads, frozenset[str]]:
    """The steps to siblings, and the targets of the others."""
    leads: _Leads = []
    exits: list[str] = []
    for step in steps:
        if leads_to_child(step, names):
            leads.append((step.outcome, step.target))
        else:
            exits.append(step.target)
    return leads, frozenset(exits)


def reached(starts: Iterable[str], steps: Mapping[str, _Leads]) -> frozenset[str]:
    """The states to which steps lead from some states, and these."""
    seen = {*starts}
    todo = list(seen)
    while todo:
        more = [target for _, target in steps.get(todo.pop(), ()) if target not in seen]
        seen.update(more)
        todo += more
    return frozenset(seen)


def way_between(flow: TaskFlow, start: str, goal: str, within: AbstractSet[str]) -> Way | None:
    """The shortest way from one state to another through some states, if there is one."""
    before: dict[str, tuple[str, str]] = {start: ("", "")}
    todo = deque([start])
    while todo and goal not in before:
        here = todo.popleft()
        for outcome, target in flow.steps.get(here, ()):
            if target in within and target not in before:
                before[target] = (outcome, here)
                todo.append(target)
    if goal not in before:
        return None
    found: list[tuple[str, str]] = []
    while goal != start:
        outcome, last = before[goal]
        found.append((outcome, goal))
        goal = last
    return tuple(reversed(found))


class Nearest(NamedTuple):
    """The next step of a shortest way to a goal; that of the goal itself is empty."""

    goal: str
    outcome: str = ""
    next: str = ""


def nearest(flow: TaskFlow, goals: Iterable[str]) -> Mapping[str, Nearest]:
    """The states from which one of the goals can be reached. Linear in the container."""
    leading: dict[str, _Leads] = {}
    for name, following in flow.steps.items():
        for outcome, target in following:
            leading.setdefault(target, []).append((outcome, name))
    found = {name: Nearest(name) for name in goals}
    todo = deque(found)
    while todo:
        here = todo.popleft()
        for outcome, name in leading.get(here, ()):
            if name not in found:
                found[name] = Nearest(found[here].goal, outcome, here)
                todo.append(name)
    return found


def way_along(steps: Mapping[str, Nearest], start: str, most: int) -> Way:
    """The first steps of the way from a state to its goal, at most so many."""
    found: list[tuple[str, str]] = []
    step = steps[start]
    while step.next and len(found) < most:
        found.append((step.outcome, step.next))
        step = steps[step.next]
    return tuple(found)
