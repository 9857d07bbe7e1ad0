"""Hidden states: those that cannot be entered, and what probably has to lead to them (SM201)."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from collections.abc import Set as AbstractSet
from itertools import pairwise
from typing import NamedTuple

from smachac.analysis.context import Context
from smachac.analysis.control_flow import Linear, has_no_interface, unhandled
from smachac.checks.findings.help_text import calls, did_you_mean
from smachac.diagnostics.diagnostic import Finding
from smachac.diagnostics.source import NOWHERE, Word
from smachac.diagnostics.spelling import MOST_EXPLAINED, guesser, respelt
from smachac.diagnostics.wording import listed
from smachac.ir.graph import edges, reachable
from smachac.ir.nodes import Node, Sequence, Transition
from smachac.ir.outcome_names import PREEMPTED, fails
from smachac.ir.traversal import outcome_names, written_children


class Hidden(NamedTuple):
    """A state that cannot be entered, first in a group of those that are entered by it; and what
    probably has to lead to it: a transition of the state before it that leads past it, or an
    outcome of that state without a transition."""

    path: str
    container: Linear
    group: list[Node]
    past: LedPast | None
    way_out: tuple[Node, Transition] | None


def hidden_groups(context: Context) -> Iterator[Hidden | Finding]:
    """The groups of states that cannot be entered, without those whose cause another rule
    reports; and the finding on a sequence that never continues."""
    missed: set[str] | None = None
    for (path, container), whole in zip(context.linear, context.absorbed, strict=True):
        seen = context.of_container(reachable, path, whole)
        hidden = [child for child in written_children(container) if child.name not in seen]
        if not hidden:
            continue
        if isinstance(container, Sequence) and _never_continues(container):
            yield _wrong_connector(path, container)
            continue
        if missed is None:
            from smachac.analysis.failed_properties import missed_states

            missed = missed_states(context)
        before = _before(whole, frozenset(child.name for child in hidden))
        first = _first_hidden(container, hidden, before, seen)
        previous = {state.name: one for one, state in pairwise(container.children)}
        order = {child.name: at for at, child in enumerate(hidden)}
        groups = 0
        for child in hidden:
            if child.name not in first or f"{path}/{child.name}" in missed:
                continue  # SM701 reports the transition that must lead to it
            groups += 1
            alone, one = not before.get(child.name), previous.get(child.name)
            is_searched = alone and groups <= MOST_EXPLAINED
            others = first[child.name] - {child.name}
            group = [child, *(hidden[at] for at in sorted(map(order.__getitem__, others)))]
            past = _led_past(container, one, group, seen) if is_searched else None
            way_out = _way_out(container, one, seen) if past is None else None
            yield Hidden(path, container, group, past, way_out)


def _first_hidden(
    container: Linear, hidden: list[Node], before: dict[str, list[str]], seen: Collection[str]
) -> dict[str, set[str]]:
    """The states by which the hidden ones are entered, each with those that are entered by it:
    those to which no other one leads, and the first one of a circle. None if as many outcomes of
    states that can be entered have no transitions (SM104)."""
    after: dict[str, list[str]] = {}
    for name, sources in before.items():
        for source in sources:
            after.setdefault(source, []).append(name)
    found: dict[str, set[str]] = {}
    covered: set[str] = set()
    alone = [child.name for child in hidden if not before.get(child.name)]
    for name in (*alone, *(child.name for child in hidden)):
        if name not in covered:
            group = found[name] = set()
            todo = [name]
            while todo:
                if (each := todo.pop()) not in covered:
                    covered.add(each)
                    group.add(each)
                    todo += after.get(each, [])
    left = sum(len(unhandled(child)) for child in container.children if child.name in seen)
    return found if len(found) > left else {}


class LedPast(NamedTuple):
    """A transition of the state before other ones that leads past them."""

    child: Node
    step: Transition


def _led_past(
    container: Linear, before: Node | None, group: list[Node], seen: AbstractSet[str]
) -> LedPast | None:
    """The transition that leads past a group of states, to a state to which one of them leads as
    well: the only one of the state before them in the script that is not one of failure, else the
    only one of failure."""
    if isinstance(container, Sequence) or before is None or before.name not in seen:
        return None
    after = {step.target for step in group[0].transitions if step.target in seen}
    good = {step.target for state in group for step in state.transitions
            if step.target in seen and not fails(state, step.outcome)
            and step.outcome != PREEMPTED}  # fmt: skip
    steps = [step for step in before.transitions if step.origin == "written"]
    found = [step for step in steps if step.target in after | good
             and step.outcome != PREEMPTED and not fails(before, step.outcome)]  # fmt: skip
    found = found or [step for step in steps if step.target in good
                      and fails(before, step.outcome)]  # fmt: skip
    return LedPast(before, found[0]) if len(found) == 1 else None


def _way_out(
    container: Linear, before: Node | None, seen: Collection[str]
) -> tuple[Node, Transition] | None:
    """A state that can be entered, with an outcome that is not one of failure and has no
    transition, so that the container ends with it."""
    if before is None or before.name not in seen or isinstance(container, Sequence):
        return None
    steps = [step for step in before.transitions if step.origin == "implicit"
             and step.outcome != PREEMPTED and not fails(before, step.outcome)]  # fmt: skip
    return (before, steps[0]) if len(steps) == 1 else None


def _never_continues(container: Sequence) -> bool:
    """Whether no state of a sequence has the connector outcome that the script gives."""
    if container.connector_span.source is NOWHERE.source:
        return False
    return all(
        container.connector_outcome not in outcome_names(child) and not has_no_interface(child)
        for child in container.children
    )


def _wrong_connector(path: str, container: Sequence) -> Finding:
    outcomes = [name for child in container.children for name in outcome_names(child)]
    word = Word(container.connector_outcome, container.connector_span)
    guess = guesser(outcomes)
    good = [name for name in dict.fromkeys(outcomes)
            if all(name in outcome_names(child) for child in container.children)
            and not any(fails(child, name) for child in container.children)]  # fmt: skip
    known = f"use an outcome of its states: {listed(good or outcomes)}"
    if len(good) == 1:
        known = f"write `{good[0]}`, with which each of its states can end"
    return Finding(
        span=word.span,
        message=f"no state of `{container.name}` ends with `{word.text}`, so the sequence never"
        " continues after its first state",
        arguments=(word.text,),
        help=did_you_mean(guess(word.text)) or known,
        related=calls(container, word.span),
        node=path,
        edits=respelt(word, guess.unique_match(word.text)),
    )


def _before(container: Linear, hidden: frozenset[str]) -> dict[str, list[str]]:
    """The states that lead to each hidden one, without itself; they are hidden as well."""
    before: dict[str, list[str]] = {}
    for edge in edges(container):
        if edge.target in hidden and edge.source != edge.target:
            before.setdefault(str(edge.target), []).append(str(edge.source))
    return before
