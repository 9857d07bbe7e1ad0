"""Properties that fail, with their counterexamples, and the states that they require."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from smachac.analysis.context import Context
from smachac.analysis.control_flow import (
    children_names,
    dangling_transitions,
    unhandled,
    unknown_outcomes,
)
from smachac.analysis.property_turns import Turn, turn_of
from smachac.ir.properties import Property
from smachac.ir.traversal import outcome_names

if TYPE_CHECKING:
    from smachac.analysis.properties import Counterexample
    from smachac.interpreter.counterexample import Replay


class Failure(NamedTuple):
    """A property that fails, with its number in the script from 1, its counterexample with the
    replay of it, and the transition that leaves the required way."""

    number: int
    property: Property
    example: Counterexample
    shown: Replay
    turn: Turn | None


def failures(context: Context) -> Iterator[Failure]:
    """The properties that fail, without those whose counterexample passes an outcome that leads
    nowhere."""
    from smachac.interpreter.counterexample import replay

    nodes = dict(context.states)
    open_ends = _open_ends(context) if context.judgements else frozenset()
    for number, judgement in enumerate(context.judgements, 1):
        example = judgement.counterexample
        if example is not None and not _is_open(example, open_ends):
            shown = replay(context.machine, example.visits, example.again)
            turn = turn_of(judgement.property.form, shown, len(example.visits), nodes)
            yield Failure(number, judgement.property, example, shown, turn)


def _open_ends(context: Context) -> frozenset[tuple[str, str]]:
    """The outcomes of states that lead nowhere or may lack their transition (SM101, SM102, SM104),
    each with the path of the state."""
    found: set[tuple[str, str]] = set()
    for path, container in context.linear:
        names, exits = children_names(container), frozenset(outcome_names(container))
        for child in container.children:
            ends = [step.outcome for step in dangling_transitions([child], names, exits)]
            ends += [outcome.name for outcome in unhandled(child)]
            if unknown_outcomes(child):  # SM102: a transition of these is probably meant
                handled = {step.outcome for step in child.transitions if step.origin == "written"}
                ends += [name for name in outcome_names(child) if name not in handled]
            found.update((f"{path}/{child.name}", end) for end in ends)
    return frozenset(found)


def _is_open(example: Counterexample, open_ends: frozenset[tuple[str, str]]) -> bool:
    """Whether a counterexample passes an outcome that leads nowhere: its path is not one of the
    script that was meant."""
    if not open_ends:
        return False
    if any((visit.path, visit.outcome) in open_ends for visit in example.visits):
        return True
    last = example.visits[-1].path if example.visits else ""
    return any(last.startswith(f"{path}/") for path, _ in open_ends)


def missed_states(context: Context) -> set[str]:
    """The states, by path, to which a transition must lead because of a property (SM701)."""
    turns = [failure.turn for failure in failures(context)] if context.judgements else []
    missed = {id(node) for turn in turns if turn is not None for node in turn.missed}
    return {path for path, node in context.states if id(node) in missed} if missed else set()
