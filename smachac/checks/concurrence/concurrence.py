"""Rules over concurrences: missing states, and faults of the outcome map."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from smachac.analysis.context import Context
from smachac.analysis.control_flow import has_no_interface
from smachac.analysis.iterator_stops import inverted_renames
from smachac.analysis.outcome_rules import (
    Combination,
    Rules,
    SoundConcurrence,
    Space,
    UndecidedError,
    bits,
    rules_of,
    without_end,
    without_other,
)
from smachac.analysis.possible_outcomes import Judged
from smachac.analysis.watched_branches import missing_joins
from smachac.checks.findings import notation
from smachac.checks.findings.help_text import (
    calls,
    did_you_mean,
    ends_of,
    in_conditions,
    other_place,
)
from smachac.checks.findings.inverted_rules import inverted_rules, transposed_rules
from smachac.checks.findings.value_places import place_of_value
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import listed
from smachac.ir import nodes
from smachac.ir.nodes import Concurrence, Leaf, Node, OutcomeRule
from smachac.ir.outcome_names import PREEMPTED, fails, of_one_meaning
from smachac.ir.traversal import ends_preempted, leads_to_child, outcome_names

UNKNOWN_BRANCH = "SMACH refuses a rule with an unknown state or outcome: the program does not start"


@rule("SM403", "dead-rule", Severity.ERROR, unsuppressible=True)
def dead_rule(context: Context) -> Iterator[Finding]:
    """A rule of the outcome map can never decide the outcome.

    The case that the rule was written for ends with another outcome, and the robot continues with
    the wrong state. SMACH does not run a concurrence whose rule names an unknown state, and its
    versions disagree about a rule without conditions.

    Exactly: an error if the rule has no conditions, or if it names a state or an outcome that does
    not exist. A warning if a rule with more conditions holds whenever this rule holds; or with
    `join: any`, if the rule needs two branches that end by themselves, although the first one to
    end preempts the other (a branch that answers with `preempted`, or a machine of such states that
    leads every `preempted` out of it; two branches that end at the same moment do not count). An
    outcome that a container declares but never ends with is reported by SM203 only. The entries of
    the final outcome map of an iterator count as rules.

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
    for judged in context.judged:
        yield from _shadowed_rules(judged)
        if judged.concurrence.node.join == "any":
            yield from _rules_for_both(judged)


def _without_conditions(path: str, container: Concurrence, entry: OutcomeRule) -> Finding:
    """The finding on a rule that is empty, or lists states with `any` only."""
    what = " beside `any`, which stands for every outcome" if entry.ignored else ""
    example = notation.rule(container, entry.outcome, [_example(container)])
    help = f"write conditions, as in `{example}`, or remove the rule"
    if entry.ignored and container.default_outcome in ("", entry.outcome):
        default = notation.name(container, "default_outcome", entry.outcome)
        help = f"write `{default}` in place of the rule"
    return Finding(
        span=entry.span,
        message=f"the rule for `{entry.outcome}` has no conditions{what}",
        arguments=(entry.outcome,),
        help=help,
        effect="with such a rule the outcome depends on the version of SMACH",
        related=calls(container, entry.span),
        node=path,
    )


