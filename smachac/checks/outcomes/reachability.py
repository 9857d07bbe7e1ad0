"""Rules over reachability: of states, of the outcomes of containers, and initial states."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.analysis.context import Context
from smachac.analysis.control_flow import Linear, children_names, has_no_interface, unhandled_in
from smachac.analysis.iterator_stops import undeclared_stops
from smachac.checks.findings import notation
from smachac.checks.findings.edits import likely
from smachac.checks.findings.help_text import calls, did_you_mean, other_place, own_name
from smachac.checks.outcomes.hidden_conditions import hidden_conditions
from smachac.checks.outcomes.hidden_states import LedPast, hidden_groups
from smachac.checks.outcomes.iterator_endings import endings
from smachac.checks.outcomes.needed_variables import outcomes_without_variable
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.repair import Edit
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import both, listed
from smachac.ir import nodes
from smachac.ir.graph import edges, stopped_endings
from smachac.ir.nodes import (
    Concurrence,
    Container,
    Leaf,
    Node,
    Outcome,
    Sequence,
    StateMachine,
    Transition,
)
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.script_paths import name_in_script
from smachac.ir.traversal import ends_preempted, outcome_names


@rule(
    "SM201",
    "unreachable-state",
    Severity.ERROR,
    effect="the robot never does this part of its task",
)
def unreachable_state(context: Context) -> Iterator[Finding]:
    """No path leads to this state from the initial state of its container.

    The robot never does this part of its task. Often it is a recovery, or the state in which the
    gripper opens.

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
    for item in hidden_groups(context):
        if isinstance(item, Finding):
            yield item
            continue
        path, container, group = item.path, item.container, item.group
        child, way_out = group[0], item.way_out
        if item.past is not None:
            yield _passed(path, container, group, item.past)
            continue
        yield Finding(
            span=child.span,
            message=_unreached(container, group),
            arguments=(child.name,),
            help=_out_help(child, *way_out)
            if way_out is not None
            else _why_unreachable(container, group),
            related=(
                *(_out_places(container, *way_out) if way_out is not None else ()),
                *calls(child, child.span),
            ),
            node=f"{path}/{child.name}",
        )


def _unreached(container: Linear, group: list[Node]) -> str:
    return (
        f"{both(state.name for state in group)} cannot be reached from `{container.initial}`, the"
        f" initial state of `{container.name}`"
    )


def _out_help(child: Node, before: Node, step: Transition) -> str:
    added = notation.entry(before, step.outcome, child.name)
    return f"add `{added}` to the transitions of `{before.name}`"


def _out_places(container: Linear, before: Node, step: Transition) -> tuple[Related, ...]:
    text = f"`{step.outcome}` of `{before.name}` has no transition, so `{container.name}` ends"
    return other_place(before.span, text)


def _passed(path: str, container: Linear, group: list[Node], past: LedPast) -> Finding:
    """SM201 for states past which the state before them leads, or another one."""
    child, names = group[0], both(state.name for state in group)
    before, step = past.child, past.step
    several = len(group) > 1
    return Finding(
        span=child.span,
        message=_unreached(container, group),
        arguments=(child.name,),
        help=f"write `{notation.entry(before, step.outcome, child.name)}` in `{before.name}`, or"
        f" remove {names} if {'their' if several else 'its'} work is not needed",
        related=(
            *other_place(
                step.target_span,
                f"`{before.name}`, the state before, leads past {'them' if several else 'it'}",
            ),
            *calls(child, child.span),
        ),
        node=f"{path}/{child.name}",
        repairs=likely([Edit(span=step.target_span, text=child.name)], "lead to the state"),
    )


def _why_unreachable(container: Linear, group: list[Node]) -> str:
    if isinstance(container, Sequence):
        return (
            f"give the state before it the outcome `{container.connector_outcome}` without a"
            " transition: a sequence continues with that outcome"
        )
    names = both(state.name for state in group)
    return f"add a transition to `{group[0].name}`, or remove {names}"


