"""What to write in place of an outcome that a state does not have."""

from __future__ import annotations

from smachac.checks import notation
from smachac.checks.help_text import ends_of
from smachac.diagnostics.wording import both, listed
from smachac.ir import nodes
from smachac.ir.nodes import Leaf, Node, Transition
from smachac.ir.outcome_names import GOOD, PREEMPTED, STOPS, SUCCESSES, fails, is_failure
from smachac.ir.traversal import outcome_names

TIMEOUT = "timeout"
EXHAUSTED = "exhausted"


def other_outcome(child: Node, step: Transition) -> str:
    """The help for a transition for an unknown outcome that is like none of the state: the field
    that adds it, the only outcome without a transition, or else all outcomes."""
    names = outcome_names(child)
    if not names:
        return f"remove the transition: `{child.name}` has no outcomes"
    field = _missing_field(child, step.outcome)
    if field is not None:
        return field
    handled = {each.outcome for each in child.transitions if each.origin == "written"}
    left = [name for name in names if name not in handled and name != child.catches]
    if not left:
        is_one = len(names) == 1
        have = "its outcome" if is_one else "its outcomes"
        return f"remove this transition: {have} {both(names)} {'has' if is_one else 'have'} one"
    if len(left) == 1 and _can_mean(child, step.outcome, left[0]):
        right = notation.entry(child, left[0], step.target)
        return f"write `{right}`: `{left[0]}` is its only outcome without a transition"
    return ends_of(child) or f"use one of its outcomes: {listed(names)}"


def _can_mean(child: Node, word: str, outcome: str) -> bool:
    """Whether an unknown outcome does not clearly mean something else than an outcome."""
    good = word.lower() in SUCCESSES | GOOD
    if outcome == PREEMPTED:
        return not good and not is_failure(word)
    if word.lower() in STOPS:
        return False
    return not (good and fails(child, outcome)) and not (is_failure(word) and _is_good(outcome))


def _is_good(outcome: str) -> bool:
    return outcome.lower() in SUCCESSES | GOOD


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
    return isinstance(child, Leaf) and any(TIMEOUT in each.name for each in child.variables)


def continuing_outcome(container: nodes.Iterator) -> str | None:
    """The only outcome of the child of an iterator that can start the next item: the only one with
    which the iterator does not end by itself, that is not renamed, that is no failure, or the only
    one with the name of a success."""
    names = dict.fromkeys(name for child in container.children for name in outcome_names(child))
    left = [name for name in names if name not in container.loop_outcomes and name != PREEMPTED]
    ends = {*outcome_names(container)} - {container.exhausted_outcome}
    renamed = dict(container.final_map)
    failing = {name for child in container.children for name in names if fails(child, name)}
    for choices in (
        [name for name in left if name not in ends],
        [name for name in left if name not in ends and name not in renamed],
        [name for name in left if name not in failing],
        [name for name in left if _is_good(name)],
    ):
        if len(choices) == 1:
            return choices[0]
    return None
