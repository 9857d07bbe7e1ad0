"""Outcomes that a state never ends with because a variable has no value (SM203)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from smachac.checks.messages import calls, other_place
from smachac.diagnostics.diagnostic import Finding
from smachac.diagnostics.source import Span
from smachac.diagnostics.wording import listed
from smachac.ir.graph import edges, reachable
from smachac.ir.leaf import variable
from smachac.ir.nodes import Concurrence, Container, Leaf, Node, Sequence, StateMachine, StateType
from smachac.ir.traversal import leads_to_child

_Never = dict[str, dict[str, tuple[str, ...]]]
"""For the states of a container by name: the outcomes that are impossible, each with the variables
of which it needs one."""


def outcomes_without_variable(
    path: str, container: Container, types: Mapping[str, StateType]
) -> Iterator[Finding]:
    """The outcomes that need a variable without a value, where the script relies on them: in a rule
    of a concurrence, or on the only path to a state or an end of the container."""
    never = {child.name: found for child in container.children if (found := _never(child, types))}
    match container:
        case _ if not never:
            return
        case Concurrence():
            for entry in container.rules:
                for condition in entry.when:
                    if condition.outcome in never.get(condition.child, ()):
                        yield _finding(path, container, never, condition.child, condition.outcome,
                                       condition.span)  # fmt: skip
        case StateMachine() | Sequence():
            yield from _only_ways(path, container, never)


def _never(child: Node, types: Mapping[str, StateType]) -> dict[str, tuple[str, ...]]:
    type_ = types.get(child.type) if isinstance(child, Leaf) else None
    if type_ is None or not isinstance(child, Leaf):
        return {}
    return {
        outcome: names
        for outcome, names in type_.needs.items()
        if all(variable(child, name) is None for name in names)
    }


def _only_ways(path: str, container: StateMachine | Sequence, never: _Never) -> Iterator[Finding]:
    """The transitions for impossible outcomes that are the only ones to their target."""
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
                yield _finding(path, container, never, child.name, step.outcome, step.span)


def _finding(
    path: str, container: Container, never: _Never, name: str, outcome: str, span: Span
) -> Finding:
    child = next(each for each in container.children if each.name == name)
    names = never[name][outcome]
    lacking = f"`{names[0]}` has no value" if len(names) == 1 else f"{listed(names)} have no value"
    return Finding(
        span=span,
        message=f"`{name}` never ends with `{outcome}`: {lacking}",
        arguments=(outcome, name),
        help=f"add {_alternatives(names)} to `{name}`, or write another outcome",
        related=(*other_place(child.span, f"`{name}` is here"), *calls(child, span)),
        node=f"{path}/{name}",
    )


def _alternatives(names: Iterable[str]) -> str:
    return " or ".join(f"`{name}: ...`" for name in names)
