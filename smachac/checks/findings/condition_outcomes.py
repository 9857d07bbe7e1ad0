"""Outcomes in the conditions of a state: unknown ones (SM102), and the one meant as default."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.checks.findings.edits import adding_outcome
from smachac.checks.findings.help_text import calls, did_you_mean
from smachac.checks.findings.value_places import place_of_part
from smachac.diagnostics.diagnostic import Finding
from smachac.diagnostics.source import Word
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import listed
from smachac.ir.leaf import functions, variable, variable_of
from smachac.ir.nodes import Leaf, Struct
from smachac.ir.traversal import outcome_names


def unknown_endings(path: str, leaf: Leaf) -> Iterator[Finding]:
    """The unknown outcomes in the conditions and steps of a leaf (SM102)."""
    outcomes = outcome_names(leaf) if leaf.variables and not leaf.open else []
    if not outcomes:
        return
    for word, what, effect in _endings(leaf):
        if word.text not in outcomes:
            meant = did_you_mean(guesser(outcomes)(word.text))
            is_used = any(step.outcome == word.text for step in leaf.transitions)
            yield Finding(
                span=word.span,
                message=f"{what} `{word.text}`, which is not one of its outcomes",
                arguments=(word.text,),
                help=meant
                or f"add `{word.text}` to the `outcomes` of `{leaf.name}` and to its transitions,"
                f" or use one of its outcomes: {listed(outcomes)}",
                effect=effect,
                related=calls(leaf, word.span),
                node=path,
                repairs=adding_outcome(leaf, word.text) if is_used else (),
            )


def _endings(leaf: Leaf) -> Iterator[tuple[Word, str, str]]:
    """The outcomes in the conditions and steps of a leaf, each with the start of its message, and
    with the effect of an unknown one."""
    conditions = variable_of(leaf, "conditions")
    for outcome, site in (functions(leaf, "conditions") or {}).items():
        span = site.span
        if conditions is not None and outcome not in outcome_names(leaf):
            place = place_of_part(conditions.value.span, (outcome,), key=True)
            span = place if place != conditions.value.span else span
        what = f"a condition of `{leaf.name}` leads to"
        yield Word(outcome, span), what, f"`{leaf.name}` never uses the condition"
    held = variable_of(leaf, "steps")
    if held is None or not isinstance(held.value.data, tuple):
        return
    for at, step in enumerate(held.value.data):
        end = dict(step.entries).get("outcome") if isinstance(step, Struct) else None
        if isinstance(end, str) and end and end not in outcome_names(leaf):
            place = place_of_part(held.value.span, (at, "outcome"))
            what = f"a step of `{leaf.name}` ends with"
            effect = (
                "SMACH raises InvalidTransitionError for an undeclared outcome: the machine stops"
            )
            yield Word(end, place), what, effect


def suggested_default(leaf: Leaf) -> str | None:
    """The declared outcome that is meant by a `default_outcome` without a transition: the only one
    to which no condition leads, if it has a transition."""
    default, conditions = variable(leaf, "default_outcome"), functions(leaf, "conditions")
    handled = {step.outcome for step in leaf.transitions}
    if not isinstance(default, str) or not conditions or default in handled:
        return None
    others = {*conditions, default, leaf.catches}
    left = [name for name in outcome_names(leaf) if name not in others]
    return left[0] if len(left) == 1 and left[0] in handled else None
