"""Rules over outcomes: whether each leads somewhere and is declared where it ends up."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from smachac.analysis.context import Context
from smachac.analysis.control_flow import Linear, places_of, unknown_outcomes
from smachac.checks.messages import calls, did_you_mean, other_place
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.ir import nodes
from smachac.ir.nodes import Concurrence, Node, Outcome, Transition
from smachac.ir.outcome_names import PREEMPTED, is_failure
from smachac.ir.traversal import outcome_names


@rule("SM103", "undeclared-container-outcome", Severity.ERROR, firm=True)
def undeclared_container_outcome(context: Context) -> Iterator[Finding]:
    """A concurrence or iterator can end with an outcome that it does not declare.

    What stands around it has no transition for that, so the machine stops there.

    Wrong:
        name: sm
        template: Base
        outcomes: [ready, failed]
        states:
          - BOTH:
              template: Concurrence
              outcomes: [ready, failed]
              default_outcome: failed
              outcome_map:
                ready: {LEFT: done, RIGHT: done}
                partly: {LEFT: done, RIGHT: slipped}
              states:
                - LEFT: {template: ScriptedState, outcomes: [done]}
                - RIGHT: {template: ScriptedState, outcomes: [done, slipped]}
              transitions: {ready: ready, failed: failed}

    Right:
        name: sm
        template: Base
        outcomes: [ready, failed]
        states:
          - BOTH:
              template: Concurrence
              outcomes: [ready, partly, failed]
              default_outcome: failed
              outcome_map:
                ready: {LEFT: done, RIGHT: done}
                partly: {LEFT: done, RIGHT: slipped}
              states:
                - LEFT: {template: ScriptedState, outcomes: [done]}
                - RIGHT: {template: ScriptedState, outcomes: [done, slipped]}
              transitions: {ready: ready, partly: failed, failed: failed}
    """
    for path, container in context.containers:
        if isinstance(container, Concurrence):
            yield from _undeclared_results(path, container)
        elif isinstance(container, nodes.Iterator):
            yield from _undeclared_endings(path, container)


def _undeclared_results(path: str, container: Concurrence) -> Iterator[Finding]:
    results = [("its outcome map", entry.outcome, entry.span) for entry in container.rules]
    if container.default_outcome:
        results.append(("`default_outcome`", container.default_outcome, container.default_span))
    declared = frozenset(outcome_names(container))
    guess = places_of(container)
    for source, name, span in results:
        if name not in declared:
            meant = guess(name)
            yield Finding(
                span=span,
                message=f"`{container.name}` has no outcome `{name}`, which {source} gives",
                help=did_you_mean(meant if meant in declared else None)
                or f"add it to the outcomes of `{container.name}`",
                related=calls(container, span),
                node=path,
            )


def endings(container: nodes.Iterator) -> Iterator[tuple[str, str, str]]:
    """What an iterator can end with: the state that brings it about (empty when the items are
    used up), its outcome, and the outcome of the iterator."""
    renamed = dict(container.final_map)
    exhausted = container.exhausted_outcome
    yield "", exhausted, renamed.get(exhausted, exhausted)
    loops = frozenset(container.loop_outcomes)
    for child in container.children:
        for name in outcome_names(child):
            if name not in loops:
                yield child.name, name, renamed.get(name, name)


def _undeclared_endings(path: str, container: nodes.Iterator) -> Iterator[Finding]:
    declared = frozenset(outcome_names(container))
    for child, outcome, result in endings(container):
        if result in declared:
            continue
        why = f"when `{child}` ends with `{outcome}`" if child else "after the last item"
        renamed = "" if not child else ", let it loop, or rename it in `final_outcome_map`"
        yield Finding(
            span=container.span,
            message=f"`{container.name}` has no outcome `{result}`, which it ends with {why}",
            help=f"add it to the outcomes of `{container.name}`{renamed}",
            related=calls(container, container.span),
            node=path,
        )


@rule("SM104", "unhandled-outcome", Severity.ERROR, firm=True)
def unhandled_outcome(context: Context) -> Iterator[Finding]:
    """An outcome of a state has no transition, and its container has no outcome of that name.

    When the state ends so, nobody has said what comes next: SMACH stops with an error, wherever
    the arm is.

    Wrong:
        name: sm
        template: Base
        outcomes: [picked, lost]
        states:
          - PICK:
              template: ScriptedState
              outcomes: [done, slipped, blocked]
              transitions: {done: picked, slipped: lost}

    Right:
        name: sm
        template: Base
        outcomes: [picked, lost]
        states:
          - PICK:
              template: ScriptedState
              outcomes: [done, slipped, blocked]
              transitions: {done: picked, slipped: lost, blocked: lost}
    """
    for path, container in context.linear:
        for child in container.children:
            for outcome in unhandled(child):
                yield _unhandled(path, container, child, outcome)


def unhandled(child: Node) -> list[Outcome]:
    """The outcomes of a state that lead nowhere, without those that a misspelt transition means."""
    handled = {step.outcome for step in child.transitions}
    if all(outcome.name in handled for outcome in child.outcomes):
        return []
    handled.update(meant for _, meant in unknown_outcomes(child) if meant)
    return [outcome for outcome in child.outcomes if outcome.name not in handled]


def _unhandled(path: str, container: Linear, child: Node, outcome: Outcome) -> Finding:
    # An interface may lie in another folder on another machine: only the script's own place counts.
    inside = outcome.span.source is child.span.source
    return Finding(
        span=child.span,
        message=f"outcome `{outcome.name}` of `{child.name}` leads nowhere: it has no transition,"
        f" and `{container.name}` has no such outcome",
        help=f"add `{outcome.name}:` to the transitions of `{child.name}`, or `{outcome.name}` to"
        f" the outcomes of `{container.name}`",
        related=(
            *(other_place(outcome.span, "declared here") if inside else ()),
            *calls(child, child.span),
        ),
        node=f"{path}/{child.name}",
    )


@rule("SM105", "implicit-exit", Severity.INFO)
def implicit_exit(context: Context) -> Iterator[Finding]:
    """An outcome ends the machine only because both have an outcome of that name.

    Nothing is wrong with that, unless it was forgotten: a failure that leaves by its name, while
    the success beside it has a transition, is a warning. The robot would stop without a recovery.

    Wrong:
        name: sm
        template: Base
        outcomes: [placed, failed]
        states:
          - PICK:
              template: ScriptedState
              outcomes: [done, failed]
              transitions: {done: PLACE}
          - PLACE:
              template: ScriptedState
              outcomes: [done]
              transitions: {done: placed}

    Right:
        name: sm
        template: Base
        outcomes: [placed, failed]
        states:
          - PICK:
              template: ScriptedState
              outcomes: [done, failed]
              transitions: {done: PLACE, failed: failed}
          - PLACE:
              template: ScriptedState
              outcomes: [done]
              transitions: {done: placed}
    """
    for path, container in context.linear:
        for child in container.children:
            if container.sugar:
                continue
            steps = [step for step in child.transitions if step.origin == "implicit"]
            if steps:
                yield from _implicit(path, container, child, steps)


def _implicit(
    path: str, container: Linear, child: Node, steps: Iterable[Transition]
) -> Iterator[Finding]:
    misspelt = {meant for _, meant in unknown_outcomes(child)}
    beside = any(
        step.origin == "written" and not is_failure(step.outcome) and step.outcome != PREEMPTED
        for step in child.transitions
    )
    for step in steps:
        if step.outcome in misspelt:
            continue
        forgotten = beside and is_failure(step.outcome)
        yield Finding(
            span=step.span,
            message=f"`{step.outcome}` of `{child.name}` has no transition: by its name alone it"
            f" ends `{container.name}`",
            help=f"write `{step.outcome}: {step.target}` if that is meant, or lead it to a state"
            " that recovers"
            if forgotten
            else None,
            related=calls(child, step.span),
            severity=Severity.WARNING if forgotten else None,
            node=f"{path}/{child.name}",
        )
