"""Rules over concurrences: whether there is something to run, and rules that can match."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from smachac.analysis.context import Context
from smachac.analysis.control_flow import is_open
from smachac.analysis.outcome_rules import (
    Combination,
    Space,
    Study,
    UndecidedError,
    bits,
    without_other,
)
from smachac.analysis.possible_outcomes import Judged
from smachac.checks.messages import calls, did_you_mean, other_place
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import listed
from smachac.ir import nodes
from smachac.ir.nodes import Concurrence, Node
from smachac.ir.traversal import outcome_names


@rule("SM403", "dead-rule", Severity.ERROR, firm=True)
def dead_rule(context: Context) -> Iterator[Finding]:
    """A rule can never decide: it names a child or an outcome that does not exist, or nothing, or
    larger rules always win over it.

    The case it was written for ends otherwise; the robot goes on as if that case had never been
    thought of. SMACH does not even run a concurrence whose rule names an unknown child, and its
    versions disagree on a rule without conditions.

    A warning where in each combination in which the rule holds, a rule that lists more children
    holds as well. An outcome that a container declares but never ends with is not told again
    here.

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
                ready: {LEFT: done, RIHGT: done}
              states:
                - LEFT: {template: ScriptedState, outcomes: [done]}
                - RIGHT: {template: ScriptedState, outcomes: [done]}
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
                - LEFT: {template: ScriptedState, outcomes: [done]}
                - RIGHT: {template: ScriptedState, outcomes: [done]}
              transitions: {ready: ready, failed: failed}
    """
    for path, container in context.containers:
        match container:
            case Concurrence():
                yield from _dead_rules(path, container)
            case nodes.Iterator(sugar=""):
                yield from _dead_renames(path, container)
    for each in context.judged:
        yield from _shadowed_rules(each)


def _dead_rules(path: str, container: Concurrence) -> Iterator[Finding]:
    children = {child.name: child for child in container.children}
    guess = guesser(children)
    states = f"its states are {listed(children)}" if children else "it has no states"
    for entry in container.rules:
        if not entry.when:
            yield Finding(
                span=entry.span,
                message=f"the rule for `{entry.outcome}` names no child, so it says nothing",
                help="name the children and their outcomes, or drop the rule",
                related=calls(container, entry.span),
                node=path,
            )
        for condition in entry.when:
            child = children.get(condition.child)
            if child is None:
                message = f"`{condition.child}` is no state of `{container.name}`"
                help = did_you_mean(guess(condition.child)) or states
            elif is_open(child) or condition.outcome in outcome_names(child):
                continue
            else:
                message = f"`{child.name}` has no outcome `{condition.outcome}`"
                help = _other_outcome(child, condition.outcome)
            related = calls(container, condition.span)
            yield Finding(
                span=condition.span, message=message, help=help, related=related, node=path
            )


def _other_outcome(child: Node, outcome: str) -> str:
    names = outcome_names(child)
    known = f"its outcomes are {listed(names)}" if names else "it has no outcomes"
    return did_you_mean(guesser(names)(outcome)) or known


def _shadowed_rules(each: Judged) -> Iterator[Finding]:
    """The rules over which larger ones win in every combination."""
    read, rules, whole = each.read, each.read.rules, each.whole
    for number, entry in enumerate(read.written):
        given, larger = rules.conditions[number], read.larger(number)
        rivals = larger & rules.compatible(number)
        if not rivals or any(end not in whole[child] for child, end in given.items()):
            continue
        try:
            if rules.find(whole, given, larger) is not None:
                continue
        except UndecidedError:
            return
        winners = [read.written[rival] for rival in bits(rivals)]
        yield Finding(
            span=entry.span,
            message=f"the rule for `{entry.outcome}` never decides: whenever it holds, so does one"
            f" that lists more children, for {listed(winner.outcome for winner in winners)}",
            help="take it out, or let it list the children that make it differ",
            related=(
                *(part for one in winners[:3] for part in other_place(one.span, "wins over it")),
                *calls(read.node, entry.span),
            ),
            severity=Severity.WARNING,
            node=each.path,
        )


def _dead_renames(path: str, container: nodes.Iterator) -> Iterator[Finding]:
    """The entries of an iterator's final map that rename what never comes. Outcomes on which it
    goes on do come, when it is asked to stop (smach-semantics P9)."""
    if any(is_open(child) for child in container.children):
        return
    endings = [name for child in container.children for name in outcome_names(child)]
    for name, _ in container.final_map if endings else ():
        if name == container.exhausted_outcome or name in endings:
            continue
        yield Finding(
            span=container.span,
            message=f"the final outcome map of `{container.name}` renames `{name}`,"
            " with which its child never ends",
            help=f"its child ends with {listed(endings)}",
            related=calls(container, container.span),
            node=path,
        )


@rule("SM408", "empty-concurrence", Severity.ERROR, firm=True)
def empty_concurrence(context: Context) -> Iterator[Finding]:
    """A concurrence has no states.

    SMACH for ROS 2 waits for ever for the first child to end, SMACH for Noetic fails.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - BOTH:
              template: Concurrence
              outcomes: [done]
              default_outcome: done
              states: []
              transitions: {done: done}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - BOTH:
              template: Concurrence
              outcomes: [done]
              default_outcome: done
              states:
                - LEFT: {template: ScriptedState, outcomes: [ok]}
                - RIGHT: {template: ScriptedState, outcomes: [ok]}
              transitions: {done: done}
    """
    for path, container in context.containers:
        if isinstance(container, Concurrence) and not container.children:
            yield Finding(
                span=container.span,
                message=f"the concurrence `{container.name}` has no states to start",
                help="add states, or take it out",
                related=calls(container, container.span),
                node=path,
            )


def written(combination: Mapping[str, str]) -> str:
    """A combination as it stands in a script."""
    return ", ".join(f"`{child}: {outcome}`" for child, outcome in combination.items())


@rule("SM401", "uncovered-combination", Severity.ERROR, firm=True)
def uncovered_combination(context: Context) -> Iterator[Finding]:
    """The children can end in a way that no rule speaks of, and there is no default outcome.

    A concurrence without `default_outcome` says that its rules are complete. Where one
    combination is missing, possibly one of a thousand, the robot stops in it.

    Exactly: every combination counts, those that only a preempt request brings about as well; of
    a container only the outcomes that something in it brings about. With a default outcome it is
    only noted, and only where each child ended by itself and none with a failure: those cases
    somebody may have forgotten, for the others there are defaults.

    Wrong:
        name: sm
        template: Base
        outcomes: [ready, failed]
        states:
          - BOTH:
              template: Concurrence
              outcomes: [ready, failed]
              outcome_map:
                ready: {LEFT: done, RIGHT: done}
                failed: {LEFT: slipped}
              states:
                - LEFT: {template: ScriptedState, outcomes: [done, slipped]}
                - RIGHT: {template: ScriptedState, outcomes: [done, slipped]}
              transitions: {ready: ready, failed: failed}

    Right:
        name: sm
        template: Base
        outcomes: [ready, failed]
        states:
          - BOTH:
              template: Concurrence
              outcomes: [ready, half, failed]
              outcome_map:
                ready: {LEFT: done, RIGHT: done}
                half: {LEFT: done, RIGHT: slipped}
                failed: {LEFT: slipped}
              states:
                - LEFT: {template: ScriptedState, outcomes: [done, slipped]}
                - RIGHT: {template: ScriptedState, outcomes: [done, slipped]}
              transitions: {ready: ready, half: failed, failed: failed}
    """
    for each in context.judged:
        node, rules = each.read.node, each.read.rules
        if node.default_outcome and not node.rules:
            continue
        missed = _missed(each)
        if missed is None:
            continue
        shown = written(rules.shown(missed, {}, rules.all)) or "every combination"
        if node.default_outcome:
            severity, span = Severity.INFO, node.default_span
            message = f"no rule of `{node.name}` speaks of {shown}: it ends with the default"
            message += f" `{node.default_outcome}`"
            help = None
        else:
            severity, span = Severity.ERROR, node.span
            message = f"no rule of `{node.name}` speaks of {shown}, and it has no default outcome"
            help = "add a rule, or a `default_outcome` for all that no rule speaks of"
        yield Finding(
            span=span,
            message=message,
            help=help,
            related=calls(node, span),
            severity=severity,
            node=each.path,
        )


def _missed(each: Judged) -> Combination | None:
    """A combination that no rule speaks of, of those that count."""
    rules = each.read.rules
    spaces = [_unexceptional(each.read, space) for space, _ in each.calm]
    if not each.read.node.default_outcome:
        spaces.append(without_other(each.whole))
    try:
        return next(filter(None, (rules.find(space, {}, rules.all) for space in spaces)), None)
    except UndecidedError:
        return None


def _unexceptional(read: Study, space: Space) -> Space:
    return {name: read.neutral(name, ends) for name, ends in space.items()}


@rule("SM402", "overlapping-rules", Severity.WARNING)
def overlapping_rules(context: Context) -> Iterator[Finding]:
    """Two rules hold at once, and neither lists more children than the other.

    What the robot does next then depends on the framework: SMACH for ROS 2 takes the rule listed
    last, SMACH for Noetic the one listed first, others refuse to go on. Where one of the rules
    lists more children, it wins everywhere.

    Exactly: there is a combination in which both hold and none that lists more children does.
    With `join: any`, branches that can be preempted are taken to be so when another one has ended;
    that two end in the same moment is not counted.

    Wrong:
        name: sm
        template: Base
        outcomes: [left, right, neither]
        states:
          - LOOK:
              template: Concurrence
              outcomes: [left, right, neither]
              default_outcome: neither
              outcome_map:
                left: {LEFT: found}
                right: {RIGHT: found}
              states:
                - LEFT: {template: ScriptedState, outcomes: [found, nothing]}
                - RIGHT: {template: ScriptedState, outcomes: [found, nothing]}
              transitions: {left: left, right: right, neither: neither}

    Right:
        name: sm
        template: Base
        outcomes: [left, right, neither]
        states:
          - LOOK:
              template: Concurrence
              outcomes: [left, right, neither]
              default_outcome: neither
              outcome_map:
                left: {LEFT: found}
                right: {LEFT: nothing, RIGHT: found}
              states:
                - LEFT: {template: ScriptedState, outcomes: [found, nothing]}
                - RIGHT: {template: ScriptedState, outcomes: [found, nothing]}
              transitions: {left: left, right: right, neither: neither}
    """
    for each in context.judged:
        if len(each.read.written) > 1:
            spaces = [without_other(each.whole)]
            if each.read.node.join == "any":
                spaces = [space for space, _ in each.calm]
            try:
                yield from _overlaps(each, spaces)
            except UndecidedError:
                continue


def _overlaps(each: Judged, spaces: list[Space]) -> Iterator[Finding]:
    """For each rule that ties with one above it the first of them."""
    read = each.read
    same: dict[int, int] = {}
    for number, conditions in enumerate(read.rules.conditions):
        above = same.get(len(conditions), 0) & read.rules.compatible(number)
        same[len(conditions)] = same.get(len(conditions), 0) | 1 << number
        ties = (_tie(read, spaces, other, number) for other in bits(above))
        tie = next(filter(None, ties), None)
        if tie is not None:
            yield _overlapping(each, number, tie)


def _tie(read: Study, spaces: list[Space], first: int, second: int) -> Combination | None:
    """A combination in which the two rules tie and frameworks differ, if there is one.

    Only what decides is shown of it, unless a third rule has to hold as well.
    """
    rules = read.rules
    given = {**rules.conditions[first], **rules.conditions[second]}
    others = rules.larger_than(len(rules.conditions[second]) - 1) & ~(1 << first | 1 << second)
    for avoided in dict.fromkeys((others, read.larger(second))):
        for space in spaces:
            found = rules.find(space, given, avoided)
            if found is not None and len({read.written[n].outcome for n in _ends(read, found)}) > 1:
                return rules.shown(found, given, avoided) if avoided == others else found
    return None


def _ends(read: Study, combination: Combination) -> tuple[int, int]:
    """The first and the last of the rules that win."""
    winners = read.winners(combination)
    return winners[0], winners[-1]


def _overlapping(each: Judged, number: int, tie: Combination) -> Finding:
    first, last = _ends(each.read, tie)
    above, below = each.read.written[first], each.read.written[last]
    here = each.read.written[number]
    return Finding(
        span=here.span,
        message=f"the rules for `{above.outcome}` and `{below.outcome}` both hold when"
        f" {written(tie)}, and list as many children: SMACH for Noetic ends with"
        f" `{above.outcome}`, SMACH for ROS 2 with `{below.outcome}`",
        help="let one of them list more children: then it wins everywhere",
        related=(
            *other_place(above.span, "the other rule"),
            *calls(each.read.node, here.span),
        ),
        node=each.path,
    )