def _dead_rules(path: str, container: Concurrence) -> Iterator[Finding]:
    """The rules about states and outcomes that do not exist."""
    children = {child.name: child for child in container.children}
    if len(children) < len(container.children):
        return  # SM106: a rule can be about a state that has the name of another one
    guess = guesser(children)
    states = f"use one of its states: {listed(children)}" if children else "add states to it"
    inverted = [inverted.rule for inverted in inverted_rules(container)]
    transposed = transposed_rules(container)
    for entry in container.rules:
        if entry in inverted or entry.outcome in transposed:  # SM103 reports them
            continue
        for word in entry.ignored:
            if word.text not in children:
                yield Finding(
                    span=word.span,
                    message=f"`{word.text}` is not a state of `{container.name}`",
                    arguments=(entry.outcome, word.text),
                    help=did_you_mean(guess(word.text)) or states,
                    effect=UNKNOWN_BRANCH,
                    related=calls(container, word.span),
                    node=path,
                )
        if not entry.when:
            yield _without_conditions(path, container, entry)
        for condition in entry.when:
            if not condition.child:
                continue  # a rule of a wrong shape: SM004
            child, span = children.get(condition.child), condition.span
            if child is None:
                message = f"`{condition.child}` is not a state of `{container.name}`"
                help = did_you_mean(guess(condition.child)) or states
            elif has_no_interface(child) or condition.outcome in outcome_names(child):
                continue
            else:
                message = f"`{child.name}` has no outcome `{condition.outcome}`"
                help = _other_outcome(container, child, condition.outcome)
                span = place_of_value(span, condition.outcome)
            related = calls(container, span)
            yield Finding(
                span=span,
                message=message,
                arguments=(entry.outcome, condition.child, condition.outcome),
                help=help,
                effect=UNKNOWN_BRANCH,
                related=related,
                node=path,
            )


def _example(container: Concurrence) -> tuple[str, str]:
    """A condition on the first branch of a concurrence, as an example."""
    for child in container.children:
        for name in outcome_names(child):
            return child.name, name
    return "STATE", "OUTCOME"


MOST_COMPARED_RULES = 100
"""The most rules of a concurrence that are compared with a wrong one for its help."""


def _other_outcome(container: Concurrence, child: Node, outcome: str) -> str:
    """The help for an outcome in a rule that its state does not have."""
    names = outcome_names(child)
    known = f"use one of its outcomes: {listed(names)}" if names else "it has no outcomes"
    meant = guesser(names).unique_match(outcome) or of_one_meaning(child, outcome, names)
    alike = [state.name for state in container.children
             if state is not child and state.type == child.type]  # fmt: skip
    is_searched = meant is None and len(container.rules) <= MOST_COMPARED_RULES
    others = {part.outcome: part.child for rule in container.rules for part in rule.when
              if part.child in alike and part.outcome in names
              and part.outcome != PREEMPTED} if is_searched else {}  # fmt: skip
    if meant is None and len(others) == 1:
        ((name, other),) = others.items()
        right = notation.entry(container, child.name, name)
        return f"write `{right}`, as in the rule for `{other}`"
    meant = meant or guesser(names)(outcome)
    return did_you_mean(meant) or ends_of(child) or _documented(child) or known


def _documented(child: Node) -> str | None:
    """The help for an unknown outcome of a state whose type documents its outcomes."""
    docs = [(outcome.name, outcome.doc.strip().rstrip(".")) for outcome in child.outcomes
            if outcome.name not in (PREEMPTED, child.catches)]  # fmt: skip
    if not docs or not all(doc for _, doc in docs):
        return None
    first = (f"`{name}` ({doc[0].lower()}{doc[1:]})" for name, doc in docs)
    return f"use {' or '.join(first)}"


def _shadowed_rules(each: Judged) -> Iterator[Finding]:
    """The rules that lose to rules with more conditions in every combination."""
    concurrence, rules, whole = each.concurrence, each.concurrence.rules, each.whole
    for number, entry in enumerate(concurrence.written):
        given, larger = rules.conditions[number], concurrence.larger(number)
        rivals = larger & rules.compatible(number)
        if not rivals or any(end not in whole[child] for child, end in given.items()):
            continue
        try:
            if rules.find(whole, given, larger) is not None:
                continue
        except UndecidedError:
            return
        winners = [concurrence.written[rival] for rival in bits(rivals)]
        outcomes = sorted({winner.outcome for winner in winners})
        yield Finding(
            span=entry.span,
            message=f"the rule for `{entry.outcome}` never decides: a rule with more conditions,"
            f" for {listed(outcomes)}, always wins",
            arguments=(entry.outcome, *outcomes),
            help="remove the rule, or add conditions to it",
            effect="",
            related=(
                *(part for one in winners[:3] for part in other_place(one.span, "this rule wins")),
                *calls(concurrence.node, entry.span),
            ),
            severity=Severity.WARNING,
            node=each.path,
        )


