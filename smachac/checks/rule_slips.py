"""Help for rules of an outcome map that were copied, or that have lost a condition."""

from __future__ import annotations

from collections.abc import Sequence

from smachac.analysis.control_flow import is_open
from smachac.diagnostics.spelling import words_of, written_name
from smachac.ir.nodes import Concurrence, OutcomeRule
from smachac.ir.outcome_names import GOOD, PREEMPTED, SUCCESSES
from smachac.ir.traversal import outcome_names

UNKNOWN_BRANCH = "SMACH refuses a rule with an unknown state or outcome: the program does not start"


def _text(outcome: str, conditions: Sequence[tuple[str, str]]) -> str:
    parts = ", ".join(f"{written_name(child)}: {written_name(end)}" for child, end in conditions)
    return f"{written_name(outcome)}: {{{parts}}}"


def copied_rule_help(
    container: Concurrence, above: OutcomeRule, below: OutcomeRule, here: OutcomeRule
) -> str | None:
    """The help for two rules with the same conditions, where only one state of the concurrence is
    in no rule and has an outcome that one of the conditions names, or the same state has only one
    other outcome that is in no rule."""
    if here not in (above, below) or {*above.when} != {*below.when} or len(here.when) != 1:
        return None
    (condition,) = here.when
    used = {(part.child, part.outcome) for rule in container.rules for part in rule.when}
    states = {child for child, _ in used}
    free = [
        (child.name, condition.outcome)
        for child in container.children
        if child.name not in states and not is_open(child)
        and condition.outcome in outcome_names(child)
    ]  # fmt: skip
    if not free:
        default = [child for child in container.children if child.name == condition.child]
        free = [(child.name, name) for child in default if not is_open(child)
                for name in outcome_names(child)
                if (child.name, name) not in used
                and name not in (PREEMPTED, child.catches)]  # fmt: skip
        idle = [child.name for child in container.children if child.name not in states]
        free = [] if idle else free
    if len(free) != 1:
        return None
    first, second = free[0]
    words = words_of(first, second)
    named = [rule for rule in (above, below) if not words.isdisjoint(words_of(rule.outcome))]
    wrong = named[0] if len(named) == 1 else here
    return (
        f"no rule is about `{first}: {second}`: write it in one of the two rules, as in"
        f" `{_text(wrong.outcome, free)}`"
    )


def lost_condition(container: Concurrence, lost: str) -> str | None:
    """The condition that a rule for an outcome has probably lost: the only state that no rule
    names, or names only with `preempted`. Its outcome is the one by which the other rules name
    states of its type, else the only one, or the only one that is as good or bad as `lost`."""
    parts = [part for rule in container.rules for part in rule.when]
    used = {part.child: part.outcome for part in parts if part.outcome != PREEMPTED}
    left = [each for each in container.children if each.name not in used]
    if len(left) > 1:
        named = {part.child for part in parts}
        left = [each for each in left if each.name not in named]
    if len(left) != 1 or is_open(left[0]):
        return None
    (child,) = left
    names = [name for name in outcome_names(child) if name not in (PREEMPTED, child.catches)]
    alike = {used[each.name] for each in container.children
             if each.name in used and each.type == child.type}  # fmt: skip
    likely = [name for name in names if name in alike or name == lost] or names
    if len(likely) > 1:
        likely = [name for name in likely if _is_good(name) == _is_good(lost)]
    return f"{child.name}: {written_name(likely[0])}" if len(likely) == 1 else None


def _is_good(outcome: str) -> bool:
    return outcome.lower() in GOOD | SUCCESSES
