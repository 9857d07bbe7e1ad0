"""Rules over names: of the states, and of the states and outcomes that transitions refer to."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from functools import cached_property
from itertools import count, islice
from typing import NamedTuple

from smachac.analysis.context import Context
from smachac.analysis.control_flow import (
    Linear,
    children_names,
    dangling_transitions,
    has_no_interface,
    places_of,
    unknown_outcomes,
)
from smachac.checks.findings import notation
from smachac.checks.findings.condition_outcomes import unknown_endings
from smachac.checks.findings.edits import adding_outcome, likely
from smachac.checks.findings.help_text import calls, did_you_mean, other_place, own_name
from smachac.checks.names.other_outcomes import (
    missing_default,
    other_outcome,
    suggested_outcomes,
)
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.diagnostics.repair import Certainty, Repair
from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.spelling import MOST_EXPLAINED, Guesser, guesser, respelt
from smachac.diagnostics.wording import both, listed
from smachac.ir import nodes
from smachac.ir.nodes import Concurrence, Container, Leaf, Node, Transition
from smachac.ir.outcome_names import OF_SMACH
from smachac.ir.script_paths import role, sugared_child
from smachac.ir.traversal import outcome_names, written_children
from smachac.records import replace

EXCEPTIONS = "error"
"""The name by which a script refers to the exceptions of a state (docs/language.md)."""


MOST_PROPOSED = 3
"""The most names that are proposed in place of a word."""


class _Targets:
    """The targets in a container, for its transitions with an unknown one."""

    def __init__(self, container: Linear) -> None:
        self.container = container

    @cached_property
    def listed(self) -> str:
        """The names that a transition can have as its target."""
        return listed([*self.states, *outcome_names(self.container)])

    @cached_property
    def states(self) -> frozenset[str]:
        return frozenset([child.name for child in written_children(self.container)])

    @cached_property
    def guess(self) -> Guesser:
        """The guesser for targets."""
        return places_of(self.container)

    @cached_property
    def all_upper(self) -> bool:
        """Whether all names of states are in upper case."""
        return all(name.isupper() for name in self.states)

    @cached_property
    def unentered(self) -> Mapping[str, tuple[Span, ...]]:
        """The places of the states that no transition leads to."""
        found: dict[str, tuple[Span, ...]] = {}
        for child in written_children(self.container):
            if child.name not in self.places and child.name != self.container.initial:
                found[child.name] = (*found.get(child.name, ()), child.span)
        return found

    @cached_property
    def unused(self) -> tuple[str, ...]:
        """Some states and outcomes to which no transition leads."""
        ends = (name for name in outcome_names(self.container) if name not in self.places)
        return tuple(islice(dict.fromkeys((*self.unentered, *ends)), MOST_PROPOSED))

    @cached_property
    def places(self) -> Mapping[str, set[Span]]:
        """The places where each target is written."""
        found: dict[str, set[Span]] = {}
        for child in self.container.children:
            for step in child.transitions:
                found.setdefault(step.target, set()).add(step.target_span)
        return found


class _Lost(NamedTuple):
    """A transition with an unknown target."""

    path: str
    container: Linear
    targets: _Targets
    child: Node
    step: Transition

    @property
    def unique_match(self) -> str | None:
        """The only known name one slip away."""
        return self.targets.guess.unique_match(self.step.target)


@rule("SM101", "unknown-target", Severity.ERROR, unsuppressible=True)
def unknown_target(context: Context) -> Iterator[Finding]:
    """The target of a transition is neither a state nor an outcome of the same container.

    SMACH reports an error when the container starts, and runs none of its states: the robot stops
    in the middle of its task.

    Exactly: a transition in a branch of a concurrence or in the child of an iterator is never
    taken, whatever its target; that is a warning.

    Wrong:
        name: sm
        template: Base
        outcomes: [stacked]
        states:
          - PICK_BLOCK:
              template: ScriptedState
              outcomes: [done]
              transitions: {done: PALCE_BLOCK}
          - PLACE_BLOCK:
              template: ScriptedState
              outcomes: [done]
              transitions: {done: stacked}

    Right:
        name: sm
        template: Base
        outcomes: [stacked]
        states:
          - PICK_BLOCK:
              template: ScriptedState
              outcomes: [done]
              transitions: {done: PLACE_BLOCK}
          - PLACE_BLOCK:
              template: ScriptedState
              outcomes: [done]
              transitions: {done: stacked}
    """
    lost = [fault for path, container in context.misnamed for fault in _lost(path, container)]
    paths: dict[str, str] = {}
    for path, node in context.states if lost else ():
        paths.setdefault(node.name, context.plain_paths.get(path, path))
    alike: dict[tuple[object, ...], list[_Lost]] = {}
    for at, fault in enumerate(lost):
        target = fault.step.target
        alike.setdefault((fault.path, target or at, fault.child.via), []).append(fault)
    for first, *others in alike.values():
        yield _with_others(_nowhere(first, paths.get(first.step.target)), others)
    for path, container in context.containers:
        if isinstance(container, Concurrence | nodes.Iterator):
            yield from _idle_transitions(context, path, container)


def _lost(path: str, container: Linear) -> Iterator[_Lost]:
    targets = _Targets(container)
    copied = copied_name(container)
    names, exits = children_names(container), frozenset(outcome_names(container))
    lost = (
        (child, step)
        for child in container.children
        for step in dangling_transitions([child], names, exits)
    )
    for child, step in lost:
        if not _was_reported(step) and step.target != copied:  # SM106
            yield _Lost(path, container, targets, child, step)


def copied_name(container: Container) -> str | None:
    """The name that one of two states of the same name should have: the only unknown target of
    transitions in their container, if it is not a misspelt name."""
    names = children_names(container)
    is_linear = isinstance(container, nodes.StateMachine | nodes.Sequence)
    if not is_linear or len(container.children) - len(names) != 1:
        return None
    exits = frozenset(outcome_names(container))
    targets = {step.target for step in dangling_transitions(container.children, names, exits)}
    target = targets.pop() if len(targets) == 1 else None
    return target if target and places_of(container).unique_match(target) is None else None


def _was_reported(step: Transition) -> bool:
    """Whether a transition has no target because its look-up failed (SM015)."""
    return not step.target and step.target_span.text not in ("''", '""', "")


MOST_ALIKE = 5
"""The most further transitions to one unknown target that a finding shows."""


def _with_others(found: Finding, others: list[_Lost]) -> Finding:
    """The finding on the first of several transitions with one unknown target, with the others."""
    places = dict.fromkeys(other.step.target_span for other in others)
    places.pop(found.span, None)
    more = [part for span in [*places][:MOST_ALIKE] for part in other_place(span, "and here")]
    words = [Word(other.step.target, other.step.target_span) for other in others]
    edits = [edit for word in words if word.span in places
             for edit in respelt(word, others[0].unique_match)]  # fmt: skip
    return replace(
        found,
        related=(*found.related, *more),
        edits=(*found.edits, *edits) if found.edits else (),
    )


def _add_or_use(fault: _Lost) -> str:
    """The help for an unknown target that no name resembles: a state that is missing, if it is
    written like one, or the only state to which no transition leads."""
    container, target = fault.container, fault.step.target
    known = f"use a state or an outcome of `{container.name}`: {fault.targets.listed}"
    if not target.isupper() or not fault.targets.all_upper:
        return known
    if len(fault.targets.unentered) == 1:
        (other,) = fault.targets.unentered
        return f"write `{other}`, to which no transition leads, or add the state `{target}`"
    return f"add the state `{target}`, or {known}"


def _nowhere(fault: _Lost, elsewhere: str | None) -> Finding:
    """SM101 for a transition; `elsewhere` is the path of a state of the name of its target in
    another container."""
    path, container, targets, child, step = fault
    sure = fault.unique_match
    whole = f"`{step.target}` is neither a state nor an outcome of `{container.name}`"
    if not step.target:
        whole = f"the transition for outcome `{step.outcome}` of `{child.name}` has no target"
    above = elsewhere.rpartition("/")[0] if elsewhere else ""
    near = (sure or targets.guess(step.target)) if step.target else None
    help = did_you_mean(near)
    if above:
        help = _through_outcome(fault, above)
        sure = None
    if step.target in OF_SMACH or (sure is not None and not _same_case(step.target, sure)):
        sure = None  # a name that is like an outcome of SMACH is rather the misspelt one
    if sure not in targets.places and len(targets.places[step.target]) > 1:
        sure = None  # a name with several uses is rather right, and the known name misspelt
    return Finding(
        span=step.target_span,
        message=whole,
        arguments=(
            own_name(container, step.target_span),
            step.target,
            *(() if step.target else (step.outcome,)),
        ),
        help=help or _add_or_use(fault),
        effect="SMACH refuses to run such a container: none of its states runs",
        related=calls(child, step.target_span),
        node=f"{path}/{child.name}",
        edits=respelt(Word(step.target, step.target_span), sure),
        repairs=(*_as_outcome(fault), *(_unused_targets(fault) if near is None else ())),
    )


def _unused_targets(fault: _Lost) -> Iterator[Repair]:
    """The repairs that lead the transition to a state or an outcome to which nothing leads. Each is
    only possible: the unknown target can be a state that is missing."""
    word = Word(fault.step.target, fault.step.target_span)
    return _other_words(word, fault.targets.unused)


def _other_words(word: Word, names: Sequence[str]) -> Iterator[Repair]:
    """The repairs, only possible, that write one of these names in place of a word."""
    for edits in filter(None, (respelt(word, name) for name in names[:MOST_PROPOSED])):
        yield Repair(edits=edits, certainty=Certainty.POSSIBLE, operator="write another name")


def _as_outcome(fault: _Lost) -> tuple[Repair, ...]:
    """The repair that adds an unknown target of several transitions, or one that the transitions of
    the container name, to the outcomes of the container."""
    container, target = fault.container, fault.step.target
    is_used = len(fault.targets.places.get(target, ())) > 1
    if target.isupper() or not (is_used or any(s.outcome == target for s in container.transitions)):
        return ()
    return adding_outcome(container, target)


def _through_outcome(fault: _Lost, above: str) -> str:
    """The help for a transition to a state in another container: it leads there through an outcome
    of its own container; an outcome that has another use does not get a second one."""
    container, step, used = fault.container, fault.step, fault.targets.places
    target, name = step.target, container.name
    for outer in container.transitions:
        if outer.target == target and outer.outcome in used:
            own = step.outcome
            return (
                f"add the outcome `{own}` to `{name}`, write"
                f" `{notation.entry(container, own, own)}` here, and"
                f" `{notation.entry(container, own, target)}` in the transitions of `{name}`"
            )
        if outer.target == target:
            right = notation.entry(container, step.outcome, outer.outcome)
            return f"write `{right}`: the outcome `{outer.outcome}` of `{name}` leads to `{target}`"
    return (
        f"use a state or an outcome of `{name}`: {fault.targets.listed}; the state `{target}` in"
        f" `{above}` cannot be a target here"
    )


def _same_case(word: str, name: str) -> bool:
    """Whether a misspelt target and a name have the same case. By convention states are in upper
    case and outcomes in lower case, so `ABORTED` is a missing state rather than `aborted`."""
    same = word.isupper() == name.isupper() and word.islower() == name.islower()
    return same and word.casefold() != name.casefold()


def _idle_transitions(context: Context, path: str, container: Container) -> Iterator[Finding]:
    """The transitions of the children of a concurrence or an iterator, except those of a sub-script
    that a state machine calls as well."""
    why = "an iterator repeats its child or ends"
    help = "remove it: `loop_outcomes` lists the outcomes that continue the loop"
    if isinstance(container, Concurrence):
        why = "the branches of a concurrence start together"
        help = (
            f"remove it: the rules in `outcome_map` decide how `{container.name}` ends; for an"
            " order put the states into a Sequence in one branch"
        )
    for child in container.children:
        steps = [step for step in child.transitions if step.origin == "written"]
        if steps and not (child.via and _is_taken_elsewhere(context, steps[0].span)):
            first, several = steps[0], len(steps) > 1
            what = f"transition{'s' * several} for {both(step.outcome for step in steps)}"
            yield Finding(
                span=first.span,
                message=f"the {what} {'are' if several else 'is'} never taken: {why}",
                arguments=(own_name(child, first.span), first.target, first.outcome),
                help=help.replace("it:", "them:", 1) if several else help,
                related=calls(child, first.span),
                severity=Severity.WARNING,
                node=f"{path}/{child.name}",
            )


def _is_taken_elsewhere(context: Context, span: Span) -> bool:
    """Whether the transition with a place is one of a state in a container with transitions."""
    return any(
        step.span == span
        for _, container in context.containers
        if not isinstance(container, Concurrence | nodes.Iterator)
        for child in container.children
        for step in child.transitions
    )


@rule(
    "SM102",
    "unknown-outcome",
    Severity.ERROR,
    unsuppressible=True,
    effect="SMACH refuses such a transition: the program stops with InvalidTransitionError",
)
def unknown_outcome(context: Context) -> Iterator[Finding]:
    """A transition is for an outcome that its state does not have.

    The transition is never taken. If it was written as a recovery, the robot has no recovery.

    Exactly: also the condition of a ConditionalOutcomeState and the step of a ScriptedState for
    such an outcome, and an entry of `loop_outcomes` that is not an outcome of the child.

    Wrong:
        name: sm
        template: Base
        outcomes: [picked, lost]
        states:
          - PICK:
              template: ScriptedState
              outcomes: [done, slipped]
              transitions: {done: picked, sliped: lost}

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
    misnamed = frozenset([path for path, _ in context.misnamed])
    yield from context.at_containers(_unknown_outcomes, misnamed)


