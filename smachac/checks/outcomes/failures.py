"""Rules over failures after which a container or the machine ends with a success."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import NamedTuple, TypeAlias

from smachac.analysis.context import Context
from smachac.analysis.control_flow import MOST_STEPS
from smachac.analysis.failure_paths import starts_failure
from smachac.analysis.outcome_rules import Combination, SoundConcurrence, Space, UndecidedError
from smachac.analysis.possible_outcomes import Judged
from smachac.checks.findings import notation
from smachac.checks.findings.help_text import calls, in_conditions, other_place, own_name
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, PathStep, Severity, ended, entered
from smachac.diagnostics.source import Span
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import listed
from smachac.ir import nodes
from smachac.ir.nodes import (
    Concurrence,
    Container,
    Leaf,
    Node,
    OutcomeRule,
    Sequence,
    StateMachine,
    Transition,
)
from smachac.ir.outcome_names import GOOD, PREEMPTED, SUCCESSES, TIMEOUTS, fails, successes
from smachac.ir.script_paths import name_in_script, sugared_child
from smachac.ir.traversal import leads_to_child, outcome_names


@rule(
    "SM404",
    "masked-failure",
    Severity.WARNING,
    effect="the task continues as if nothing had failed",
)
def masked_failure(context: Context) -> Iterator[Finding]:
    """A branch or an item fails, and the concurrence or the loop ends with a success.

    The robot continues with a part that it did not grasp, or at a place that it did not inspect.
    Often the default outcome is a success, a rule does not list all branches, or a loop continues
    after a failure.

    Exactly: an outcome of failure is declared so (`failure: true`), or named `aborted`, `failed`,
    `error`, `timeout` or similar. A success of a concurrence is the outcome `succeeded` (or `done`,
    `ok` or similar if it also has an outcome of failure), and an outcome with which it always ends
    when no branch fails; an outcome whose transition leads to an outcome of failure is no success.
    A rule that lists the branch with its failure, or with `any`, is intended, and not reported. No
    preempt request comes from outside. With `join: any` only a failure of the branch that ends
    first counts, because the concurrence preempts the others. A loop (`for_each` or an Iterator) is
    reported if it continues after a failure and ends with `succeeded`, `done`, `ok` or similar
    after the last item; an exception after which it continues is intended. If other failures are
    intended, `outcomes: {aborted: {failure: false}}` at the state declares it, or the loop ends
    with a neutral outcome, such as `all_visited`.

    Wrong:
        name: sm
        template: Base
        outcomes: [ready, failed]
        states:
          - BOTH:
              template: Concurrence
              outcomes: [ready, failed]
              default_outcome: ready
              outcome_map:
                failed: {LEFT: aborted, RIGHT: aborted}
              states:
                - LEFT: {template: ScriptedState, outcomes: [done, aborted]}
                - RIGHT: {template: ScriptedState, outcomes: [done, aborted]}
              transitions: {ready: ready, failed: failed}

    Right:
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
              states:
                - LEFT: {template: ScriptedState, outcomes: [done, aborted]}
                - RIGHT: {template: ScriptedState, outcomes: [done, aborted]}
              transitions: {ready: ready, failed: failed}
    """
    containers = dict(context.containers)
    for judged in context.judged:
        around = containers.get(judged.path.rpartition("/")[0], judged.concurrence.node)
        try:
            yield from _masked(context, judged, around)
        except UndecidedError:
            continue
    for path, container in context.containers:
        if isinstance(container, nodes.Iterator) and container.sugar != "retry":
            around = containers.get(path.rpartition("/")[0], container)
            yield from _masked_in_loop(context, path, container, around)


def _masked(context: Context, each: Judged, around: Container) -> Iterator[Finding]:
    """The failures that the default outcome hides, and those that each rule for a success hides."""
    concurrence, node = each.concurrence, each.concurrence.node
    if len(outcome_names(node)) == 1 and _is_ignored(node, around):
        return
    spaces = each.unstopped
    if not any(concurrence.failures(*ends) for space, _ in spaces for ends in space.items()):
        return
    good = _good_results(concurrence, around, [space for space, _ in spaces])
    if node.default_outcome in good:
        hidden = _hidden_failures(concurrence, spaces, {}, concurrence.rules.all)
        bad = next((name for name in outcome_names(node) if fails(node, name)), "failed")
        help = f"write `default_outcome: {bad}`, and a rule for each success"
        if bad not in outcome_names(node):
            help += f"; add `{bad}` to the outcomes of `{node.name}`"
        yield from _masked_finding(
            context, each, node.default_outcome, node.default_span, {}, hidden, help
        )
    for number, entry in enumerate(concurrence.written):
        if entry.outcome in good:
            given = concurrence.rules.conditions[number]
            rivals = concurrence.rules.larger_than(len(given) - 1) & ~(1 << number)
            named = {*given, *_ignored(entry, concurrence.children)}
            hidden = _hidden_failures(concurrence, spaces, given, rivals, named)
            shown = next(iter(hidden), "")
            help = f"add a condition for each branch to the rule for `{entry.outcome}`; write"
            help += f" `{shown}: any` if the failures of `{shown}` do not matter"
            yield from _masked_finding(
                context, each, entry.outcome, entry.span, given, hidden, help
            )


def _is_ignored(node: Node, around: Container) -> bool:
    """Whether a Concurrence around a state has a rule in which its outcome does not matter."""
    rules = around.rules if isinstance(around, nodes.Concurrence) else ()
    return any(word.text == node.name for entry in rules for word in entry.ignored)


def _ignored(entry: OutcomeRule, children: Collection[str]) -> Iterator[str]:
    """The children that a rule lists with `any`; a misspelt name is corrected."""
    for word in entry.ignored:
        yield word.text if word.text in children else guesser(children)(word.text) or word.text


def _good_results(
    concurrence: SoundConcurrence, around: Container, spaces: list[Space]
) -> frozenset[str]:
    """The outcomes of a concurrence in a container that are successes, as SM404 defines them."""
    node = concurrence.node
    found = set(successes(node))
    results: set[str] = set()
    for space in (_unfailed_outcomes(concurrence, space) for space in spaces):
        if concurrence.rules.find(space, {}, concurrence.rules.all) is not None:
            results.add(node.default_outcome)
        for number, entry in enumerate(concurrence.written):
            given = concurrence.rules.conditions[number]
            if concurrence.rules.find(space, given, concurrence.larger(number)) is not None:
                results.add(entry.outcome)
    if len(results) == 1:
        found |= results
    leads = {step.outcome: step.target for step in node.transitions}
    return frozenset(
        name
        for name in found
        if not (_is_bad(node, name) or (name in leads and _is_bad(around, leads[name])))
    )


def _is_bad(node: Node, name: str) -> bool:
    """Whether an outcome is one of failure, or `preempted`."""
    return fails(node, name) or name == PREEMPTED


def _unfailed_outcomes(concurrence: SoundConcurrence, space: Space) -> Space:
    """The outcomes of each child when nothing fails: those of success; of a child without any, the
    neutral ones, and without these `preempted`."""
    found: Space = {}
    for name, ends in space.items():
        good = tuple(end for end in ends if end.lower() in SUCCESSES | GOOD)
        found[name] = (
            good
            or concurrence.neutral(name, ends)
            or tuple(end for end in ends if end == PREEMPTED)
        )
    return found


def _hidden_failures(
    concurrence: SoundConcurrence,
    spaces: list[tuple[Space, str]],
    given: Combination,
    avoided: int,
    named: Collection[str] = (),
) -> dict[str, Combination]:
    """The children that can have failed although a rule without them decides the outcome, each with
    a combination of outcomes in which that rule decides.

    `given` are the conditions of the rule, none for the default outcome; `avoided` are the rules,
    as bits, that must not match because they would win. `named` are the children in the rule.
    """
    found: dict[str, Combination] = {}
    for space, first in spaces:
        for child in [first] if first else space:
            if child in named or child in found:
                continue
            for end in concurrence.failures(child, space[child]):
                fixed = {**given, child: end}
                combination = concurrence.rules.find(space, fixed, avoided)
                if combination is not None:
                    found[child] = concurrence.rules.shown(combination, fixed, avoided)
                    break
    return found


def _masked_finding(
    context: Context,
    each: Judged,
    outcome: str,
    span: Span,
    given: Combination,
    hidden: dict[str, Combination],
    help: str,
) -> Iterator[Finding]:
    """SM404 for an outcome that hides failures of children; nothing if it hides none."""
    if not hidden:
        return
    node = each.concurrence.node
    child, shown = next(iter(hidden.items()))
    others = [name for name in hidden if name != child]
    also = f"; failures of {listed(others)} are hidden too" if others else ""
    failed = next(one for one in node.children if one.name == child)
    step = next((step for step in node.transitions if step.outcome == outcome), None)
    yield Finding(
        span=span,
        message=f"`{node.name}` ends with `{outcome}` although `{child}` failed:"
        f" {in_conditions(shown)}{also}",
        arguments=(
            own_name(node, span),
            outcome,
            ", ".join(f"{name}: {end}" for name, end in given.items()),
            *sorted(hidden),
        ),
        help=help,
        related=(
            *other_place(failed.span, f"this state ends with `{shown[child]}`"),
            *calls(node, span),
        ),
        path=_exit_steps(context, each.path, node, step) if step else (),
        node=each.path,
    )


def _exit_steps(context: Context, path: str, node: Node, step: Transition) -> tuple[PathStep, ...]:
    """The path in a finding: a state, its outcome, and the target of its transition."""
    beside: str | None = f"{path.removesuffix(node.name)}{step.target}"
    if step.origin == "implicit" or beside not in context.spans:
        beside = None
    return entered(node.name, path), ended(step.outcome), entered(step.target, beside)


def _masked_in_loop(
    context: Context, path: str, loop: nodes.Iterator, around: Container
) -> Iterator[Finding]:
    """SM404 for the failures of an item after which a loop continues."""
    end = dict(loop.final_map).get(loop.exhausted_outcome, loop.exhausted_outcome)
    step = next((step for step in loop.transitions if step.outcome == end), None)
    good = end.lower() in SUCCESSES | GOOD
    if fails(loop, end) or (step is not None and fails(around, step.target)):
        return
    for child in loop.children:
        declared = {outcome.name for outcome in child.outcomes if outcome.failure}
        for number, outcome in enumerate(loop.loop_outcomes):
            if outcome in (child.catches, end) or not fails(child, outcome):
                continue
            if not good and outcome not in declared:
                continue
            span = loop.loop_spans[number] if loop.loop_spans else loop.span
            yield Finding(
                span=span,
                message=f"`{name_in_script(child)}` fails with `{outcome}`, but the loop continues"
                f" and ends with `{end}`",
                arguments=(own_name(loop, span), outcome, end),
                help=_ending(loop, outcome) + _suggestion(child, outcome),
                related=calls(loop, span),
                path=_exit_steps(context, path, loop, step) if step else (),
                node=path,
            )


def _suggestion(child: Node, outcome: str) -> str:
    """The rest of the help, for a failure that is intended: the declaration of the outcome at the
    state of the script. `exhausted` of a retry comes from the outcomes that it repeats."""
    causes: tuple[str, ...] = (outcome,)
    while (inner := None if isinstance(child, Leaf) else sugared_child(child)) is not None:
        if isinstance(child, nodes.Iterator) and child.sugar == "retry":
            causes = child.loop_outcomes if outcome == child.exhausted_outcome else causes
        child = inner
    own = [cause for cause in causes if cause in outcome_names(child)]
    if not own or notation.is_python(child):
        return ""
    declared = ", ".join(f"{text}: {{failure: false}}" for text in own)
    return (
        "; if the failure of an item does not matter, write"
        f" `outcomes: {{{declared}}}` at `{child.name}`"
    )


def _ending(loop: nodes.Iterator, outcome: str) -> str:
    """The help that a loop ends with an outcome."""
    field = f"`on` of `{loop.sugar}`" if loop.sugar else f"the `loop_outcomes` of `{loop.name}`"
    end = outcome if loop.sugar else dict(loop.final_map).get(outcome, outcome)
    help = f"remove `{outcome}` from {field}: then the loop ends with `{end}`"
    if not loop.sugar and end not in outcome_names(loop):
        help += f"; add `{end}` to the `outcomes` and `transitions` of `{loop.name}`"
    return help


_Ending: TypeAlias = "tuple[str, str]"
"""The path of a state, and an outcome of it."""


class _Propagation(NamedTuple):
    """An outcome of `node` that is passed up from container to container until the machine ends
    with a success. `masking` is the first step whose target is named as a success; None where it is
    this one."""

    path: str
    node: Node
    outcome: str
    target: str
    masking: _Propagation | None
    span: Span
    then: _Propagation | None


@rule(
    "SM206",
    "unhandled-failure",
    Severity.WARNING,
    effect="the caller of the machine takes the task as done",
)
def unhandled_failure(context: Context) -> Iterator[Finding]:
    """A state fails, and the machine ends with a success without entering another state.

    The machine reports that the robot has done its task, although a part of the task failed.

    Exactly: an outcome of failure of a state (declared with `failure: true`, or named `aborted`,
    `failed`, `error` or similar) leads out of all containers around the state until the machine
    ends with `succeeded`, or with `done`, `ok` or similar if the machine also has an outcome of
    failure. A transition from `timeout` or `timed_out` is not reported: a wait may have a limit on
    purpose. Used up tries are a failure, unless `failure: false` declares the outcomes that lead
    to another try. SM404 reports failures of the branches of a concurrence and of the items of a
    loop.

    Wrong:
        name: sm
        template: Base
        outcomes: [succeeded, failed]
        states:
          - PICK:
              template: ScriptedState
              outcomes: [done, lost]
              transitions: {done: PLACE, lost: failed}
          - PLACE:
              template: ScriptedState
              outcomes: [done, aborted]
              transitions: {done: succeeded, aborted: succeeded}

    Right:
        name: sm
        template: Base
        outcomes: [succeeded, failed]
        states:
          - PICK:
              template: ScriptedState
              outcomes: [done, lost]
              transitions: {done: PLACE, lost: failed}
          - PLACE:
              template: ScriptedState
              outcomes: [done, aborted]
              transitions: {done: succeeded, aborted: failed}
    """
    root = context.machine.root
    good = successes(root)
    if not good:
        return
    propagated: dict[_Ending, _Propagation | None] = {(root.name, name): None for name in good}
    maskings: dict[_Ending, list[_Propagation]] = {}
    for path, container in context.containers:
        names = frozenset(child.name for child in container.children)
        for child in container.children:
            for propagation in _propagations(path, container, names, child, propagated):
                if not isinstance(child, Leaf):
                    propagated.setdefault((propagation.path, propagation.outcome), propagation)
                if starts_failure(child, propagation.outcome) and not _is_limit(propagation):
                    masking = propagation.masking or propagation
                    maskings.setdefault((masking.path, masking.outcome), []).append(propagation)
    for found in maskings.values():
        yield _unhandled_failure(root, found)


def _is_limit(each: _Propagation) -> bool:
    """Whether the end of a time limit, under a name that means it, leads to a success."""
    masking = each.masking or each
    declared = {one.name for one in each.node.outcomes if one.failure}
    return {each.outcome, masking.outcome} <= TIMEOUTS and each.outcome not in declared


def _propagations(
    path: str,
    container: Container,
    names: frozenset[str],
    child: Node,
    propagated: Mapping[_Ending, _Propagation | None],
) -> Iterator[_Propagation]:
    """The outcomes of a child with which the machine ends with a success."""
    exits: list[tuple[str, str, Span]] = []
    match container:
        case StateMachine() | Sequence():
            steps = (step for step in child.transitions if not leads_to_child(step, names))
            exits = [(step.outcome, step.target, step.span) for step in steps]
        case nodes.Iterator():
            ends = (end for end in outcome_names(child) if end not in container.loop_outcomes)
            final = dict(container.final_map)
            exits = [(end, final.get(end, end), container.span) for end in ends]
        case Concurrence(sugar="timeout"):
            inner = outcome_names(child) if child.name == container.name else ()
            exits = [(end, end, container.span) for end in inner]
    for outcome, target, span in exits:
        if (path, target) in propagated:
            then = propagated[path, target]
            is_named_success = target.lower() in SUCCESSES | GOOD
            masking = None if is_named_success or then is None else then.masking or then
            yield _Propagation(f"{path}/{child.name}", child, outcome, target, masking, span, then)


def _unmasked(root: StateMachine, masking: _Propagation) -> str:
    """The help for a step that masks a failure: an outcome of its container for the failure."""
    container: Container = root
    for name in masking.path.split("/")[1:-1]:
        inner = next((child for child in container.children if child.name == name), None)
        if inner is None or isinstance(inner, Leaf):
            break
        container = inner
    names = [name for name in outcome_names(container) if fails(container, name)]
    step = f"lead `{masking.outcome}` of `{masking.node.name}`"
    if names:
        return f"{step} to a state that recovers, or to `{names[0]}`"
    help = f"{step} to a state that recovers, or to `failed`, and add `failed` to the `outcomes`"
    help += f" of `{container.name}`"
    if container is not root:
        help += f", and lead `failed` of `{container.name}` to a failure too"
    return help


def _unhandled_failure(root: StateMachine, found: list[_Propagation]) -> Finding:
    """SM206 for the failures that one step masks."""
    first = found[0]
    masking = first.masking or first
    witness: list[PathStep] = []
    end = ""
    step: _Propagation | None = first
    while step is not None and len(witness) < 2 * MOST_STEPS:
        witness += [entered(step.node.name, step.path), ended(step.outcome)]
        end, step = step.target, step.then
    others = [propagation.node.name for propagation in found[1:]]
    also = f"; failures of {listed(others)} are hidden too" if others else ""
    return Finding(
        span=masking.span,
        message=f"`{first.node.name}` fails with `{first.outcome}`, but `{root.name}` ends with a"
        f" success{also}",
        arguments=(
            own_name(masking.node, masking.span),
            masking.outcome,
            *sorted({propagation.node.name for propagation in found}),
        ),
        help=_unmasked(root, masking),
        related=(
            *(other_place(first.node.span, "this state fails") if masking is not first else ()),
            *calls(masking.node, masking.span),
        ),
        path=(*witness, entered(end, None)),
        node=masking.path,
    )