def _rules_for_both(each: Judged) -> Iterator[Finding]:
    """The rules of a race that need two branches to end by themselves: the first to end preempts
    the other."""
    node = each.concurrence.node
    for entry in each.concurrence.written:
        needed = {
            one.child: one.outcome
            for one in entry.when
            if _ends_otherwise(each.concurrence.children[one.child], one.outcome)
        }
        if len(needed) < 2:
            continue
        yield Finding(
            span=entry.span,
            message=f"the rule for `{entry.outcome}` needs {in_conditions(needed)}, but `join:"
            f" any` of `{node.name}` preempts the others when the first of them ends",
            arguments=(entry.outcome, *_names(needed)),
            help="write `join: all`, or list only one of them in the rule",
            effect="",
            related=calls(node, entry.span),
            severity=Severity.WARNING,
            node=each.path,
        )


def _ends_otherwise(branch: Node, outcome: str) -> bool:
    """Whether a preempt request surely ends a branch with another outcome than this."""
    if outcome == PREEMPTED:
        return False
    match branch:
        case Leaf():
            return PREEMPTED in outcome_names(branch) and not branch.open
        case nodes.StateMachine() if not branch.sugar:
            states = frozenset(child.name for child in branch.children)
            return all(
                _ends_otherwise(child, outcome)
                and isinstance(child, Leaf)
                and all(
                    step.outcome != PREEMPTED
                    or not (step.target == outcome or leads_to_child(step, states))
                    for step in child.transitions
                )
                for child in branch.children
            )
    return ends_preempted(branch)


def _dead_renames(path: str, container: nodes.Iterator) -> Iterator[Finding]:
    """The entries of an iterator's final map for outcomes that never occur. An outcome that starts
    the next item does occur: it ends the iterator after a request to stop."""
    if any(has_no_interface(child) for child in container.children):
        return
    endings = [name for child in container.children for name in outcome_names(child)]
    known = [*endings, container.exhausted_outcome]
    spans = container.final_spans or (container.span,) * len(container.final_map)
    for (name, result), span in zip(container.final_map if endings else (), spans, strict=False):
        if name in known:
            continue
        inverted = (name, result) in inverted_renames(container)
        in_order = f"write `{notation.entry(container, result, name)}`: the outcome that is renamed"
        in_order += " comes first"
        yield Finding(
            span=span,
            message=f"the final outcome map of `{container.name}` renames `{name}`, but its state"
            " never ends with that outcome",
            arguments=(name,),
            help=(in_order if inverted else did_you_mean(guesser(known)(name)))
            or f"use one of the outcomes with which it can end: {listed(known)}",
            effect="SMACH never uses the entry",
            related=calls(container, span),
            node=path,
        )


@rule(
    "SM408",
    "empty-concurrence",
    Severity.ERROR,
    unsuppressible=True,
    effect="SMACH for ROS 2 waits forever for the first state to end, and SMACH for Noetic fails",
)
def empty_concurrence(context: Context) -> Iterator[Finding]:
    """A concurrence has no states.

    SMACH for ROS 2 waits forever for the first state to end, and SMACH for Noetic fails.

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
                message=f"the concurrence `{container.name}` has no states",
                arguments=(container.name,),
                help="add a state under `states`, as in `- NAME: {template: ...}`, or remove the"
                f" concurrence `{container.name}`",
                related=calls(container, container.span),
                node=path,
            )


@rule(
    "SM401",
    "uncovered-combination",
    Severity.ERROR,
    unsuppressible=True,
    effect="the concurrence has no outcome for this combination, so no program is generated",
)
def uncovered_combination(context: Context) -> Iterator[Finding]:
    """A combination of outcomes has neither a rule in the outcome map nor a default outcome.

    A concurrence without `default_outcome` needs rules for all combinations. If the states end with
    a combination that has no rule, possibly one of a thousand, the robot stops there.

    Exactly: every combination counts, also one that only a request to stop can cause; of a
    container, only the outcomes that its states can cause count. With a default outcome the finding
    is a note, and only for a combination in which every state ended by itself and none failed: such
    a combination may have been forgotten, and the default outcome is meant for the others.

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
    for judged in context.judged:
        node, rules = judged.concurrence.node, judged.concurrence.rules
        if node.default_outcome and not node.rules:
            continue
        missed = _missed(judged)
        if missed is not None:
            yield _uncovered(judged.path, node, rules, missed)
    for path, container in context.containers:
        if isinstance(container, Concurrence) and container.join == "rule":
            rules = rules_of(container)
            missed = without_end(container, rules)
            if missed is not None:
                yield _uncovered(path, container, rules, missed)