def _unknown_outcomes(
    path: str, container: Container, misnamed: AbstractSet[str]
) -> Iterator[Finding]:
    """SM102 in a container; `misnamed` has the paths of those with transitions that have faults."""
    if isinstance(container, nodes.Iterator):
        yield from _unknown_loops(path, container)
    elif path in misnamed and not isinstance(container, Concurrence):
        for child in container.children:
            if unknown := unknown_outcomes(child):
                yield from _unknown_steps(path, child, unknown)
    for child in container.children:
        if isinstance(child, Leaf) and child.variables:
            yield from unknown_endings(f"{path}/{child.name}", child)
        if child.autonomy:
            yield from _unknown_in_autonomy(f"{path}/{child.name}", child)


def _unknown_in_autonomy(path: str, child: Node) -> Iterator[Finding]:
    """Levels of autonomy for outcomes that a state does not have."""
    names = [*outcome_names(child), EXCEPTIONS]
    for one in () if has_no_interface(child) else child.autonomy:
        if one.outcome not in names:
            yield Finding(
                span=one.span,
                message=f"`{child.name}` has no outcome `{one.outcome}`",
                arguments=(own_name(child, one.span), one.outcome),
                help=did_you_mean(guesser(names).unique_match(one.outcome)) or "remove this level",
                effect="the level of autonomy has no effect",
                related=calls(child, one.span),
                node=path,
            )


