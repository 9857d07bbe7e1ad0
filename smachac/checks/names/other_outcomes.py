"""What to write in place of an outcome that a state does not have."""

from __future__ import annotations

from collections.abc import Iterable

from smachac.analysis.control_flow import unknown_outcomes
from smachac.checks.findings import notation
from smachac.checks.findings.help_text import ends_of
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import both, listed
from smachac.ir import nodes
from smachac.ir.nodes import Leaf, Node, Transition
from smachac.ir.outcome_names import (
    fails,
    is_failure,
    meaning,
    of_one_meaning,
)
from smachac.ir.traversal import outcome_names

TIMEOUT = "timeout"
EXHAUSTED = "exhausted"


def suggested_outcomes(child: Node, unknown: Iterable[str]) -> dict[str, str]:
    """For unknown outcomes of a state the known ones that they can mean: the nearest name; of those
    without a transition the only one of the same meaning, or the only one, if it has no other
    meaning."""
    guess = guesser(outcome_names(child))
    found = {word: near for word in unknown if (near := guess(word)) is not None}
    used = {step.outcome for step in child.transitions if step.origin == "written"}
    used |= {*found.values(), child.catches}
    left = [name for name in outcome_names(child) if name not in used]
    only = left[0] if len(left) == 1 else None
    for word in unknown if left else ():
        alike = of_one_meaning(child, word, left)
        if alike is None and only is not None:
            meanings = {meaning(word, is_failure(word)), meaning(only, fails(child, only))}
            alike = only if len(meanings) == 1 or "" in meanings else None
        if alike is not None:
            found.setdefault(word, alike)
    return found


def other_outcome(child: Node, step: Transition) -> str:
    """The help for a transition for an unknown outcome that means none of the state: the field that
    adds it, or all outcomes."""
    names = outcome_names(child)
    if not names:
        return f"remove the transition: `{child.name}` has no outcomes"
    field = _missing_field(child, step.outcome)
    if field is not None:
        return field
    handled = {
        transition.outcome for transition in child.transitions if transition.origin == "written"
    }
    if handled.issuperset(name for name in names if name != child.catches):
        if len(names) == 1:
            return f"remove this transition: `{names[0]}`, the only outcome, has a transition"
        return f"remove this transition: {both(names)}, all outcomes, have transitions"
    return ends_of(child) or f"use one of its outcomes: {listed(names)}"


def missing_default(node: Node) -> Transition | None:
    """The only transition for an unknown outcome of a state that has the default of its interface
    in place of a `default_outcome`, without a transition: that outcome is the default."""
    variables = node.variables if isinstance(node, Leaf) else ()
    left = {*outcome_names(node)}.difference(step.outcome for step in node.transitions)
    unknown = unknown_outcomes(node)
    is_default = any(
        variable.name == "default_outcome"
        and variable.span == node.span
        and variable.value.data in left
        for variable in variables
    )
    return unknown[0] if is_default and len(unknown) == 1 else None


def _missing_field(child: Node, outcome: str) -> str | None:
    """The help for an outcome that a field of the language adds, which the state lacks."""
    if isinstance(child, nodes.Iterator | nodes.Concurrence) and child.sugar == "timeout":
        return None
    if notation.is_python(child):
        return None
    if outcome == TIMEOUT and not _has_limit(child):
        return (
            "a state has the outcome `timeout` only with the field `timeout`: write"
            f" `timeout: SECONDS` in `{child.name}`, or remove this transition"
        )
    if outcome == EXHAUSTED:
        failures = [name for name in outcome_names(child) if fails(child, name)]
        on = ", ".join(failures or ["OUTCOME"])
        return (
            "a state has the outcome `exhausted` only with the field `retry`: write"
            f" `retry: {{on: [{on}], max: 3}}` in `{child.name}`, or remove this transition"
        )
    return None


def _has_limit(child: Node) -> bool:
    """Whether a variable of the type of a state is a time limit, after which it ends with another
    outcome."""
    return isinstance(child, Leaf) and any(TIMEOUT in variable.name for variable in child.variables)
