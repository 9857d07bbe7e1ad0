"""Rules over the properties of a script (docs/properties.md)."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from smachac.analysis.context import Context
from smachac.analysis.failed_properties import failures
from smachac.analysis.outcome_rules import has_dead_rule
from smachac.analysis.property_turns import Turn
from smachac.checks.findings.edits import likely
from smachac.checks.findings.help_text import other_place
from smachac.checks.properties.event_names import name_fault
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.repair import Edit, Repair
from smachac.diagnostics.source import assert_never
from smachac.diagnostics.spelling import written_name
from smachac.ir.graph import reachable
from smachac.ir.nodes import Concurrence, Leaf, Node
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.properties import (
    After,
    AlwaysEnds,
    AtMost,
    Atoms,
    Before,
    Form,
    Never,
    Property,
    either,
    in_words,
)
from smachac.ir.script_paths import name_in_script, sugared_child, walk_script
from smachac.records import replace

if TYPE_CHECKING:
    from smachac.analysis.properties import Counterexample, Judgement, Visit
    from smachac.analysis.property_events import NameFault
    from smachac.interpreter.counterexample import Replay

_MOST_ALIKE = 5
"""The most further places of one unknown name that a finding shows."""

LONGEST_SCENARIO = 200
"""Limit on the characters of a scenario in a help line."""


def _with(context: Context, verdict: str) -> Iterator[Judgement]:
    """The properties with a verdict."""
    return (judgement for judgement in context.judgements if judgement.verdict == verdict)


@rule("SM701", "property-fails", Severity.ERROR)
def property_fails(context: Context) -> Iterator[Finding]:
    """A property of the script does not hold on all paths.

    The path shows how the robot comes to do what the property forbids. All outcomes are followed,
    exceptions that the script catches, stop requests and time limits. The scenario in the help line
    replays the path with `smachac run --mock`.

    Exactly: the finding is at the property; or at the transition that leads past the only state
    that the property requires after an event, if no transition leads to that state.

    Wrong:
        name: sm
        template: Base
        outcomes: [succeeded, aborted]
        properties:
          - before: {LIFT: GRASP}
        states:
          - FIND:
              template: ScriptedState
              outcomes: [found, held]
              transitions: {found: GRASP, held: LIFT}
          - GRASP:
              template: ScriptedState
              outcomes: [done, slipped]
              transitions: {done: LIFT, slipped: aborted}
          - LIFT: {template: ScriptedState, outcomes: [done], transitions: {done: succeeded}}

    Right:
        name: sm
        template: Base
        outcomes: [succeeded, aborted]
        properties:
          - before: {LIFT: GRASP}
        states:
          - FIND:
              template: ScriptedState
              outcomes: [found, held]
              transitions: {found: GRASP, held: succeeded}
          - GRASP:
              template: ScriptedState
              outcomes: [done, slipped]
              transitions: {done: LIFT, slipped: aborted}
          - LIFT: {template: ScriptedState, outcomes: [done], transitions: {done: succeeded}}
    """
    if not context.machine.properties:
        return
    from smachac.analysis.properties import witness

    script = shlex.quote(context.machine.root.span.source.name)
    for number, given, example, shown, turn in failures(context):
        span, related = given.span, _turn_place(turn)
        message = f"{_named(given)} does not hold: {_violation(given.form, example)}"
        if turn is not None and _leads_past(given, turn):
            span = turn.step.target_span
            related = other_place(given.span, f"{_named(given)} does not hold")
            message = f"this transition leads past {_named_states(turn.missed)}:"
            message += f" {_violation(given.form, example)}"
        yield Finding(
            span=span,
            message=message,
            arguments=(given.name, in_words(given.form)),
            help=f"{_cure(given.form, example, turn)}\n{_replayed(shown, number, script)}",
            related=related,
            path=witness(example._replace(visits=_shown(context, example))),
            node=example.node or context.machine.root.name,
            repairs=_exchanged(given.form),
        )


def _exchanged(form: Form) -> tuple[Repair, ...]:
    """The repair that exchanges the two events of a property."""
    match form:
        case Before(later=(one,), earlier=(other,)) | Never(after=(one,), until=(other,)):
            first, second = one.span, other.span
            edits = (Edit(span=first, text=second.text), Edit(span=second, text=first.text))
            return likely(edits, "exchange the two events")
    return ()


def _named(given: Property) -> str:
    """A property as the subject of a message."""
    unnamed = given.name == in_words(given.form)
    return "this property" if unnamed else f"the property `{given.name}`"


def _violation(form: Form, example: Counterexample) -> str:
    """What happens at the end of a counterexample."""
    name = example.node.rpartition("/")[2]
    entered = f"`{name}` is entered"
    event = entered if example.outcome is None else f"`{name}` ends with `{example.outcome}`"
    match form:
        case Never(after=after, until=until):
            since = f" after {either(after)}" if after else ""
            return f"{event}{since}{' and' * bool(since and until)}{_before(until)}"
        case Before(earlier=earlier):
            return f"{event}{_before(earlier)}"
        case After(first=first, answer=answer, within=within) if example.node:
            if within and not example.outcome:
                states = f"{within} state{'s' * (within != 1)}"
                late = f"{either(answer)} does not come within {states} after"
                return f"{late} {either(first)}: {entered} first"
            return f"{event}{_before(answer)}"
        case After(first=first, answer=answer):
            return f"the run ends without {either(answer)} after {either(first)}"
        case AtMost(times=times):
            return f"{event} {times + 1} times"
        case AlwaysEnds():
            if example.again >= 0:
                repeated = example.visits[example.again].path.rpartition("/")[2]
                return f"`{repeated}` can be repeated without end"
            return "the run waits without end in a state that has no outcome"
    return assert_never(form)


def _before(events: Atoms) -> str:
    return f" before {either(events)}" if events else ""


_CORRECT = "correct the property if this path is right"


def _shown(context: Context, example: Counterexample) -> tuple[Visit, ...]:
    """The visits as the script shows them, without those of pauses and timers.

    A pause or timer at which a stop request arrives, and a timer that ends its state, are shown as
    an outcome of their state. A timer is kept where its state has states inside, of which some are
    visited after it, and where the property is about the end of the state inside.
    """
    added = {path.full for path in walk_script(context.machine.root) if path.added}
    containers = dict(context.containers) if added else {}
    shown: list[Visit] = []
    skipped = ""  # the state that a timer ended, until its own visit
    for visit in example.visits:
        if visit.path not in added:
            if visit.path != skipped:
                shown.append(visit)
            skipped = ""
            continue
        outside = visit.path.rpartition("/")[0]
        holder = containers[outside]
        ended = isinstance(holder, Concurrence) and visit.outcome != PREEMPTED
        inside = sugared_child(holder)
        if inside is None or not (ended or visit.stop):
            continue
        path = f"{outside}/{inside.name}"
        if path == example.node or (ended and not isinstance(inside, Leaf)):
            shown.append(visit)
            continue
        if shown and shown[-1].path == path and visit.stop:
            shown.pop()
        outcome = visit.outcome
        if isinstance(holder, Concurrence) and not visit.stop:
            outcome = holder.default_outcome  # the time is over
        shown.append(visit._replace(path=path, outcome=outcome))
        skipped = path if ended else ""
    return tuple(shown)


def _leads_past(given: Property, turn: Turn) -> bool:
    """Whether a transition of the same file leads past a state to which nothing leads."""
    place = turn.step.target_span.source
    return turn.unled and len(turn.missed) == 1 and place is given.span.source


def _turn_place(turn: Turn | None) -> tuple[Related, ...]:
    """The transition at which the path leaves the required way, as a related place."""
    if turn is None:
        return ()
    target = f"this transition leads to `{turn.step.target}`"
    if turn.missed:
        target += f", not to {_named_states(turn.missed)}"
    return other_place(turn.step.target_span, target)


def _named_states(states: Sequence[Node]) -> str:
    return " or ".join(f"`{node.name}`" for node in states)


def _cure(form: Form, example: Counterexample, turn: Turn | None) -> str:
    """What to do about a property that fails."""
    if turn is not None and turn.missed:
        outcome = written_name(turn.step.outcome)
        way = f"write `{outcome}: {turn.missed[0].name}` in `{turn.node.name}`"
        if len(turn.missed) > 1:
            states = _named_states(turn.missed)
            way = f"lead `{turn.step.outcome}` of `{turn.node.name}` to {states}"
        return f"{way}, or {_CORRECT}"
    raised = bool(example.visits) and example.visits[-1].outcome is None
    match form:
        case Never(until=until, enter=enter):
            through = f" through {either(until)}, or" if until else ""
            return f"lead this path{through} away from {either(enter)}, or {_CORRECT}"
        case Before(later=later, earlier=earlier):
            return f"lead each path to {either(later)} through {either(earlier)}, or {_CORRECT}"
        case After(first=first, answer=answer):
            on_error = ", also the exceptions, with `error: TARGET` in `transitions`" * raised
            way = f"lead each path from {either(first)} through {either(answer)}{on_error}"
            return f"{way}, or {_CORRECT}"
        case AtMost() | AlwaysEnds():
            if turn is None:
                return "limit the number of tries, for example with `retry` in a state of the path"
            name, outcome = turn.node.name, turn.step.outcome
            return (
                f"limit the number of tries, for example in `{name}`: write"
                f" `retry: {{on: [{outcome}], max: 3}}` in place of the transition"
                f" `{outcome}: {turn.step.target}`, and add a transition for `exhausted`"
            )
    return assert_never(form)


def _replayed(shown: Replay, number: int, script: str) -> str:
    """How the counterexample of the property with a number is replayed."""
    turns = f" --schedule {','.join(shown.schedule)}" if shown.schedule else ""
    text = shown.flow
    if len(text) + len(turns) > LONGEST_SCENARIO:
        option = f"--properties --scenario {number}"
        return f"to replay this path: `smachac explain {script} {option}` prints it as a scenario"
    run = f"smachac run {script} --mock path.yml{turns}"
    return f"to replay this path: write `{text}` into `path.yml`, then `{run}`"


@rule(
    "SM702",
    "property-vacuous",
    Severity.WARNING,
    effect="a change of the script that breaks the intention is not noticed",
)
def property_vacuous(context: Context) -> Iterator[Finding]:
    """A property holds only because what it is about cannot happen.

    The property checks nothing, so a change of the script that breaks the intention is not noticed.
    Often the property has the name of another state than the one that was meant.

    Exactly: no path reaches the event that the property is about: `after` of `never`, the first
    event of `before`, `after` and `whenever`, the event of `at_most`. A state that cannot be
    reached in its own container is reported by SM201, an outcome of a concurrence without a rule
    by SM203.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        properties:
          - after: {"GRASP:preempted": LET_GO}
            stops: false
        states:
          - GRASP:
              template: ScriptedState
              outcomes: [done, preempted]
              transitions: {done: LET_GO, preempted: LET_GO}
          - LET_GO: {template: ScriptedState, outcomes: [done], transitions: {done: done}}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        properties:
          - after: {"GRASP:preempted": LET_GO}
        states:
          - GRASP:
              template: ScriptedState
              outcomes: [done, preempted]
              transitions: {done: LET_GO, preempted: LET_GO}
          - LET_GO: {template: ScriptedState, outcomes: [done], transitions: {done: done}}
    """
    vacuous = list(_with(context, "vacuous"))
    unreachable = _unreachable(context) if vacuous else ()
    dead = {path for path, node in context.containers if vacuous
            and isinstance(node, Concurrence) and has_dead_rule(node)}  # fmt: skip
    for judgement in vacuous:
        if any(f"{state}/".startswith(unreachable) or state in dead for state in judgement.states):
            continue
        if _has_lost_rules(context, judgement):
            continue  # SM203
        yield Finding(
            span=judgement.property.span,
            message=f"{_named(judgement.property)} checks nothing: no path leads to"
            f" {_premise(judgement.property)}",
            arguments=(judgement.property.name, in_words(judgement.property.form)),
            help=_missing_event(judgement.property),
        )


def _has_lost_rules(context: Context, given: Judgement) -> bool:
    """Whether the events that a property is about are outcomes of concurrences that none of their
    rules has."""
    events = _premises(given.property)
    if not all(atom.subject == "path" and atom.outcome for atom in events):
        return False
    known = dict(context.containers)
    named = [known[path] for path in given.states if path in known]
    return bool(events) and all(
        any(
            isinstance(node, Concurrence)
            and name_in_script(node) == atom.name.rpartition("/")[2]
            and atom.outcome not in {node.default_outcome, *(other.outcome for other in node.rules)}
            for node in named
        )
        for atom in events
    )


def _missing_event(given: Property) -> str:
    """What to do about a property whose event does not occur."""
    if not given.stops and PREEMPTED in _premise(given):
        return f"remove `stops: false`: `{PREEMPTED}` occurs only after a stop request"
    return "name the event that was meant, or add the transition that leads to it"


def _unreachable(context: Context) -> tuple[str, ...]:
    """The paths of the states that cannot be reached in their container, each with a slash."""
    return tuple(
        f"{path}/{child.name}/"
        for path, container in context.containers
        for found in [reachable(container)]
        for child in container.children
        if child.name not in found
    )


def _premises(given: Property) -> Atoms:
    """The events that a property is about."""
    match given.form:
        case Never(after=atoms) | Before(later=atoms) | After(first=atoms) | AtMost(event=atoms):
            return atoms
    return ()


def _premise(given: Property) -> str:
    """The event that a property is about, in words."""
    events = _premises(given)
    return either(events) if events else "it"


@rule(
    "SM703",
    "unknown-event",
    Severity.ERROR,
    effect="this property is not checked until the name is right",
)
def unknown_event(context: Context) -> Iterator[Finding]:
    """A property names no state of the script, or several, or an outcome that the state never has.

    A property whose names are not clear is not checked: the script would pass a check that nobody
    made.

    Exactly: a path may be shortened to its end where one state has it. Tags, types and claims may
    have several states.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        properties:
          - before: {LIFT: GRAPS}
        states:
          - GRASP: {template: ScriptedState, outcomes: [done], transitions: {done: LIFT}}
          - LIFT: {template: ScriptedState, outcomes: [done], transitions: {done: done}}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        properties:
          - before: {LIFT: GRASP}
        states:
          - GRASP: {template: ScriptedState, outcomes: [done], transitions: {done: LIFT}}
          - LIFT: {template: ScriptedState, outcomes: [done], transitions: {done: done}}
    """
    alike: dict[tuple[str, ...], list[NameFault]] = {}
    for fault in (fault for judgement in _with(context, "unclear") for fault in judgement.faults):
        which = fault.kind, fault.atom.subject, fault.atom.name, fault.atom.outcome or ""
        alike.setdefault(which, []).append(fault)
    for first, *others in alike.values():
        found = name_fault(first, context)
        spans = [*dict.fromkeys(fault.atom.span for fault in others)][:_MOST_ALIKE]
        more = [part for span in spans for part in other_place(span, "and here")]
        yield replace(found, related=(*found.related, *more))


@rule("SM704", "property-undecided", Severity.WARNING)
def property_undecided(context: Context) -> Iterator[Finding]:
    """The branches of concurrences can interleave in too many ways to check a property.

    Nothing is known about the property: it may hold or fail.

    Exactly: the check gives up after 50,000 combinations of the positions of all branches, and
    30 more for each state of the script.

    Wrong:
        name: sm
        template: Base
        outcomes: [done, aborted]
        properties:
          - at_most: {A: 1}
        states:
          - ALL:
              template: Concurrence
              outcomes: [done, aborted]
              default_outcome: aborted
              outcome_map: {done: {A: done, B: done, C: done, D: done}}
              states:
                - A: {template: ScriptedState, outcomes: [done, slip], retry: {on: [slip], max: 30}}
                - B: {template: ScriptedState, outcomes: [done, slip], retry: {on: [slip], max: 30}}
                - C: {template: ScriptedState, outcomes: [done, slip], retry: {on: [slip], max: 30}}
                - D: {template: ScriptedState, outcomes: [done, slip], retry: {on: [slip], max: 30}}

    Right:
        name: sm
        template: Base
        outcomes: [done, aborted]
        properties:
          - at_most: {A: 1}
        states:
          - ALL:
              template: Concurrence
              outcomes: [done, aborted]
              default_outcome: aborted
              outcome_map: {done: {A: done, B: done, C: done, D: done}}
              states:
                - A: {template: ScriptedState, outcomes: [done, slip], retry: {on: [slip], max: 3}}
                - B: {template: ScriptedState, outcomes: [done, slip], retry: {on: [slip], max: 3}}
                - C: {template: ScriptedState, outcomes: [done, slip], retry: {on: [slip], max: 3}}
                - D: {template: ScriptedState, outcomes: [done, slip], retry: {on: [slip], max: 3}}
    """
    for judgement in _with(context, "undecided"):
        yield Finding(
            span=judgement.property.span,
            message=f"{_named(judgement.property)} cannot be checked: the branches of this script"
            " can interleave in too many ways",
            arguments=(judgement.property.name, in_words(judgement.property.form)),
            help="use fewer or shorter branches, or state it for a smaller part of the task",
        )
