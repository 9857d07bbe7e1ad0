"""Outcomes that a state never ends with because a variable has no value (SM203)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from smachac.checks.findings.help_text import calls, other_place
from smachac.checks.findings.type_words import placeholder
from smachac.diagnostics.diagnostic import Finding
from smachac.diagnostics.source import Word
from smachac.diagnostics.wording import listed
from smachac.ir.graph import edges, reachable
from smachac.ir.leaf import variable
from smachac.ir.nodes import (
    Concurrence,
    Container,
    Leaf,
    Node,
    Sequence,
    StateMachine,
    StateType,
    Transition,
)
from smachac.ir.traversal import leads_to_child
from smachac.records import replace

_Never = dict[str, dict[str, tuple[str, ...]]]
"""For the states of a container by name: the outcomes that are impossible, each with the variables
of which it needs one."""


def outcomes_without_variable(
    path: str, container: Container, types: Mapping[str, StateType]
) -> Iterator[Finding]:
    """The outcomes that need a variable without a value, where the script relies on them: in a rule
    of a concurrence, or on the only path to a state or an end of the container."""
    never = {child.name: found for child in container.children if (found := _never(child, types))}
    children = {child.name: child for child in container.children}
    match container:
        case _ if not never or len(children) < len(container.children):  # SM106
            return
        case Concurrence():
            for entry in container.rules:
                for condition in entry.when:
                    if condition.outcome in never.get(condition.child, ()):
                        word = Word(condition.outcome, condition.span)
                        yield _finding(path, children[condition.child], never, word, types)
        case StateMachine() | Sequence():
            yield from (
                _finding(path, child, never, Word(step.outcome, step.span), types)
                for child, step in _only_ways(container, never)
            )


def _never(child: Node, types: Mapping[str, StateType]) -> dict[str, tuple[str, ...]]:
    type_ = types.get(child.type) if isinstance(child, Leaf) else None
    if type_ is None or not isinstance(child, Leaf):
        return {}
    return {
        outcome: names
        for outcome, names in type_.needs.items()
        if all(variable(child, name) is None for name in names)
    }


def _only_ways(
    container: StateMachine | Sequence, never: _Never
) -> Iterator[tuple[Node, Transition]]:
    """The transitions for impossible outcomes that are the only ones to their target, each with its
    state."""
    children = tuple(
        replace(child, transitions=tuple(step for step in child.transitions
                                         if step.outcome not in never[child.name]))
        if child.name in never else child
        for child in container.children
    )  # fmt: skip
    possible = replace(container, children=children)
    entered, still = reachable(container), reachable(possible)
    ends = {edge.target for edge in edges(possible) if edge.source in still}
    for child in container.children:
        for step in child.transitions if child.name in still else ():
            if step.outcome not in never.get(child.name, ()) or step.origin != "written":
                continue
            inside = leads_to_child(step, entered)
            if step.target not in still if inside else ("outcome", step.target) not in ends:
                yield child, step


def _finding(
    path: str, child: Node, never: _Never, outcome: Word, types: Mapping[str, StateType]
) -> Finding:
    """`outcome`: the impossible outcome, with the place where the script relies on it."""
    name, names = child.name, never[child.name][outcome.text]
    lacking = f"`{names[0]}` has no value" if len(names) == 1 else f"{listed(names)} have no value"
    variables = types[child.type].variables
    added = [f"`{name}: {placeholder(variables[name].type)}`" for name in names]
    return Finding(
        span=outcome.span,
        message=f"`{name}` never ends with `{outcome.text}`: {lacking}",
        arguments=(outcome.text, name),
        help=f"add {' or '.join(added)} to `{name}`, or use another of its outcomes here",
        related=(*other_place(child.span, f"`{name}` is here"), *calls(child, outcome.span)),
        node=f"{path}/{name}",
    )