@rule(
    "SM203",
    "impossible-outcome",
    Severity.WARNING,
    effect="a transition for this outcome is never taken",
)
def impossible_outcome(context: Context) -> Iterator[Finding]:
    """A container or a state has an outcome with which it can never end.

    What the script does after that outcome never happens. If the outcome is one of failure, a
    failure of the robot probably ends the container with another outcome.

    Exactly: a condition of a state counts as hidden if it compares one key with numbers, and an
    earlier one is true for each of these values: `ud.n > 3` before `ud.n > 5`. An outcome with
    `needs` in the interface of a state (such as `valid` of MonitorState, which needs `max_checks`)
    is reported if the variable has no value, and only this outcome leads to a state or an end of
    the container, or the rule of a concurrence contains it.

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
    yield from context.at_states(hidden_conditions)
    types = {name: type_ for name, type_ in context.machine.state_types.items() if type_.needs}
    for path, container in context.containers if types else ():
        yield from outcomes_without_variable(path, container, types)
    linear = iter(context.absorbed)
    again = {found.stop.path for found in context.stop_paths.again}
    for path, container in context.containers:
        whole = next(linear) if isinstance(container, StateMachine | Sequence) else container
        possible = _possible_outcomes(context, path, whole)
        # Where SM209 is reported, a state does not lead `preempted` out of the container.
        stops = path in again or ends_preempted(container)
        known = {container.catches, PREEMPTED if stops else ""}
        if possible is None:
            continue
        if path in context.traps and possible.isdisjoint(outcome_names(container)):
            continue  # SM202
        for outcome in container.outcomes:
            if outcome.name not in possible | known:
                yield _impossible(path, container, outcome)


def _possible_outcomes(context: Context, path: str, container: Container) -> frozenset[str] | None:
    """The outcomes with which an absorbed container can end; None where another fault makes that
    unknown."""
    if not container.children:
        return None
    match container:
        case StateMachine() | Sequence():
            if context.of_container(unhandled_in, path, container):
                return None
            return context.of_container(_linear_outcomes, path, container)
        case Concurrence():
            return context.of_container(_concurrence_outcomes, path, container)
        case nodes.Iterator():
            return context.of_container(_iterator_outcomes, path, container)
    return None


def _linear_outcomes(container: Linear) -> frozenset[str] | None:
    """The outcomes with which a state machine or sequence can end, if its states have a transition
    for each outcome; None if a transition leads nowhere."""
    names = children_names(container)
    exits = frozenset(outcome_names(container))
    found = {step.target for child in container.children for step in child.transitions}
    if not found <= names | exits:
        return None
    handled = [
        frozenset(step.outcome for step in child.transitions)
        for child in container.children
        if isinstance(child, Leaf) and child.open
    ]
    if handled:
        found |= exits.difference(frozenset.intersection(*handled))
    return frozenset(found)


def _concurrence_outcomes(container: Concurrence) -> frozenset[str] | None:
    results = {entry.outcome for entry in container.rules}
    results.add(container.default_outcome)
    return _if_declared(container, results)


def _if_declared(container: Container, results: set[str]) -> frozenset[str] | None:
    """Results, or None where one is undeclared: it may be meant for the declared outcome."""
    return frozenset(results) if results.issubset(outcome_names(container)) else None


def _iterator_outcomes(container: nodes.Iterator) -> frozenset[str] | None:
    if any(has_no_interface(child) for child in container.children):
        return None
    if _if_declared(container, {result for _, _, result in endings(container)}) is None:
        return None
    found = {edge.target[1] for edge in edges(container) if isinstance(edge.target, tuple)}
    found.update(stopped_endings(container).values())
    # Where SM208 is reported, `preempted` is what the iterator was meant to end with.
    return frozenset(found | {PREEMPTED} if undeclared_stops(container) else found)


def _impossible(path: str, container: Container, outcome: Outcome) -> Finding:
    name = name_in_script(container)
    removed = f"remove it from the outcomes of `{name}`"
    help = f"add a transition to `{outcome.name}`, or {removed}"
    severity = None
    effect = None
    if "/" not in path:
        effect = f"a caller of `{name}` that waits for this outcome never gets it"
    if isinstance(container, Concurrence):
        help = f"add a rule for `{outcome.name}`, or {removed}"
        if outcome.name == PREEMPTED:
            # docs/semantics.md, Preemption.
            help = (
                "keep it if the machine runs in SMACH for Noetic: there a preempt request ends"
                f" `{name}` with it"
            )
            severity = Severity.INFO
    if isinstance(container, nodes.Iterator):
        child = name_in_script(container.children[0])
        help = (
            f"list an outcome of `{child}` in `loop_outcomes`: without one, `{name}` ends"
            " after the first item"
        )
        if container.sugar:
            help = f"list an outcome of `{child}` in `on` of `{container.sugar}`: only on such an"
            help += " outcome the state runs again"
        elif container.loop_outcomes:
            help = removed
    return Finding(
        span=outcome.span,
        message=f"`{name}` can never end with its outcome `{outcome.name}`",
        arguments=(own_name(container, outcome.span), outcome.name),
        help=help,
        effect=effect if severity is None else "",
        related=calls(container, outcome.span),
        severity=severity,
        node=path,
    )


@rule(
    "SM205",
    "no-initial",
    Severity.ERROR,
    unsuppressible=True,
    effect="a container needs a state where it starts: SMACH stops it with an error",
)
def no_initial(context: Context) -> Iterator[Finding]:
    """A container has no states, or its initial state does not exist.

    SMACH reports an error when the container starts, and runs none of its states: the robot stops
    in the middle of its task.

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
            span = container.span
            if isinstance(container, StateMachine | Sequence) and not container.initial:
                span = container.initial_span  # that of the empty list
            yield Finding(
                span=span,
                message=f"`{container.name}` has no states",
                arguments=(container.name,),
                help="add a state to it"
                if notation.is_python(container)
                else f"write `states: [NAME: {{{_first_state(container)}}}]`",
                related=calls(container, span),
                node=path,
            )
        elif isinstance(container, StateMachine | Sequence):
            yield from _unknown_initial(path, container)


def _first_state(container: Container) -> str:
    """The fields of a state for a container without one."""
    target = next(iter(outcome_names(container)), "OUTCOME")
    if isinstance(container, nodes.Iterator):
        return "template: ScriptedState, outcomes: [done]"
    return f"template: ScriptedState, outcomes: [done], transitions: {{done: {target}}}"


def _unknown_initial(path: str, container: Linear) -> Iterator[Finding]:
    names = [child.name for child in container.children]
    if container.initial in names:
        return
    guess = guesser(names)(container.initial)
    yield Finding(
        span=container.initial_span,
        message=f"`initial` of `{container.name}` is `{container.initial}`, which is not one of its"
        " states",
        arguments=(own_name(container, container.initial_span), container.initial),
        help=did_you_mean(guess) or f"use one of its states: {listed(names)}",
        related=calls(container, container.initial_span),
        node=path,
    )
