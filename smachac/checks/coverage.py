"""Rules over outcome maps: whether they leave a combination out, and whether they contradict."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from smachac.checks.branches import Space, Study, without_other
from smachac.checks.combinations import Combination, UndecidedError, bits
from smachac.checks.endings import Judged, judged
from smachac.checks.hints import calls, other_place
from smachac.diagnostics import Finding, Severity, rule
from smachac.ir.nodes import Machine


def written(combination: Mapping[str, str]) -> str:
    """A combination as it stands in a script."""
    return ", ".join(f"`{child}: {outcome}`" for child, outcome in combination.items())


@rule("SM401", "uncovered-combination", Severity.ERROR, firm=True)
def uncovered_combination(machine: Machine) -> Iterator[Finding]:
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
    for each in judged(machine):
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
def overlapping_rules(machine: Machine) -> Iterator[Finding]:
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
    for each in judged(machine):
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
