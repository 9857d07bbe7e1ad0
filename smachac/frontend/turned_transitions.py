"""Transitions whose outcome and target have changed places: `kitted: succeeded` in place of
`succeeded: kitted`.

They are reported once (SM004) and then count as they are meant, so that nothing else follows.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from typing import TypeAlias

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.repair import Edit
from smachac.diagnostics.source import Span, Word
from smachac.frontend.errors.script import duplicate_key, wrong_shape
from smachac.frontend.script import State

Ends: TypeAlias = Callable[[State], Iterator[tuple[str, Span]]]
"""The function for the outcomes with which a state can end, each with its place."""


def with_turned_transitions(base: State, ends: Ends, report: Report) -> State:
    """The state with the transitions below it that are turned round turned back.

    A transition is turned round if its name is no outcome of its state, or one with another
    transition, but a state or an outcome of the container around; and its target is no state and no
    outcome there, but an outcome of the state that has no transition.
    """
    if base.owner == "state":
        return base
    places = {each.name.text for each in base.states} | {each.name for each in base.outcomes}
    is_linear = base.owner not in ("Concurrence", "Iterator")
    states = []
    for child in base.states:
        child = with_turned_transitions(child, ends, report)
        if is_linear and child.transitions and not child.type.open:
            names = frozenset(name for name, _ in ends(child))
            child = _turned_back(child, names, places, report)
        states.append(child)
    if all(new is old for new, old in zip(states, base.states, strict=True)):
        return base
    return base._replace(states=tuple(states))


def _turned_back(
    state: State, names: Collection[str], places: Collection[str], report: Report
) -> State:
    given: set[str] = set()
    found: list[tuple[Word, Word]] = []
    handled = {key.text for key, _ in state.transitions}
    for key, target in state.transitions:
        is_wrong = key.text not in names or key.text in given
        is_meant = target.text in names and target.text not in {*handled, *places}
        given.add(key.text)
        if is_wrong and is_meant and key.text in places:
            _report(state, key, target, report)
            key, target = target, key
        found.append((key, target))
    if tuple(found) == state.transitions:
        return state
    return state._replace(transitions=tuple(found))


def _report(state: State, key: Word, target: Word, report: Report) -> None:
    report[:] = [
        item for item in report
        if not (item.kind is duplicate_key.code and item.span == key.span)
    ]  # fmt: skip
    edits = (Edit(span=key.span, text=target.span.text), Edit(span=target.span, text=key.span.text))
    message = f"`{key.text}` is no outcome of `{state.name.text}`, but `{target.text}` is one"
    help = f"write `{target.span.text}: {key.span.text}`: the outcome comes first, then its target"
    effect = "the two names of this transition have changed places"
    report.append(
        wrong_shape(
            Span(key.span.source, key.span.start, target.span.end),
            message,
            help,
            arguments=("turned", key.text, target.text),
            edits=edits,
            effect=effect,
        )
    )