def _uncovered(path: str, node: Concurrence, rules: Rules, missed: Combination) -> Finding:
    """The finding about a combination of outcomes that no rule matches."""
    needed = rules.shown(missed, {}, rules.all)
    shown = in_conditions(needed) or "any combination"
    if node.default_outcome:
        severity, span = Severity.INFO, node.default_span
        message = f"no rule of `{node.name}` matches {shown}: it ends with the default outcome"
        message += f" `{node.default_outcome}`"
        rule = notation.rule(node, "OUTCOME", needed.items())
        help = f"if another outcome is meant, add a rule for it, as in `{rule}`"
        effect = ""
    else:
        severity, span = Severity.ERROR, node.span
        effect = None
        message = f"no rule of `{node.name}` matches {shown}, and `default_outcome` is missing"
        help = _covering(node, needed)
    return Finding(
        span=span,
        message=message,
        arguments=_names(needed),
        help=help,
        effect=effect,
        related=calls(node, span),
        severity=severity,
        node=path,
    )


MOST_WIDENED = 3
"""The most rules that a help names for a combination without a rule."""


def _covering(node: Concurrence, needed: Mapping[str, str]) -> str:
    """The help for a combination without a rule. No outcome is chosen but a failure."""
    names = outcome_names(node)
    bad = next((name for name in reversed(names) if fails(node, name)), None)
    default = f"`{notation.name(node, 'default_outcome', bad)}`" if bad else "a `default_outcome`"
    if needed and not node.rules:
        rules = f"{{{notation.rule(node, 'OUTCOME', needed.items())}}}"
        rules = notation.field(node, "outcome_map", rules)
        return f"write rules for its outcomes, as in `{rules}`, and {default}"
    every = f"write {default} for all combinations without a rule"
    wider = []
    for entry in node.rules if needed else ():
        others = [part for part in entry.when if needed.get(part.child) != part.outcome]
        if len(others) == 1 and len(entry.when) > 1:
            condition = notation.entry(node, others[0].child, others[0].outcome)
            wider.append(f"remove `{condition}` from the rule for `{entry.outcome}`")
    if wider and not bad:
        return f"{', or '.join(wider[:MOST_WIDENED])}; or {every}"
    free = _without_rule(node)
    rule = notation.rule(node, free, needed.items())
    return f"{every}, or add a rule, as in `{rule}`" if needed and free else every


def _without_rule(node: Concurrence) -> str:
    """The only outcome without a rule, as an outcome has one entry in the map; else empty."""
    taken = {rule.outcome for rule in node.rules}
    free = [name for name in outcome_names(node) if name not in taken]
    return free[0] if len(free) == 1 else ""


def _names(combination: Mapping[str, str]) -> tuple[str, ...]:
    """The states and outcomes of a combination, as arguments of a finding."""
    return tuple(name for pair in sorted(combination.items()) for name in pair)


def _missed(each: Judged) -> Combination | None:
    """A combination that no rule matches, of those that count."""
    rules = each.concurrence.rules
    spaces = [_unexceptional(each.concurrence, space) for space, _ in each.unstopped]
    if not each.concurrence.node.default_outcome:
        spaces.append(without_other(each.whole))
    try:
        return next(filter(None, (rules.find(space, {}, rules.all) for space in spaces)), None)
    except UndecidedError:
        return None


