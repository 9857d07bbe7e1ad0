"""The rules of a concurrence, applied to the outcomes of its branches (docs/semantics.md,
Concurrence)."""

from __future__ import annotations

from collections.abc import Mapping

from smachac.ir.nodes import Concurrence, OutcomeRule


def matching_rule(node: Concurrence, ended: Mapping[str, object]) -> int:
    """The number of the rule that determines the outcome, or -1 for the default outcome.

    `ended` has the outcome of each branch by name, at least of those that have ended.
    """
    for number in _numbers(node):
        if all(ended.get(one.child) == one.outcome for one in node.rules[number].when):
            return number
    return -1


def outcome_of(node: Concurrence, ended: Mapping[str, object]) -> str:
    """The outcome of a concurrence whose branches ended with these outcomes, by name."""
    rule = matching_rule(node, ended)
    return node.rules[rule].outcome if rule >= 0 else node.default_outcome


def by_priority(node: Concurrence) -> list[OutcomeRule]:
    """The rules by priority: the first of them that matches determines the outcome."""
    return [node.rules[number] for number in _numbers(node)]


def _numbers(node: Concurrence) -> list[int]:
    """The numbers of the rules by priority: those with more conditions first, and of those with as
    many the last one; with `join: rule` in their order."""
    numbers = [*range(len(node.rules))]
    if node.join == "rule":
        return numbers
    return sorted(numbers, key=lambda number: (len(node.rules[number].when), number), reverse=True)