CATCH_ALL = frozenset(["*", "_", "any", "default", "else", "other", "others", "otherwise"])
"""Words that other languages use for all cases that are not listed."""


def _catch_all(child: Node, step: Transition) -> str | None:
    """The help for a transition for a word that other languages use for all outcomes without a
    transition."""
    handled = {transition.outcome for transition in child.transitions}
    rest = [name for name in outcome_names(child) if name not in handled]
    if step.outcome not in CATCH_ALL or not rest:
        return None
    rows = notation.entries(child, ((name, step.target) for name in rest))
    return f"each outcome has its own transition: write `{rows}`"


def _unknown_steps(path: str, child: Node, unknown: list[Transition]) -> Iterator[Finding]:
    guess = guesser([*outcome_names(child), EXCEPTIONS])
    default = missing_default(child)
    suggested = suggested_outcomes(child, [step.outcome for step in unknown[:MOST_EXPLAINED]])
    for number, step in enumerate(unknown):
        is_searched = number < MOST_EXPLAINED
        sure = guess.unique_match(step.outcome)
        meant = suggested.get(step.outcome)
        retried = _retried(child, step.outcome)
        message = f"`{child.name}` has no outcome `{step.outcome}`"
        if retried is not None and isinstance(child, nodes.Iterator):
            then = "runs again (`retry`)"
            if child.sugar != "retry":
                then = f"runs for the next item (`{child.sugar}`)"
            message = f"`{child.name}` never ends with `{step.outcome}`: after it, the state {then}"
        yield Finding(
            span=step.span,
            message=message,
            arguments=(own_name(child, step.span), step.outcome),
            help=(f"add `default_outcome: {step.outcome}` to `{child.name}`" if default else None)
            or retried
            or (_catch_all(child, step) if is_searched else None)
            or did_you_mean(meant or sure)
            or (other_outcome(child, step) if is_searched else "remove this transition"),
            related=calls(child, step.span),
            node=f"{path}/{child.name}",
            edits=()
            if default is not None or step.outcome in OF_SMACH
            else respelt(Word(step.outcome, step.span), sure),
            repairs=likely(respelt(Word(step.outcome, step.span), meant), "write another outcome")
            if meant != sure
            else (),
        )