def _unexceptional(concurrence: SoundConcurrence, space: Space) -> Space:
    return {name: concurrence.neutral(name, ends) for name, ends in space.items()}


@rule("SM402", "overlapping-rules", Severity.WARNING)
def overlapping_rules(context: Context) -> Iterator[Finding]:
    """Two rules of the outcome map hold for the same combination of outcomes, and neither wins.

    The outcome then depends on the framework: SMACH for ROS 2 applies the last rule, SMACH for
    Noetic the first, and others stop with an error. A rule with more conditions wins in all of
    them.

    Exactly: there is a combination for which both rules hold, with equally many conditions, and no
    rule with more conditions holds. With `join: any`, a branch that can be preempted counts as
    preempted when another branch has ended; two branches that end at the same moment do not count.

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
    missing: frozenset[str] | None = None
    for judged in context.judged:
        if len(judged.concurrence.written) > 1:
            missing = missing_joins(context) if missing is None else missing
            if judged.path in missing:
                continue  # SM407
            spaces = [without_other(judged.whole)]
            if judged.concurrence.node.join == "any":
                spaces = [space for space, _ in judged.unstopped]
            try:
                yield from _overlaps(judged, spaces)
            except UndecidedError:
                continue


def _overlaps(each: Judged, spaces: list[Space]) -> Iterator[Finding]:
    """For each rule that ties with rules above it, the tie with the first of them."""
    concurrence = each.concurrence
    same: dict[int, int] = {}
    for number, conditions in enumerate(concurrence.rules.conditions):
        above = same.get(len(conditions), 0) & concurrence.rules.compatible(number)
        same[len(conditions)] = same.get(len(conditions), 0) | 1 << number
        ties = (_tie(concurrence, spaces, other, number) for other in bits(above))
        tie = next(filter(None, ties), None)
        if tie is not None:
            yield _overlapping(each, number, tie)


def _tie(
    concurrence: SoundConcurrence, spaces: list[Space], first: int, second: int
) -> Combination | None:
    """A combination in which the two rules tie and frameworks differ, if there is one.

    It is reduced to the conditions that decide, unless a third rule has to hold as well.
    """
    rules = concurrence.rules
    given = {**rules.conditions[first], **rules.conditions[second]}
    others = rules.larger_than(len(rules.conditions[second]) - 1) & ~(1 << first | 1 << second)
    for avoided in dict.fromkeys((others, concurrence.larger(second))):
        for space in spaces:
            found = rules.find(space, given, avoided)
            if (
                found is not None
                and len({concurrence.written[n].outcome for n in _ends(concurrence, found)}) > 1
            ):
                return rules.shown(found, given, avoided) if avoided == others else found
    return None


def _ends(concurrence: SoundConcurrence, combination: Combination) -> tuple[int, int]:
    """The first and the last of the rules that win."""
    winners = concurrence.winners(combination)
    return winners[0], winners[-1]


def _overlapping(each: Judged, number: int, tie: Combination) -> Finding:
    first, last = _ends(each.concurrence, tie)
    above, below = each.concurrence.written[first], each.concurrence.written[last]
    here = each.concurrence.written[number]
    rule = notation.rule(each.concurrence.node, above.outcome, tie.items())
    return Finding(
        span=here.span,
        message=f"the rules for `{above.outcome}` and `{below.outcome}` both hold for"
        f" {in_conditions(tie)}: SMACH for Noetic ends with `{above.outcome}`, SMACH for ROS 2 with"
        f" `{below.outcome}`",
        arguments=(above.outcome, below.outcome, *_names(tie)),
        help="add a condition to the rule that must win, as in"
        f" `{rule}`: the rule with more conditions wins",
        related=(
            *other_place(above.span, "the other rule"),
            *calls(each.concurrence.node, here.span),
        ),
        node=each.path,
    )
