"""Rules over outcomes: whether each has a transition, and is declared by its container."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from itertools import islice
from typing import NamedTuple

from smachac.analysis.context import Context
from smachac.analysis.control_flow import (
    Linear,
    Unhandled,
    places_of,
    unhandled_in,
    unknown_outcomes,
)
from smachac.checks.findings import notation
from smachac.checks.findings.condition_outcomes import suggested_default
from smachac.checks.findings.edits import likely, with_field
from smachac.checks.findings.help_text import calls, did_you_mean, other_place, own_name
from smachac.checks.findings.inverted_rules import Inverted, inverted_rules, transposed_rules
from smachac.checks.outcomes.iterator_endings import SuggestedEnding, endings, suggested_ending
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.diagnostics.repair import Edit
from smachac.diagnostics.spelling import MOST_EXPLAINED
from smachac.diagnostics.wording import both
from smachac.ir import nodes
from smachac.ir.nodes import Concurrence, Container, Leaf, Node, Outcome, Transition
from smachac.ir.outcome_names import (
    GOOD,
    PREEMPTED,
    SUCCESSES,
    fails,
    failures_of,
    is_failure,
    successes,
)
from smachac.ir.traversal import outcome_names, written_children


@rule(
    "SM103",
    "undeclared-container-outcome",
    Severity.ERROR,
    unsuppressible=True,
    effect="SMACH raises InvalidTransitionError for an undeclared outcome: the program stops",
)
def undeclared_container_outcome(context: Context) -> Iterator[Finding]:
    """A concurrence or iterator can end with an outcome that it does not declare.

    The container around it has no transition for that outcome: the machine stops with an error,
    and the robot stops in the middle of its task.

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
    results = [
        ("a rule of the outcome map gives", entry.outcome, entry.span) for entry in container.rules
    ]
    if container.default_outcome:
        results.append(("`default_outcome` is", container.default_outcome, container.default_span))
    declared = frozenset(outcome_names(container))
    guess = places_of(container)
    transposed = transposed_rules(container)
    inverted = inverted_rules(container)
    if inverted:
        yield _inverted(path, container, inverted)
    reported = {other.rule.outcome for other in inverted}
    for source, name, span in results:
        if name not in declared and name not in reported:
            meant = guess(name)
            yield Finding(
                span=span,
                message=f"{source} `{name}`, which is not an outcome of `{container.name}`",
                arguments=(own_name(container, span), name),
                help=transposed.get(name)
                or did_you_mean(meant if meant in declared else None)
                or _added(container, name),
                related=calls(container, span),
                node=path,
            )


def _added(container: Container, outcome: str) -> str:
    """The help that adds an outcome to a container, and to its transitions where it has some. No
    target is chosen but a failure."""
    help = f"add `{outcome}` to the outcomes of `{container.name}`"
    target = next((step.target for step in reversed(container.transitions) if step.target), "")
    if outcome == PREEMPTED or not target:
        return help
    transition = f", and `{notation.entry(container, outcome, target)}` to its transitions"
    return f"{help}{transition if is_failure(target) else ' and to its transitions'}"


def _inverted(path: str, container: Concurrence, inverted: tuple[Inverted, ...]) -> Finding:
    first = inverted[0].rule
    rules: dict[str, list[tuple[str, str]]] = {}
    for one in inverted:
        for result, end in one.meant:
            rules.setdefault(result, []).append((one.rule.outcome, end))
    shown = ", ".join(notation.rule(container, result, parts) for result, parts in rules.items())
    shown = notation.field(container, "outcome_map", f"{{{shown}}}")
    return Finding(
        span=first.span,
        message=f"the outcome map of `{container.name}` begins a rule with its state"
        f" `{first.outcome}`, not with one of its outcomes",
        arguments=(own_name(container, first.span), first.outcome),
        help=f"the outcome comes first: `{shown}`",
        related=calls(container, first.span),
        node=path,
    )