def _retried(child: Node, outcome: str) -> str | None:
    """The help for a transition for an outcome that `retry` or `for_each` replaces."""
    if not isinstance(child, nodes.Iterator) or outcome not in child.loop_outcomes:
        return None
    if child.sugar == "retry":
        end = child.exhausted_outcome
        instead = f"after the last try, `retry` ends with `{end}`"
        if end in {
            transition.outcome for transition in child.transitions if transition.origin == "written"
        }:
            return f"remove `{outcome}:`; {instead}, which has a transition"
        return f"write `{end}:` in place of `{outcome}:`; {instead}"
    if child.sugar == "for_each":
        first = child.loop_outcomes[0]
        return (
            f"after the last item it ends with `{first}`, the first outcome in `on`: remove this"
            f" transition, or `{outcome}` from `on`"
        )
    return None


def _unknown_loops(path: str, container: nodes.Iterator) -> Iterator[Finding]:
    if any(has_no_interface(child) for child in container.children):
        return
    known = sorted({name for child in container.children for name in outcome_names(child)})
    never = not {*known} & {*container.loop_outcomes}
    for number, name in enumerate(container.loop_outcomes if known else ()):
        if name not in known:
            span = container.loop_spans[number] if container.loop_spans else container.span
            yield Finding(
                span=span,
                message=f"`loop_outcomes` of `{container.name}` lists `{name}`, which is not an"
                f" outcome of `{container.children[0].name}`",
                arguments=(own_name(container, span), name),
                help=did_you_mean(guesser(known)(name)) or f"use one of {listed(known)}",
                repairs=tuple(_other_words(Word(name, span), known)),
                effect="the loop ends after its first item"
                if never
                else "an entry that is no outcome of the child has no effect",
                related=calls(container, span),
                node=path,
            )


