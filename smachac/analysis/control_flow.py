"""Control flow inside a container: strongly connected components and shortest witness paths.

The analyses work on corrected containers, so that one fault gives one finding: a misspelt name
stands for the nearest known name, and an open leaf can have every outcome that avoids a finding.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import replace
from itertools import pairwise
from operator import is_
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from smachac.diagnostics.diagnostic import PathStep, ended, entered
from smachac.diagnostics.negation import are_opposite
from smachac.diagnostics.spelling import MOST_COMPARED, Guesser, guesser, words_of
from smachac.ir import nodes
from smachac.ir.graph import START, can_end, edges, reachable
from smachac.ir.nodes import Concurrence, Leaf, Node, Outcome, StateMachine, Transition
from smachac.ir.outcome_names import GOOD, PREEMPTED, STOPS, SUCCESSES, TIMEOUTS, fails, is_failure
from smachac.ir.traversal import leads_to_child, outcome_names

if TYPE_CHECKING:
    import networkx as nx

Linear: TypeAlias = "StateMachine | nodes.Sequence"
"""A container whose states are connected by transitions."""


def is_open(node: Node) -> bool:
    return isinstance(node, Leaf) and node.open


def children_names(container: nodes.Container) -> frozenset[str]:
    return frozenset([child.name for child in container.children])


def places_of(container: nodes.Container) -> Guesser:
    """The guesser for the targets of transitions inside a container."""
    return guesser([*(child.name for child in container.children), *outcome_names(container)])


class MeantTarget(NamedTuple):
    """The known name that is meant by the unknown target of a transition. `paired`: the two are not
    alike, but no transition leads to this name, and it is the only such name. `certain` is the only
    known name one slip away."""

    name: str
    paired: bool = False
    certain: str | None = None


MOST_MEANT = 1000
"""The most unknown targets of a container for which a known name is searched."""


def meant_targets(container: Linear) -> dict[str, MeantTarget]:
    """The names that are meant by the unknown targets of transitions in a container: the nearest
    one, first of those to which nothing leads; or the only one to which nothing leads. None for a
    state that is missing (`_missing_states`)."""
    names, exits = children_names(container), frozenset(outcome_names(container))
    unknown = dict.fromkeys(step.target for step in strays(container.children, names, exits))
    lost = [*unknown][:MOST_MEANT]
    if not lost:
        return {}
    led = {step.target for child in container.children for step in child.transitions
           if step.target != child.name}  # fmt: skip
    states = [name for name in dict.fromkeys(child.name for child in container.children)
              if name not in led and name != container.initial]  # fmt: skip
    ends = [name for name in outcome_names(container) if name not in led]
    free, every = guesser([*states, *ends]), places_of(container)
    found: dict[str, MeantTarget] = {}
    for target in lost:
        near = (free.sure(target) or every.sure(target)) if target else None
        if near is not None:
            found[target] = MeantTarget(near)
    taken = {each.name for each in found.values()}
    left = [target for target in lost if target and target not in found]
    states = [name for name in states if name not in taken]
    ends = [name for name in ends if name not in taken and name.islower()]
    if len(left) == 1 and len(names) == len(container.children):
        choices = states or (ends if left[0].islower() else [])
        if len(choices) == 1 and not are_opposite(left[0], choices[0]):
            found[left[0]] = MeantTarget(choices[0], free(left[0]) != choices[0])
            left = []
    shouted = all(name.isupper() for name in names)
    by_word = _names_by_word(names) if left else {}
    for target in left:
        # A state to which other transitions lead is hardly meant by a name that is not near to it.
        near = free(target) or _longer_name(target, by_word)
        near = near or (None if shouted and target.isupper() else every(target))
        if near is not None:
            found[target] = MeantTarget(near)
    return {target: meant._replace(certain=every.sure(target)) for target, meant in found.items()}


def _names_by_word(names: Iterable[str]) -> dict[str, list[str]]:
    """The names that contain each word."""
    found: dict[str, list[str]] = {}
    for name in names:
        for word in words_of(name):
            found.setdefault(word, []).append(name)
    return found


def _longer_name(target: str, by_word: Mapping[str, list[str]]) -> str | None:
    """The only state whose name has all words of a target and one more, which means no failure:
    `PARK_ARM` for `PARK`. None if each of these words is in more than MOST_COMPARED names."""
    words = words_of(target)
    rarest = min((by_word.get(word, []) for word in words), key=len, default=[])
    if len(rarest) > MOST_COMPARED:
        return None
    found = [name for name in rarest if words < words_of(name)]
    if len(found) != 1 or is_failure(found[0]) != is_failure(target):
        return None
    return found[0] if len(words_of(found[0]) - words) == 1 else None


def strays(
    children: Iterable[Node], names: frozenset[str], exits: frozenset[str]
) -> list[Transition]:
    """The transitions of children that lead neither to one of `names` nor out by one of `exits`."""
    return [
        step for child in children for step in child.transitions if _is_stray(step, names, exits)
    ]


def _is_stray(step: Transition, names: frozenset[str], exits: frozenset[str]) -> bool:
    # `leads_to_child` in place: the check of every transition comes here
    return step.target not in exits and (step.target not in names or step.origin == "implicit")


def unknown_outcomes(child: Node) -> list[tuple[Transition, str | None]]:
    """The transitions for outcomes that a state does not have, each with the outcome that is
    probably meant: the nearest known one, or the one of the same meaning without a
    transition."""
    declared = {outcome.name for outcome in child.outcomes}
    unknown = [step for step in child.transitions if step.outcome not in declared]
    if not unknown or is_open(child):
        return []
    guess = guesser(outcome_names(child))
    default = missing_default(child)
    if default is not None:
        return [(step, default[1]) for step in unknown]
    near = {step.outcome: guess(step.outcome) for step in unknown}
    others = [step.outcome for step in unknown if not near[step.outcome] and not is_catch_all(step)]
    alike: dict[str, str] = {}
    for origins in (("written", "implicit", "connector"), ("written",)):
        used = {*near.values(), *alike.values()}
        used |= {step.outcome for step in child.transitions if step.origin in origins}
        left = [name for name in outcome_names(child) if name not in used and name != child.catches]
        others = [name for name in others if name not in alike]
        if others and left:
            alike |= _of_one_meaning(child, others, left)
        stops = left == [PREEMPTED] and "implicit" in origins
        if stops and len(others) == 1 and others[0] not in _NO_STOPS:
            alike.setdefault(others[0], PREEMPTED)
    return [(step, near[step.outcome] or alike.get(step.outcome)) for step in unknown]


_NO_STOPS = GOOD | SUCCESSES | TIMEOUTS | {"exhausted"}
"""Outcomes that do not mean the one after a stop request."""


def missing_default(node: Node) -> tuple[Transition, str] | None:
    """The transition for the outcome that a state without its `default_outcome` is meant to end
    with, and the default of the interface in its place, which has no transition."""
    held = [each for each in node.variables if each.name == "default_outcome"
            and each.span == node.span] if isinstance(node, Leaf) else []  # fmt: skip
    if len(held) != 1 or is_open(node):
        return None
    default, names = str(held[0].value.data), outcome_names(node)
    unknown = [step for step in node.transitions if step.outcome not in names]
    handled = {step.outcome for step in node.transitions}
    if len(unknown) != 1 or default in handled or default not in names:
        return None
    return unknown[0], default


def outcome_of_one_meaning(child: Node, name: str) -> str | None:
    """The outcome of a state that is probably meant by an unknown one: the only success, the only
    failure or the only one after a stop."""
    meaning = _meaning(name, is_failure(name))
    alike = [each for each in outcome_names(child)
             if _meaning(each, fails(child, each)) == meaning]  # fmt: skip
    return alike[0] if meaning in _MEANINGS and len(alike) == 1 else None


def _of_one_meaning(child: Node, others: list[str], left: list[str]) -> dict[str, str]:
    """For unknown outcomes the ones in `left` that are probably meant: the only success, the only
    failure, the only one after a stop, the only one that remains."""
    found: dict[str, str] = {}
    means = {name: _meaning(name, is_failure(name)) for name in others}
    known = {name: _meaning(name, fails(child, name)) for name in left}
    for meaning in _MEANINGS:
        wrong = [name for name in means if means[name] == meaning]
        right = [name for name in known if known[name] == meaning]
        if len(wrong) == len(right) == 1:
            found[wrong[0]] = right[0]
    wrong = [name for name in means if name not in found and name != PREEMPTED]
    right = [name for name in known if name not in found.values() and name != PREEMPTED]
    if len(wrong) == len(right) == 1 and {means[wrong[0]], known[right[0]]} != {
        "success",
        "failure",
    }:
        found[wrong[0]] = right[0]
    return found


_MEANINGS = ("success", "failure", "stop")


def _meaning(outcome: str, failure: bool) -> str:
    """One of `_MEANINGS`, or empty for other outcomes."""
    if failure:
        return "failure"
    if outcome.lower() in STOPS:
        return "stop"
    return "success" if outcome.lower() in GOOD | SUCCESSES else ""


CATCH_ALL = frozenset(["*", "_", "any", "default", "else", "other", "others", "otherwise"])
"""Words that other languages use for all cases that are not listed."""


def is_catch_all(step: Transition) -> bool:
    """Whether a transition for an unknown outcome is meant for all outcomes without one."""
    return step.outcome in CATCH_ALL


class Correction(NamedTuple):
    """A corrected container, and the names that are meant by its unknown targets."""

    container: Linear
    meant: Mapping[str, MeantTarget]


def corrected(container: Linear) -> Linear:
    """The container of a correction."""
    return correction(container).container


def correction(container: Linear) -> Correction:
    """A container with misspelt targets and outcomes corrected, where a near name exists.

    A state gets the unknown outcomes of its transitions for which no known one is meant. An unknown
    target that is written like the names of the states is a missing state: an open one stands for
    it.
    """
    names = children_names(container)
    exits = frozenset(outcome_names(container))
    has_strays = bool(strays(container.children, names, exits))
    if not has_strays and not any(map(unknown_outcomes, container.children)):
        return Correction(container, {})
    all_meant = meant_targets(container)
    # An unlike name can also be a missing state: then nothing follows from it.
    meant = {name: target for name, target in all_meant.items() if not target.paired}

    def target(step: Transition) -> Transition:
        known = meant.get(step.target)
        return step if known is None else replace(step, target=known.name)

    def child(node: Node) -> Node:
        unknown = unknown_outcomes(node)
        lost = [_is_stray(step, names, exits) for step in node.transitions]
        if not unknown and not any(lost):
            return node
        wrong = {step.outcome: meant for step, meant in unknown}
        steps = [
            replace(
                target(step) if is_lost else step,
                outcome=wrong.get(step.outcome) or step.outcome,
            )
            for step, is_lost in zip(node.transitions, lost, strict=True)
            if not (is_lost and _catches_itself(node, target(step)))
        ]
        known = {each.name for each in node.outcomes}
        more = [step for step in steps if step.outcome not in known]
        added = dict.fromkeys(Outcome(name=step.outcome, span=step.span) for step in more)
        outcomes = (*node.outcomes, *added)
        return replace(node, outcomes=outcomes, transitions=tuple(map(target, steps)))

    children = (*map(child, container.children), *_missing_states(container, names, exits, meant))
    if len(children) == len(container.children) and all(map(is_, children, container.children)):
        return Correction(container, all_meant)
    return Correction(replace(container, children=children), all_meant)


def _missing_states(
    container: Linear,
    names: frozenset[str],
    exits: frozenset[str],
    meant: Mapping[str, MeantTarget],
) -> list[Leaf]:
    """Open states for the unknown targets of transitions in a container of states in upper case."""
    lost = strays(container.children, names, exits)
    if not lost or not all(name.isupper() for name in names):
        return []
    spans = {step.target: step.span for step in reversed(lost)}
    missing = [name for name in spans if name.isupper() and name not in meant]
    return [Leaf(name=name, type="", span=spans[name], open=True) for name in reversed(missing)]


def _catches_itself(node: Node, step: Transition) -> bool:
    """Whether the exceptions of a state lead to itself, because `on_error` is misspelt."""
    return step.outcome == node.catches and step.target == node.name and bool(node.catches)


def outline(
    path: str, container: Linear, endless: AbstractSet[str], known: Linear | None = None
) -> Linear:
    """A corrected container in which open leaves lead out of it and endless states lead nowhere.

    An open leaf can have any outcome, also one that its container has and no transition handles.
    `known` is the corrected container, if it has been computed.
    """
    if not endless and not any(map(is_open, container.children)):
        return known if known is not None else corrected(container)
    exits = outcome_names(container)

    def child(node: Node) -> Node:
        if endless and f"{path}/{node.name}" in endless:
            return replace(node, transitions=(), outcomes=())
        if not is_open(node):
            return node
        handled = {step.outcome for step in node.transitions}
        unhandled = [name for name in exits[: len(handled) + 2] if name not in handled]
        if not unhandled:
            return node
        way = next((name for name in unhandled if name != PREEMPTED), unhandled[0])
        more = Transition(outcome=way, target=way, origin="implicit", span=node.span)
        return replace(node, transitions=(*node.transitions, more))

    children = tuple(map(child, container.children))
    if all(new is old for new, old in zip(children, container.children, strict=True)):
        return known if known is not None else corrected(container)
    return corrected(replace(container, children=children))


def endless_states(states: Sequence[tuple[str, Node]]) -> frozenset[str]:
    """The paths of the states that never end: with `forever: true`, or without any outcome.

    A container with a trap in it is not among them: the trap is reported inside it.
    """
    found: set[str] = set()
    for path, node in reversed(states):
        if node.outcomes and isinstance(node, Leaf):
            continue  # most states
        if _never_ends(path, node, found):
            found.add(path)
    return frozenset(found)


def _never_ends(path: str, node: Node, inner: set[str]) -> bool:
    if node.catches:
        return False
    match node:
        case Leaf():
            return not node.open and not node.outcomes and not node.transitions
        case StateMachine(forever=True):
            flow = outline(path, node, inner)
            return node.initial in reachable(flow) - can_end(flow)
        case StateMachine() | nodes.Sequence():
            return False
        case Concurrence():
            lasting = [f"{path}/{child.name}" in inner for child in node.children]
            return bool(lasting) and (all(lasting) if node.join == "any" else any(lasting))
    skips = any(edge.source == START and isinstance(edge.target, tuple) for edge in edges(node))
    lasting = [f"{path}/{child.name}" in inner for child in node.children]
    return bool(lasting) and all(lasting) and not skips


MOST_STEPS = 50
"""The most states of a witness path: the last ones are kept."""

SiblingSteps = dict[str, list[tuple[str, str]]]
"""For each state the outcomes that lead to a sibling, with the sibling."""


def steps_of(container: Linear) -> SiblingSteps:
    """The transitions between the states of a container."""
    names = children_names(container)
    steps: SiblingSteps = {child.name: [] for child in container.children}
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


def step_graph(names: Iterable[str], steps: SiblingSteps) -> nx.DiGraph:
    """Some states of a container and the steps between them, with the first outcome of each."""
    import networkx as nx

    graph = nx.DiGraph()
    graph.add_nodes_from(names)
    for name in list(graph):
        for outcome, target in steps[name]:
            if target in graph and not graph.has_edge(name, target):
                graph.add_edge(name, target, outcome=outcome)
    return graph


def regions(names: Iterable[str], steps: SiblingSteps) -> list[list[str]]:
    """The strongly connected components, in the order of `names`, as their states are."""
    import networkx as nx

    graph = step_graph(names, steps)
    order = {name: number for number, name in enumerate(graph)}
    parts = nx.strongly_connected_components(graph)
    found = [sorted(part, key=order.__getitem__) for part in parts]
    return sorted(found, key=lambda part: order[part[0]])


def dead_ends(names: Iterable[str], steps: SiblingSteps) -> list[list[str]]:
    """The strongly connected components that no transition leaves."""
    ends = []
    for region in regions(names, steps):
        inside = frozenset(region)
        if all(target in inside for name in region for _, target in steps[name]):
            ends.append(region)
    return ends


Before = Mapping[str, "str | None"]
"""States with the one before each on a shortest path from a start, nearest first."""


def shortest_paths(graph: nx.DiGraph, start: str) -> Before:
    """The shortest paths from a state; none where there is no such state."""
    import networkx as nx

    if start not in graph:
        return {}
    return {start: None, **{name: last for last, name in nx.bfs_edges(graph, start)}}


def way(path: str, graph: nx.DiGraph, before: Before, goal: str) -> list[PathStep]:
    """A shortest path to a state of the container at a path; the state alone if there is none."""
    names = [goal]
    while (last := before.get(names[-1])) is not None:
        names.append(last)
    names = names[: MOST_STEPS + 1][::-1]
    steps = [entered(names[0], f"{path}/{names[0]}")]
    for name, following in pairwise(names):
        outcome = graph.edges[name, following]["outcome"]
        steps += [ended(outcome), entered(following, f"{path}/{following}")]
    return steps


def circle(path: str, region: Sequence[str], steps: SiblingSteps) -> list[PathStep]:
    """The shortest path from the first state of a region back to it; empty where there is none."""
    first = region[0]
    graph = step_graph(region, steps)
    before = shortest_paths(graph, first)
    last = next((name for name in before if graph.has_edge(name, first)), None)
    if last is None:
        return []
    outcome = graph.edges[last, first]["outcome"]
    there = way(path, graph, before, last)[-2 * MOST_STEPS + 1 :]
    return [*there, ended(outcome), entered(first, f"{path}/{first}")]


def unhandled(child: Node) -> list[Outcome]:
    """The outcomes of a state without a transition, except those that a misspelt transition is
    probably for."""
    handled = {step.outcome for step in child.transitions}
    left = [outcome for outcome in child.outcomes if outcome.name not in handled]
    if not left:
        return []
    unknown = unknown_outcomes(child)
    if any(is_catch_all(step) for step, _ in unknown):
        return []
    handled.update(meant for _, meant in unknown if meant)
    return [outcome for outcome in child.outcomes if outcome.name not in handled]


Unhandled: TypeAlias = "Sequence[tuple[Node, Sequence[Outcome]]]"
"""The states of a container that have outcomes without a transition, with these."""


def unhandled_in(container: Linear) -> Unhandled:
    """The states of a container that have outcomes without a transition."""
    return tuple([(child, left) for child in container.children if (left := unhandled(child))])
