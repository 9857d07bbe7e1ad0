"""Possible outcomes: those that a state can really end with, given what is inside it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from smachac.analysis.control_flow import (
    Linear,
    absorbed,
    children_names,
    has_no_interface,
    unknown_outcomes,
)
from smachac.analysis.outcome_rules import (
    OTHER,
    SoundConcurrence,
    Space,
    UndecidedError,
    sound_concurrence,
    space,
    unstopped_spaces,
    without_other,
)
from smachac.ir import nodes
from smachac.ir.graph import edges, is_unread, stopped_endings
from smachac.ir.nodes import Concurrence, Container, Leaf, Node, StateMachine
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import leads_to_child, outcome_names
from smachac.records import replace

OutcomesByPath = dict[str, tuple[str, ...]]


class Endings(NamedTuple):
    """The outcomes of states by path. `ever`: those that are possible at all. `unstopped`: those
    that are possible without a preempt request."""

    ever: OutcomesByPath
    unstopped: OutcomesByPath


def endings(states: Sequence[tuple[str, Node]]) -> Endings:
    """The possible endings of all states inside concurrences, in the order of declaration.

    A declared outcome with which nothing ends is none of them. If a fault makes the endings of a
    state unknown, all its outcomes are possible.
    """
    found = Endings({}, {})
    inside: list[tuple[str, Node]] = []
    within: set[str] = set()
    for path, node in states:
        if isinstance(node, Leaf):
            continue
        if isinstance(node, Concurrence) or path in within:
            children = [(f"{path}/{child.name}", child) for child in node.children]
            inside += children
            within.update(inner for inner, _ in children)
    for path, node in reversed(inside):
        found.ever[path] = _ever(path, node, found.ever)
        found.unstopped[path] = _unstopped(path, node, found)
    return found


def _ever(path: str, node: Node, known: OutcomesByPath) -> tuple[str, ...]:
    match node:
        case Leaf():
            return (*outcome_names(node), *(OTHER,) * node.open)
        case Concurrence():
            concurrence = sound_concurrence(path, node)
            spaces = [space(concurrence, known)] if concurrence else []
            return _declared(node, [*results(node, concurrence, spaces), PREEMPTED])
    return _of_container(path, node, known, asked=True)


def _unstopped(path: str, node: Node, found: Endings) -> tuple[str, ...]:
    match node:
        case Leaf():
            return tuple(name for name in found.ever[path] if name != PREEMPTED)
        case Concurrence():
            concurrence = sound_concurrence(path, node)
            spaces = (
                [entry for entry, _ in unstopped_spaces(concurrence, *found)] if concurrence else []
            )
            return _declared(node, results(node, concurrence, spaces))
    return _of_container(path, node, found.unstopped, asked=False)


def _of_container(
    path: str, node: Container, known: OutcomesByPath, *, asked: bool
) -> tuple[str, ...]:
    if isinstance(node, StateMachine | nodes.Sequence):
        return _declared(node, _linear(path, node, known))
    return _declared(node, _by_edges(path, node, known, asked=asked))


def _declared(node: Node, results: Iterable[str]) -> tuple[str, ...]:
    possible = frozenset([*results, node.catches])
    return tuple(name for name in outcome_names(node) if name in possible)


def _linear(path: str, container: Linear, known: OutcomesByPath) -> set[str]:
    """The exits that can be reached from the initial state."""
    whole = absorbed(container)
    names = children_names(whole)
    exits = frozenset(outcome_names(whole))
    ends: dict[str, tuple[str, ...]] = {}
    states: dict[str, Node] = {}
    for child in whole.children:
        states[child.name] = child
        ends[child.name] = known.get(f"{path}/{child.name}", ())
    for child in container.children:
        ends[child.name] += tuple(step.outcome for step in unknown_outcomes(child))
    todo = [whole.initial] if whole.initial in names else list(states)
    seen, found = set(todo), set[str]()
    while todo:
        child = states[todo.pop()]
        handled = {step.outcome for step in child.transitions}
        more: list[str] = []
        for step in child.transitions:
            if step.outcome not in ends[child.name] and not has_no_interface(child):
                continue
            if leads_to_child(step, names):
                more.append(step.target)
            elif step.target in exits:
                found.add(step.target)
            else:
                found |= exits
        if has_no_interface(child):
            found |= exits - handled
        if is_unread(child) and len(seen) < len(states):
            more += states
        todo += (name for name in dict.fromkeys(more) if name not in seen)
        seen.update(more)
    return found


def _by_edges(path: str, container: Container, known: OutcomesByPath, *, asked: bool) -> set[str]:
    """The outcomes of a container that an edge leads to. After a request to stop an iterator ends
    with the outcome of its child, also with a looping outcome (docs/semantics.md, Iterator)."""
    children = tuple(
        child
        if has_no_interface(child)
        else replace(child, outcomes=_only(child, known[f"{path}/{child.name}"]))
        for child in container.children
    )
    shown = replace(container, children=children)
    found = {edge.target[1] for edge in edges(shown) if isinstance(edge.target, tuple)}
    if asked and isinstance(shown, nodes.Iterator):
        found.update(stopped_endings(shown).values())
    return found


def _only(node: Node, names: Sequence[str]) -> tuple[nodes.Outcome, ...]:
    return tuple(outcome for outcome in node.outcomes if outcome.name in names)


def results(
    node: Concurrence, concurrence: SoundConcurrence | None, spaces: Sequence[Space]
) -> set[str]:
    """The results of the rules that can win, and of the default if none has to hold."""
    if concurrence is None:
        return set(outcome_names(node)) if node.children else set()
    found: set[str] = set()
    try:
        for entry in spaces:
            if concurrence.rules.find(entry, {}, concurrence.rules.all) is not None:
                found.add(node.default_outcome)
            for number, rule in enumerate(concurrence.written):
                given = concurrence.rules.conditions[number]
                if concurrence.rules.find(entry, given, concurrence.larger(number)) is not None:
                    found.add(rule.outcome)
    except UndecidedError:
        return set(outcome_names(node))
    return found


class Judged(NamedTuple):
    """A concurrence whose rules can be judged, at its path.

    `whole`: the outcomes that its branches can have, also after a request to stop. `unstopped`:
    those without a request to stop, as far as outcomes are known; with `join: any`, one space for
    each branch that can end first, with its name.
    """

    path: str
    concurrence: SoundConcurrence
    endings: Endings
    whole: Space
    unstopped: list[tuple[Space, str]]


def judged(containers: Iterable[tuple[str, Container]], known: Endings) -> list[Judged]:
    """The concurrences of a machine whose rules can be judged, without those made for sugar."""
    found: list[Judged] = []
    seen: set[str] = set()
    for path, container in containers:
        # Of two containers with one path (SM106) the first counts: outcomes are known by path.
        is_first = path not in seen
        seen.add(path)
        if not is_first or not isinstance(container, Concurrence) or container.sugar:
            continue
        concurrence = sound_concurrence(path, container)
        if concurrence is not None:
            spaces = unstopped_spaces(concurrence, *known)
            unstopped = [(without_other(entry), first) for entry, first in spaces]
            found.append(
                Judged(path, concurrence, known, space(concurrence, known.ever), unstopped)
            )
    return found