@rule(
    "SM106",
    "duplicate-state",
    Severity.ERROR,
    unsuppressible=True,
    effect="a transition to this name leads to only one of the two, and SMACH refuses the other",
)
def duplicate_state(context: Context) -> Iterator[Finding]:
    """Two states of one container have the same name.

    A transition to that name leads to only one of them: the robot never does the work of the
    other one.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - MOVE: {template: ScriptedState, outcomes: [there], transitions: {there: MOVE}}
          - MOVE: {template: ScriptedState, outcomes: [back], transitions: {back: done}}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - MOVE: {template: ScriptedState, outcomes: [there], transitions: {there: MOVE_BACK}}
          - MOVE_BACK: {template: ScriptedState, outcomes: [back], transitions: {back: done}}
    """
    for path, container in context.containers:
        first: dict[str, Node] = {}
        meant = copied_name(container)
        for child in container.children:
            known = first.setdefault(child.name, child)
            if known is not child:
                help = (
                    f"rename one of the two, for example to `{_new_name(child.name, first)}`,"
                    " also in the transitions that mean it"
                )
                if meant is not None:
                    help = f"rename one of the two to `{meant}`, to which transitions lead"
                is_replaced = isinstance(container, Concurrence) and notation.is_python(child)
                yield Finding(
                    span=child.span,
                    message=f"`{container.name}` already has a state `{child.name}`",
                    arguments=(child.name,),
                    help=help,
                    effect="the second one takes the place of the first, which never runs"
                    if is_replaced
                    else None,
                    related=(
                        *other_place(known.span, "the first state of this name"),
                        *calls(child, child.span),
                    ),
                    node=f"{path}/{child.name}",
                )


