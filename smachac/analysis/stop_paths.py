"""Stop paths: where the machine continues after a state has answered a request to stop.

A state answers with its outcome `preempted`; the transition of that outcome leads on. Containers
end as docs/semantics.md (Preemption, Iterator) defines it.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from collections.abc import Set as AbstractSet
from functools import partial
from typing import NamedTuple

from smachac.analysis.control_flow import (
    MOST_STEPS,
    Linear,
    children_names,
    outline,
    regions,
    stuck_states,
)
from smachac.analysis.outcome_rules import Space
from smachac.analysis.possible_outcomes import Endings, Judged, results
from smachac.analysis.task_flow import (
    TaskFlow,
    Way,
    nearest,
    reached,
    task_flow,
    way_along,
    way_between,
)
from smachac.diagnostics.source import assert_never
from smachac.ir import nodes
from smachac.ir.graph import START, edges, stopped_endings
from smachac.ir.nodes import Concurrence, Container, Leaf, Node, StateMachine, Transition
from smachac.ir.outcome_names import GOOD, PREEMPTED, fails, successes
from smachac.ir.traversal import outcome_names
from smachac.records import dataclass, field

MOST_VISITS = 1_000_000
"""Limit on the states that the search for ways back visits in one container. After it, a finding
has no witness path."""

Answers = Mapping[str, Node]
"""The outcomes of a state after a request to stop was answered in it, each with the state that
answered."""


class StopStep(NamedTuple):
    """A transition after an answer: `child` of the container at `path` answered, or it ended
    because `origin` in it did."""

    path: str
    container: Linear
    child: Node
    step: Transition
    origin: Node

    def is_like_a_failure(self) -> bool:
        """Whether a failure of the child leads to the same place."""
        same = (one for one in self.child.transitions if one.target == self.step.target)
        return any(fails(self.child, one.outcome) for one in same)


class Resumed(NamedTuple):
    """The machine continues after `stop`: `way` are the steps from its target on. `end` is the
    success with which the container then ends; `mover`, the state that holds a resource."""

    stop: StopStep
    way: Way = ()
    end: str = ""
    mover: Node | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class StopPaths:
    """The continuations of a machine after a stop, at most one for each transition.

    `again`: the state that answered starts again. `moving`: a state of the ordinary task that holds
    a resource starts. `praised`: the container ends with a success with which it also ends without
    a stop. `answers` are by path of a container; so is `only`, those outcomes that need a stop.
    """

    again: list[Resumed] = field(default_factory=list)
    moving: list[Resumed] = field(default_factory=list)
    praised: list[Resumed] = field(default_factory=list)
    answers: dict[str, Answers] = field(default_factory=dict)
    only: dict[str, frozenset[str]] = field(default_factory=dict)

    def answers_of(self, path: str, node: Node) -> Answers:
        """The answers of the state at a path."""
        if not isinstance(node, Leaf):
            return self.answers.get(path, {})
        return {PREEMPTED: node} if PREEMPTED in outcome_names(node) else {}

    def unstopped_outcomes(self, path: str, node: Node) -> frozenset[str]:
        """The outcomes with which the state at a path can end without a request to stop."""
        names = frozenset(outcome_names(node))
        if isinstance(node, Leaf):
            return (names | {step.outcome for step in node.transitions}) - {PREEMPTED}
        return names - self.only.get(path, frozenset())


def stop_paths(
    containers: Sequence[tuple[str, Container]],
    judged: Mapping[str, Judged],
    endless: AbstractSet[str],
    holds: Callable[[str], bool],
) -> StopPaths:
    """The stop paths of a machine. `holds`: whether the state at a path holds a resource."""
    found = StopPaths()
    for path, container in reversed(containers):
        match container:
            case _ if container.sugar:
                ends = {name: container for name in outcome_names(container) if name == PREEMPTED}
                found.answers[path], found.only[path] = ends, frozenset(ends)
            case nodes.StateMachine() | nodes.Sequence():
                _linear(path, container, found, endless, holds)
            case nodes.Iterator():
                _iterator(path, container, found)
            case Concurrence():
                if path in judged:
                    _concurrence(path, judged[path], found)
            case _:
                assert_never(container)
    return found


def _linear(
    path: str,
    container: Linear,
    found: StopPaths,
    endless: AbstractSet[str],
    holds: Callable[[str], bool],
) -> None:
    names = children_names(container)
    exits = frozenset(outcome_names(container))
    onward: list[StopStep] = []
    leaving: list[StopStep] = []
    unstopped: set[str] = set()
    for child in container.children:
        answers: Answers = {PREEMPTED: child}
        only: Collection[str] = answers
        if not isinstance(child, Leaf):
            here = f"{path}/{child.name}"
            answers, only = found.answers.get(here, {}), found.only.get(here, ())
        for step in child.transitions:
            beside = step.target in names and step.origin != "implicit"  # `leads_to_child`
            if step.outcome in answers:
                stop = StopStep(path, container, child, step, answers[step.outcome])
                (onward if beside else leaving).append(stop)
            if not beside and step.outcome not in only:
                unstopped.add(step.target)
    ends: dict[str, Node] = {}
    if onward:
        flow = task_flow(container, partial(_unstopped_outcomes, found, path))
        unstopped = {*flow.unstopped_exits}
        ends = _continued(onward, flow, found, endless, holds)
    good = task_successes(container) & unstopped
    for stop in leaving:
        if stop.step.outcome in task_successes(stop.child):
            continue
        if stop.step.target in good:
            found.praised.append(Resumed(stop, end=stop.step.target))
        elif stop.step.target in exits:
            ends.setdefault(stop.step.target, stop.origin)
    _keep(found, path, container, ends, unstopped)


def _keep(
    found: StopPaths, path: str, node: Node, ends: Answers, unstopped: AbstractSet[str]
) -> None:
    """Keep the outcomes that a container can have after a stop. An outcome that it also has when
    nothing fails is left out: then the stop has been taken for a step of the task inside."""
    kept = {
        name: origin for name, origin in ends.items() if name not in unstopped or fails(node, name)
    }
    if kept:
        found.answers[path] = kept
        found.only[path] = frozenset(kept) - unstopped


def _unstopped_outcomes(found: StopPaths, path: str, child: Node) -> frozenset[str]:
    return found.unstopped_outcomes(f"{path}/{child.name}", child)


def task_successes(node: Node) -> frozenset[str]:
    """The outcomes of a container that mean success: `done` and the like also where the container
    has the outcome `preempted`."""
    names = outcome_names(node)
    found = successes(node)
    if PREEMPTED in names:
        found |= {name for name in names if name.lower() in GOOD}
    return found


def _continued(
    onward: Sequence[StopStep],
    flow: TaskFlow,
    found: StopPaths,
    endless: AbstractSet[str],
    holds: Callable[[str], bool],
) -> dict[str, Node]:
    """Judge the answers that lead to a sibling. The outcomes with which the container can end
    after those in which no fault was found."""
    path, container = onward[0].path, onward[0].container
    again = _starting_again(onward, flow)
    trapped = _trapped(path, container, endless) if again else frozenset[str]()
    moving = nearest(flow, (name for name in flow.ordinary if holds(f"{path}/{name}")))
    good = task_successes(container) & flow.unstopped_exits
    to_good = nearest(flow, (name for name, ends in flow.exits.items() if ends & good))
    to_others = nearest(flow, (name for name, ends in flow.exits.items() if ends - good))
    children = {child.name: child for child in container.children}
    clean: list[StopStep] = []
    for number, stop in enumerate(onward):
        target = stop.step.target
        if stop.child.name in trapped:
            continue
        if number in again:
            found.again.append(Resumed(stop, again[number]))
        elif stop.is_like_a_failure():
            clean.append(stop)
        elif target in moving:
            way, goal = way_along(moving, target, MOST_STEPS), moving[target].goal
            found.moving.append(Resumed(stop, way, mover=children[goal]))
        elif stop.step.outcome in task_successes(stop.child):
            continue
        elif target in to_good and target not in to_others:
            way, goal = way_along(to_good, target, MOST_STEPS), to_good[target].goal
            found.praised.append(Resumed(stop, way, end=min(flow.exits[goal] & good)))
        else:
            clean.append(stop)
    return _ends_after(clean, flow)


def _trapped(path: str, container: Linear, endless: AbstractSet[str]) -> frozenset[str]:
    """The states that SM202 reports."""
    if isinstance(container, StateMachine) and container.forever:
        return frozenset()
    return frozenset(stuck_states(outline(path, container, endless)))


def _starting_again(onward: Sequence[StopStep], flow: TaskFlow) -> dict[int, Way]:
    """The answers after which the state that answered starts again, with the ways to it."""
    answering = {stop.child.name for stop in onward}
    if answering.isdisjoint(reached((stop.step.target for stop in onward), flow.steps)):
        return {}
    steps = {name: [*following] for name, following in flow.steps.items()}
    for stop in onward:
        steps[stop.child.name].append((stop.step.outcome, stop.step.target))
    parts = [frozenset(part) for part in regions(steps, steps)]
    around = {name: part for part in parts for name in part}
    found: dict[int, Way] = {}
    visits = 0
    for number, stop in enumerate(onward):
        child, target = stop.child.name, stop.step.target
        if target not in around[child]:
            continue
        visits += len(around[child])
        way = way_between(flow, target, child, around[child]) if visits <= MOST_VISITS else ()
        if way is not None:
            found[number] = way
    return found


def _ends_after(stops: Sequence[StopStep], flow: TaskFlow) -> dict[str, Node]:
    """The outcomes of the container that the flow leads to after some answers."""
    origins: dict[str, Node] = {}
    for stop in stops:
        origins.setdefault(stop.step.target, stop.origin)
    ends: dict[str, Node] = {}
    todo = list(origins)
    while todo:
        here = todo.pop()
        for name in flow.exits.get(here, ()):
            ends.setdefault(name, origins[here])
        for _, target in flow.steps.get(here, ()):
            if target not in origins:
                origins[target] = origins[here]
                todo.append(target)
    return ends


def _iterator(path: str, container: nodes.Iterator, found: StopPaths) -> None:
    child = next(iter(container.children), None)
    if child is None:
        return
    here = f"{path}/{child.name}"
    renamed = dict(container.final_map)
    declared = outcome_names(container)
    ends = {
        renamed.get(name, name): origin for name, origin in found.answers_of(here, child).items()
    }
    if not ends:
        looping = stopped_endings(container).items()
        ends = {end: container for name, end in looping if not fails(child, name)}
    unstopped = found.unstopped_outcomes(here, child)
    ways = [edge for edge in edges(container) if edge.source == START or edge.outcome in unstopped]
    also = {edge.target[1] for edge in ways if isinstance(edge.target, tuple)}
    _keep(found, path, container, {name: ends[name] for name in declared if name in ends}, also)


def _concurrence(path: str, each: Judged, found: StopPaths) -> None:
    node = each.concurrence.node
    space = stopped_space(each, found)
    if not space:
        return
    ends = results(node, each.concurrence, [space])
    unstopped = results(node, each.concurrence, [unstopped for unstopped, _ in each.unstopped])
    child = node.children[0]
    origin = next(iter(found.answers_of(f"{path}/{child.name}", child).values()))
    names = (name for name in outcome_names(node) if name in ends)
    _keep(found, path, node, dict.fromkeys(names, origin), unstopped)


def stopped_space(each: Judged, found: StopPaths) -> Space:
    """The outcomes of the branches after all of them have answered a stop; empty if one of them
    does not answer."""
    path, children = each.path, each.concurrence.node.children
    space: Space = {
        child.name: tuple(found.answers_of(f"{path}/{child.name}", child)) for child in children
    }
    return space if all(space.values()) else {}


def stoppable_branches(
    containers: Sequence[tuple[str, Container]], known: Endings
) -> dict[str, Concurrence]:
    """The branches that are stopped when another one ends, by path, with their concurrence."""
    found: dict[str, Concurrence] = {}
    for path, container in containers:
        if isinstance(container, Concurrence) and container.join == "any":
            branches = [f"{path}/{child.name}" for child in container.children]
            ending = [branch for branch in branches if known.unstopped[branch]]
            found.update(
                (branch, container) for branch in branches if ending and ending != [branch]
            )
    return found


def branch_around(path: str, branches: Mapping[str, Concurrence]) -> str:
    """The innermost of some branches that the state at a path is in; empty if there is none."""
    while path and path not in branches:
        path = path.rpartition("/")[0]
    return path
