"""What findings say beside the fault: the name that was meant, the calls that led there."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import takewhile

from smachac.diagnostics import Related
from smachac.ir.nodes import Node
from smachac.source import NOWHERE, Span
from smachac.spelling import Guesser

FAILURES = frozenset(
    ["abort", "aborted", "error", "fail", "failed", "failure", "timed_out", "timeout"]
)
"""The words that outcomes of failure end with: `aborted`, `grasp_failed`."""

SUCCESSES = frozenset(["succeed", "succeeded", "success", "successful"])
"""The outcomes that say that all went well."""

GOOD = frozenset(
    ["complete", "completed", "done", "finished", "ok", "okay", "ready", "true", "valid", "yes"]
)
"""The outcomes that say so where there is an outcome of failure beside them."""

CALLED_HERE = "in the sub-script called here"

PREEMPTED = "preempted"
"""The outcome of a state that was asked to stop; it never comes by itself."""


def is_failure(outcome: str) -> bool:
    name = outcome.lower()
    return name in FAILURES or name.rpartition("_")[2] in FAILURES


def successes(outcomes: Iterable[str]) -> frozenset[str]:
    """Those of the outcomes of one state that mean success, beyond doubt."""
    names = [*outcomes]
    words = SUCCESSES | GOOD if any(map(is_failure, names)) else SUCCESSES
    return frozenset(name for name in names if name.lower() in words)


def good_first(outcomes: Iterable[str]) -> tuple[str, ...]:
    """Outcomes with those of success in front, those of failure and preemption last."""

    def rank(name: str) -> int:
        word = name.lower()
        if word in SUCCESSES or word in GOOD:
            return 0
        return 3 if name == PREEMPTED else 2 if is_failure(name) else 1

    return tuple(sorted(outcomes, key=rank))


def guesser(candidates: Iterable[str]) -> Guesser:
    """What finds the candidate nearest to a misspelt name."""
    return Guesser(candidates)


def did_you_mean(name: str | None) -> str | None:
    """The help line for a guess."""
    return f"did you mean `{name}`?" if name else None


def calls(node: Node, span: Span) -> tuple[Related, ...]:
    """The calls of sub-scripts that led into the file where `span` lies, outermost first."""
    outside = takewhile(lambda call: call.source is not span.source, node.via)
    return tuple(Related(span=call, message=CALLED_HERE) for call in outside)


def other_place(span: Span, message: str) -> tuple[Related, ...]:
    """A related place, if there is one."""
    return () if span.source is NOWHERE.source else (Related(span=span, message=message),)