@rule("SM107", "name-clash", Severity.ERROR, unsuppressible=True)
def name_clash(context: Context) -> Iterator[Finding]:
    """A state has the name of an outcome of its container, or a name that is not valid in paths.

    A transition to a name of both kinds leads to the state: the robot continues where its task
    should end. With a `/` in a name, two states can have the same path in traces and messages;
    the same happens with the name `MOVE (retry)` beside a state `MOVE` with `retry`.

    Wrong:
        name: sm
        template: Base
        outcomes: [done, stopped]
        states:
          - WORK: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}
          - done: {template: ScriptedState, outcomes: [ok], transitions: {ok: stopped}}

    Right:
        name: sm
        template: Base
        outcomes: [done, stopped]
        states:
          - WORK: {template: ScriptedState, outcomes: [ok, bad], transitions: {ok: done, bad: PARK}}
          - PARK: {template: ScriptedState, outcomes: [ok], transitions: {ok: stopped}}
    """
    for path, node in context.states:
        if not node.name.isprintable() or "/" in node.name or not node.name:
            yield Finding(
                span=node.span,
                message=f"{node.name!r} is not a valid name of a state",
                arguments=(node.name,),
                help="write a name without `/` and control characters, such as"
                f" `{_valid(node.name)}`",
                effect="in paths such as `sm/PICK`, `/` separates the names of states",
                related=calls(node, node.span),
                node=path,
            )
    for path, container in context.linear:
        exits = {outcome.name: outcome for outcome in container.outcomes}
        for child in container.children:
            if child.name in exits:
                yield Finding(
                    span=child.span,
                    message=f"`{child.name}` is both a state and an outcome of `{container.name}`",
                    arguments=(child.name,),
                    help=f"rename the state, for example to `{_new_name(child.name, exits)}`, and"
                    " the targets of the transitions that lead to it; or rename the outcome",
                    effect="a transition to this name leads to the state, so the container goes on",
                    related=(
                        *other_place(exits[child.name].span, "the outcome of this name"),
                        *calls(child, child.span),
                    ),
                    node=f"{path}/{child.name}",
                )
    for path, around in context.containers:
        yield from _trace_clashes(path, around)


def _trace_clashes(path: str, container: Container) -> Iterator[Finding]:
    """The states with a name that traces have for a part of another state: `A (retry)` for the
    tries of `A`."""
    parts: dict[str, Node] = {}
    for child in container.children:
        node: Node | None = child
        while node is not None and not isinstance(node, Leaf) and role(node):
            parts[f"{child.name} ({role(node)})"] = child
            node = sugared_child(node)
    for child in container.children:
        if (other := parts.get(child.name)) is not None:
            field = child.name[len(other.name) + 2 : -1]
            field = "retry" if field == "try" else field
            yield Finding(
                span=child.span,
                message=f"`{child.name}` is the name that traces have for `{field}` of"
                f" `{other.name}`",
                arguments=(child.name, other.name),
                help="rename the state, also in the transitions that lead to it",
                effect="a trace does not show which of the two it is about",
                related=(
                    *other_place(other.span, f"the state with `{field}`"),
                    *calls(child, child.span),
                ),
                node=f"{path}/{child.name}",
            )


@rule(
    "SM108",
    "shadowed-name",
    Severity.WARNING,
    effect="traces, pictures and messages show one name for two states",
)
def shadowed_name(context: Context) -> Iterator[Finding]:
    """A state has the same name as its container.

    Diagrams, traces and editors show the same name on two levels. Somebody who repairs the robot's
    task can easily change the wrong one.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK:
              template: StateMachine
              outcomes: [picked]
              states:
                - PICK: {template: ScriptedState, outcomes: [ok], transitions: {ok: picked}}
              transitions: {picked: done}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK:
              template: StateMachine
              outcomes: [picked]
              states:
                - GRASP: {template: ScriptedState, outcomes: [ok], transitions: {ok: picked}}
              transitions: {picked: done}
    """
    for path, container in context.containers:
        for child in container.children:
            if child.name == container.name and not container.sugar:
                yield Finding(
                    span=child.span,
                    message=f"state `{child.name}` has the same name as its container",
                    arguments=(child.name,),
                    help="rename one of them, for example the state to"
                    f" `{_new_name(child.name, ())}`",
                    related=(
                        *other_place(container.span, "the container"),
                        *calls(child, child.span),
                    ),
                    node=f"{path}/{child.name}",
                )


def _new_name(name: str, taken: Collection[str]) -> str:
    """A name that is like another one and not taken."""
    return next(new for number in count(2) if (new := f"{name}_{number}") not in taken)


def _valid(name: str) -> str:
    """A valid name that is near an invalid one."""
    return "".join(c if c.isprintable() and c != "/" else "_" for c in name) or "STATE"