def _undeclared_endings(path: str, container: nodes.Iterator) -> Iterator[Finding]:
    declared = frozenset(outcome_names(container))
    known = {name for child in container.children for name in outcome_names(child)}
    misnamed = not container.sugar and not known.issuperset(container.loop_outcomes)
    for child, outcome, result in endings(container):
        if result in declared:
            continue
        if misnamed and child and outcome.lower() in SUCCESSES | GOOD:
            continue  # SM102: an entry of `loop_outcomes` is meant for it
        when = f"when `{child}` ends with `{outcome}`" if child else "after the last item"
        others = notation.names(container, "loop_outcomes", [outcome])
        mapped = next(reversed(outcome_names(container)), "")
        renaming = notation.mapping(container, "final_outcome_map", [(outcome, mapped)])
        yield Finding(
            span=container.span,
            message=f"`{container.name}` ends with `{result}` {when}, but has no such outcome",
            arguments=(container.name, result, child, outcome),
            help=_added(container, result)
            + (f", write `{others}` to continue on it" if child else "")
            + (f", or map it with `{renaming}`" if mapped else ""),
            related=calls(container, container.span),
            node=path,
        )


@rule(
    "SM104",
    "unhandled-outcome",
    Severity.ERROR,
    unsuppressible=True,
    effect="SMACH refuses to run such a container: none of its states runs",
)
def unhandled_outcome(context: Context) -> Iterator[Finding]:
    """An outcome of a state has no transition, and its container has no outcome of that name.

    When the state ends with that outcome, no next state is defined: SMACH stops with an error, and
    the arm stops where it is.

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
        lacking = context.of_container(unhandled_in, path, container)
        yield from _unhandled_outcomes(path, container, lacking)


def _unhandled_outcomes(path: str, container: Linear, lacking: Unhandled) -> Iterator[Finding]:
    if not lacking:
        return
    free = unentered(container)
    steps = _steps(container)
    for child, outcomes in lacking:
        left = [*outcomes]
        meant = suggested_ending(child) if isinstance(child, nodes.Iterator) else None
        if meant is not None and meant.result in left:
            left.remove(meant.result)
            yield _misnamed_ending(path, meant)
        if not left:
            continue
        targets = _targets(container, child, left, free, steps)
        if len(left) == 1 or any(_field_that_adds(child, outcome.name) for outcome in left):
            for outcome in left:
                yield _unhandled(path, container, child, outcome, targets[outcome.name])
        else:
            yield _several_unhandled(path, container, child, targets)


class _Steps(NamedTuple):
    """The transitions in a container: the names of its states, with their numbers (`order`); the
    numbers of the targets by outcome (`alike`); the names of all targets (`used`)."""

    names: Sequence[str]
    order: Mapping[str, int]
    alike: Mapping[str, Mapping[str, int]]
    used: AbstractSet[str]


def _steps(container: Linear) -> _Steps:
    names = [child.name for child in written_children(container)]
    order = {name: at for at, name in enumerate(names)}
    ends = outcome_names(container)
    used: set[str] = set()
    alike: dict[str, dict[str, int]] = {}
    for child in container.children:
        for step in child.transitions:
            used.add(step.target)
            if step.target in order or step.target in ends:
                targets = alike.setdefault(step.outcome, {})
                targets.setdefault(step.target, len(targets))
    return _Steps(names, order, alike, used)


def unentered(container: Linear) -> list[str]:
    """The states of a container to which no transition of another state leads."""
    led = {step.target for child in container.children for step in child.transitions
           if step.target != child.name}  # fmt: skip
    return [child.name for child in written_children(container)
            if child.name not in led and child.name != container.initial]  # fmt: skip


def _targets(
    container: Linear,
    child: Node,
    left: Iterable[Outcome],
    free: list[str],
    steps: _Steps,
) -> dict[str, str]:
    """For each outcome without a transition the target that it probably needs. `free` are the
    states of the container to which nothing leads yet, in order; those that are used are
    removed."""
    found: dict[str, str] = {}
    rest = [outcome.name for outcome in left]
    sure, failures = successes(child), failures_of(child)
    good = [name for name in rest
            if name != PREEMPTED and (name in sure or name not in failures)]  # fmt: skip
    bad = [name for name in rest
           if name != PREEMPTED and name in failures and name not in sure]  # fmt: skip
    for outcome in (*good, *bad) if len(rest) <= MOST_EXPLAINED else ():
        at = bisect_right(free, steps.order[child.name], key=steps.order.__getitem__)
        if at == len(free):
            at = next((i for i, name in enumerate(free) if name != child.name), at)
        if at < len(free):
            found[outcome] = free.pop(at)
    for outcome in rest[:MOST_EXPLAINED]:
        if outcome not in found:
            is_good = outcome in sure or (good == [outcome] and _is_only_good(child, outcome))
            found[outcome] = _target(container, child, outcome, is_good, steps)
    last = found[rest[:MOST_EXPLAINED][-1]]
    found |= dict.fromkeys(rest[MOST_EXPLAINED:], last)
    return {name: found[name] for name in rest}


def _is_only_good(child: Node, outcome: str) -> bool:
    """Whether all other outcomes of a state are failures or a stop, and one is a failure."""
    others = [name for name in outcome_names(child) if name not in (outcome, PREEMPTED)]
    return bool(others) and all(fails(child, name) for name in others)


def _target(container: Linear, child: Node, outcome: str, succeeds: bool, steps: _Steps) -> str:
    """The target that an outcome probably needs: that of the other failures of the state, the state
    after a stop request, that of the same outcome of other states, a failure of the container or
    its stop, or what comes after a success."""
    ends, names = outcome_names(container), steps.names
    failed = [name for name in ends if fails(container, name)]
    alike = steps.alike.get(outcome, {})
    others = (name for name in alike if name in ends or outcome == PREEMPTED)
    other = [*islice(others, 1)]
    own = {step.target for step in child.transitions if step.origin == "written"
           and step.outcome != PREEMPTED and fails(child, step.outcome)}  # fmt: skip
    if outcome == PREEMPTED:
        near = sorted(own & alike.keys(), key=alike.__getitem__)
        targets = [*([PREEMPTED] if PREEMPTED in ends else []), *near, *other, *failed]
    elif fails(child, outcome):
        stopped = [step.target for step in child.transitions
                   if step.outcome == PREEMPTED and step.target in steps.order]  # fmt: skip
        targets = [*(own if len(own) == 1 else ()), *stopped, *other, *failed]
    elif succeeds:
        after = steps.order[child.name] + 1
        targets = [*names[after : after + 1], *successes(container)]
    else:
        unused = [name for name in ends if name not in steps.used and name != PREEMPTED]
        targets = [*(unused if len(unused) == 1 else ()), *other, *failed]
        if not targets and len(ends) + len(names) > 2:
            return notation.UNDECIDED
    plain = [name for name in ends if name != PREEMPTED]
    return next(iter([*targets, *reversed(plain), *ends, *names[:1]]))


def _several_unhandled(
    path: str, container: Linear, child: Node, targets: dict[str, str]
) -> Finding:
    """SM104 for a state of which several outcomes have no transition."""
    pairs = targets.items()
    help = f"add `{notation.entries(child, pairs)}` to the transitions of `{child.name}`"
    if not any(step.origin == "written" for step in child.transitions):
        help = f"write `{notation.mapping(child, 'transitions', pairs)}` in `{child.name}`"
    return Finding(
        span=child.span,
        message=f"the outcomes {both(targets)} of `{child.name}` have no transitions, and"
        f" `{container.name}` has no outcomes of these names",
        arguments=(child.name, *targets),
        help=help,
        related=calls(child, child.span),
        node=f"{path}/{child.name}",
    )


def _misnamed_ending(path: str, ending: SuggestedEnding) -> Finding:
    container, result, meant = ending
    name, last = container.name, container.exhausted_outcome
    code = notation.name(container, "exhausted_outcome", meant.name)
    mapped = last in dict(container.final_map)
    if mapped:
        code = notation.mapping(container, "final_outcome_map", [(last, meant.name)])
    written = result.span.text == result.name
    message = f"`{name}` ends with `{result.name}` after the last item, but has no such outcome"
    if written and not mapped:
        message = f"`exhausted_outcome` is `{result.name}`, but `{name}` has no such outcome"
    return Finding(
        span=result.span,
        message=message,
        arguments=(own_name(container, result.span), result.name),
        help=f"write `{code}`: `{name}` has no other way to end with `{meant.name}`",
        related=(
            *other_place(meant.span, f"`{name}` never ends with this outcome"),
            *calls(container, result.span),
        ),
        node=f"{path}/{name}",
        repairs=likely(
            (Edit(span=result.span, text=meant.name),)
            if written and not mapped
            else with_field(container.span, code),
            "name the last outcome",
        ),
    )


def _field_that_adds(node: Node, outcome: str) -> str:
    """The field `timeout`, `retry` or `for_each` of a state that adds an outcome; empty if the
    state itself has it."""
    if not isinstance(node, Concurrence | nodes.Iterator) or not node.sugar:
        return ""
    inner = node.children[0]
    return _field_that_adds(inner, outcome) if outcome in outcome_names(inner) else node.sugar


def _unhandled(path: str, container: Linear, child: Node, outcome: Outcome, target: str) -> Finding:
    """SM104 for an outcome without a transition."""
    held = child.variables if isinstance(child, Leaf) else ()
    default = next((variable for variable in held if variable.name == "default_outcome"), None)
    meant = suggested_default(child) if isinstance(child, Leaf) else None
    if default is not None and meant is not None and default.value.data == outcome.name:
        return Finding(
            span=default.value.span,
            message=f"`{outcome.name}` of `{child.name}` has no transition, and no condition leads"
            f" to `{meant}`, which has one",
            arguments=(child.name, outcome.name),
            help=f"write `{notation.name(child, 'default_outcome', meant)}`",
            related=calls(child, default.value.span),
            node=f"{path}/{child.name}",
        )
    # The file of an interface may have another place on another machine, so it is not shown.
    inside = outcome.span.source is child.span.source
    missing = notation.entry(child, outcome.name, target)
    field = _field_that_adds(child, outcome.name)
    origin = f"`{field}` adds the outcome `{outcome.name}`" if field else "declared here"
    why = ""
    if field and outcome.name == PREEMPTED:
        why = f"after a stop request `{field}` ends with it: "
    elif field == "timeout" and isinstance(child, nodes.Iterator) and child.sugar == "retry":
        why = f"add `{outcome.name}` to `on` of `retry` if the state must be tried again, or "
    return Finding(
        span=child.span,
        message=f"outcome `{outcome.name}` of `{child.name}` has no transition, and"
        f" `{container.name}` has no outcome of that name",
        arguments=(child.name, outcome.name),
        help=f"{why}add `{missing}` to the transitions of `{child.name}`",
        related=(
            *(other_place(outcome.span, origin) if inside and outcome.span != child.span else ()),
            *calls(child, child.span),
        ),
        node=f"{path}/{child.name}",
    )


@rule("SM105", "implicit-exit", Severity.INFO)
def implicit_exit(context: Context) -> Iterator[Finding]:
    """An outcome without a transition ends the container, which has an outcome of the same name.

    This is often intended. If the transition was forgotten, the robot stops without a recovery.

    Exactly: it is a warning for an outcome of failure of a state that has a transition for an
    outcome of success, and a note otherwise. The states of one container that end it with one
    outcome are one finding.

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
        for child in container.children if not container.sugar else ():
            steps = [step for step in child.transitions if step.origin == "implicit"]
            if steps and not unknown_outcomes(child):
                yield from _implicit(path, container, child, steps)


def _implicit(
    path: str, container: Linear, child: Node, steps: Iterable[Transition]
) -> Iterator[Finding]:
    beside = any(
        step.origin == "written" and not fails(child, step.outcome) and step.outcome != PREEMPTED
        for step in child.transitions
    )
    for step in steps:
        forgotten = beside and fails(child, step.outcome)
        added = f"`{notation.entry(child, step.outcome, step.target)}`"
        yield Finding(
            span=step.span,
            message=f"outcome `{step.outcome}` of `{child.name}` has no transition, so"
            f" `{container.name}` ends with `{step.target}`",
            arguments=(own_name(child, step.span), step.outcome),
            help=f"write {added} if this is intended, or a transition to a state that recovers"
            if forgotten
            else f"add {added} to the `transitions` of `{child.name}` to"
            " show that this is intended",
            related=calls(child, step.span),
            severity=Severity.WARNING if forgotten else None,
            node=f"{path}/{child.name}",
            group=(own_name(container, step.span), step.outcome),
        )
