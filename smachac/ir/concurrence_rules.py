"""The rules of a concurrence, applied to the outcomes of its branches (docs/semantics.md,
Concurrence)."""

from __future__ import annotations

from collections.abc import Mapping

from smachac.ir.nodes import Concurrence, OutcomeRule


def matching_rule(node: Concurrence, ended: Mapping[str, object]) -> int:
    """The number of the rule that determines the outcome, or -1 for the default outcome.

    `ended` has the outcome of each branch by name. Of the rules that match, the one with most
    conditions applies, and the last one if several have as many.
    """
    best, most = -1, 0
    for number, rule in enumerate(node.rules):
        holds = all(ended.get(one.child) == one.outcome for one in rule.when)
        if holds and len(rule.when) >= most:
            best, most = number, len(rule.when)
    return best


def outcome_of(node: Concurrence, ended: Mapping[str, object]) -> str:
    """The outcome of a concurrence whose branches ended with these outcomes, by name."""
    rule = matching_rule(node, ended)
    return node.rules[rule].outcome if rule >= 0 else node.default_outcome


def by_priority(node: Concurrence) -> list[OutcomeRule]:
    """The rules by priority: the first of them that matches determines the outcome."""
    numbered = enumerate(node.rules)
    found = sorted(numbered, key=lambda pair: (len(pair[1].when), pair[0]), reverse=True)
    return [rule for _, rule in found]
