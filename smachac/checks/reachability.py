"""Rules over the shape of the graph: where it starts, what is reached, how it can end."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.analysis.context import Context
from smachac.analysis.control_flow import (
    Linear,
    children_names,
    is_open,
    leads_somewhere,
    mended,
)
from smachac.checks.messages import calls, did_you_mean
from smachac.checks.outcomes import endings, unhandled
from smachac.checks.rule import rule
from smachac.checks.timeouts import undeclared_stops
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.diagnostics.source import assert_never
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import listed
from smachac.ir import nodes
from smachac.ir.graph import edges, reachable, stopped_endings
from smachac.ir.nodes import Concurrence, Container, Node, Outcome, Sequence, StateMachine
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import outcome_names


@rule("SM201", "unreachable-state", Severity.ERROR)
def unreachable_state(context: Context) -> Iterator[Finding]:
    """No path leads to this state from the initial one.

    A part of the task that somebody wrote is never done, whatever happens: most often a
    recovery, or the release of what the robot holds.

    Wrong:
        name: sm
        template: Base
        outcomes: [picked, lost]
        states:
          - PICK:
              template: ScriptedState
              outcomes: [done, slipped]
              transitions: {done: picked, slipped: lost}
          - OPEN_GRIPPER:
              template: ScriptedState
              outcomes: [done]
              transitions: {done: lost}

    Right:
        name: sm
        template: Base
        outcomes: [picked, lost]
        states:
          - PICK:
              template: ScriptedState
              outcomes: [done, slipped]
              transitions: {done: picked, slipped: OPEN_GRIPPER}
          - OPEN_GRIPPER:
              template: ScriptedState
              outcomes: [done]
              transitions: {done: lost}
    """
    for path, container in context.linear:
        whole = mended(container)
        seen = reachable(whole)
        hidden = [child for child in container.children if child.name not in seen]
        before = _before(whole, frozenset(child.name for child in hidden)) if hidden else {}
        for child in hidden:
            yield Finding(
                span=child.span,
                message=f"`{child.name}` cannot be reached from `{container.initial}`, where"
                f" `{container.name}` starts",
                help=_why_unreachable(container, child, before.get(child.name, [])),
                related=calls(child, child.span),
                node=f"{path}/{child.name}",
            )


def _before(container: Linear, hidden: frozenset[str]) -> dict[str, list[str]]:
    """The states that lead to each hidden one, without itself; they are hidden as well."""
    before: dict[str, list[str]] = {}
    for edge in edges(container):
        if edge.target in hidden and edge.source != edge.target:
            before.setdefault(str(edge.target), []).append(str(edge.source))
    return before


def _why_unreachable(container: Linear, child: Node, before: list[str]) -> str:
    if before:
        return f"what leads to it cannot be reached either: {listed(before)}"
    if isinstance(container, Sequence):
        return (
            f"a sequence goes on with `{container.connector_outcome}`: has the state before it"
            " that outcome, without a transition of its own?"
        )
    return f"lead a transition to `{child.name}`, or take it out"


@rule("SM203", "impossible-outcome", Severity.WARNING)
def impossible_outcome(context: Context) -> Iterator[Finding]:
    """A container declares an outcome that nothing in it can bring about.

    What stands around it waits for a case that never comes. Often it is a failure: then failures
    are taken for something else.

    Wrong:
        name: sm
        template: Base
        outcomes: [picked, lost]
        states:
          - PICK:
              template: ScriptedState
              outcomes: [done, slipped]
              transitions: {done: picked, slipped: picked}

    Right:
        name: sm
        template: Base
        outcomes: [picked, lost]
        states:
          - PICK:
              template: ScriptedState
              outcomes: [done, slipped]
              transitions: {done: picked, slipped: lost}
    """
    for path, container in context.containers:
        possible = _possible_outcomes(container)
        for outcome in container.outcomes:
            if possible is not None and outcome.name not in (*possible, container.catches):
                yield _impossible(path, container, outcome)


def _possible_outcomes(container: Container) -> frozenset[str] | None:
    """The outcomes that something in a container brings about; None where a fault hides them."""
    if not container.children:
        return None
    match container:
        case StateMachine() | Sequence():
            return _linear_outcomes(container)
        case Concurrence():
            results = {entry.outcome for entry in container.rules}
            results.add(container.default_outcome)
            return _if_declared(container, results)
        case nodes.Iterator():
            return _iterator_outcomes(container)
    return assert_never(container)


def _if_declared(container: Container, results: set[str]) -> frozenset[str] | None:
    """Results, unless one is undeclared: then it may stand for the outcome that is missed."""
    return frozenset(results) if results.issubset(outcome_names(container)) else None


def _linear_outcomes(container: Linear) -> frozenset[str] | None:
    whole = mended(container)
    names = children_names(whole)
    exits = frozenset(outcome_names(whole))
    found: set[str] = set()
    for child in whole.children:
        if any(not leads_somewhere(step, names, exits) for step in child.transitions):
            return None
        if unhandled(child):
            return None
        found.update(step.target for step in child.transitions)
    handled = [
        frozenset(step.outcome for step in child.transitions)
        for child in whole.children
        if is_open(child)
    ]
    if handled:
        found |= exits.difference(frozenset.intersection(*handled))
    return frozenset(found)


def _iterator_outcomes(container: nodes.Iterator) -> frozenset[str] | None:
    if any(is_open(child) for child in container.children):
        return None
    if _if_declared(container, {result for _, _, result in endings(container)}) is None:
        return None
    found = {edge.target[1] for edge in edges(container) if isinstance(edge.target, tuple)}
    found.update(stopped_endings(container).values())
    # What SM208 speaks of was meant to bring about `preempted`.
    return frozenset(found | {PREEMPTED} if undeclared_stops(container) else found)


def _impossible(path: str, container: Container, outcome: Outcome) -> Finding:
    help = f"lead a transition to it, or take it out of the outcomes of `{container.name}`"
    severity = None
    if isinstance(container, Concurrence):
        help = f"give it a rule, or take it out of the outcomes of `{container.name}`"
        if outcome.name == PREEMPTED:
            # So it does in SMACH for Noetic, whatever the rules say (smach-semantics P10).
            help = "keep it where SMACH for Noetic runs the machine: there a preempt request does"
            severity = Severity.INFO
    if isinstance(container, nodes.Iterator):
        child = container.children[0].name
        help = f"it ends with the first item: no outcome of `{child}` is in `loop_outcomes`"
        if container.loop_outcomes:
            help = f"take it out of the outcomes of `{container.name}`"
    return Finding(
        span=outcome.span,
        message=f"nothing can end `{container.name}` with `{outcome.name}`",
        help=help,
        related=calls(container, outcome.span),
        severity=severity,
        node=path,
    )


@rule("SM205", "no-initial", Severity.ERROR, firm=True)
def no_initial(context: Context) -> Iterator[Finding]:
    """A container has no state to start with.

    SMACH refuses to run it: the robot stands still where the container was to work.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        initial: PIKC
        states:
          - PICK: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        initial: PICK
        states:
          - PICK: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}
    """
    for path, container in context.containers:
        if isinstance(container, Concurrence):
            continue
        if not container.children:
            yield Finding(
                span=container.span,
                message=f"`{container.name}` has no states",
                help="add a state, or take it out",
                related=calls(container, container.span),
                node=path,
            )
        elif not isinstance(container, nodes.Iterator):
            yield from _unknown_initial(path, container)


def _unknown_initial(path: str, container: Linear) -> Iterator[Finding]:
    names = [child.name for child in container.children]
    if container.initial in names:
        return
    guess = guesser(names)(container.initial)
    yield Finding(
        span=container.initial_span,
        message=f"`{container.name}` is to start with `{container.initial}`, which is none of its"
        " states",
        help=did_you_mean(guess) or f"its states are {listed(names)}",
        related=calls(container, container.initial_span),
        node=path,
    )
