"""What findings say beside the fault: the name that was meant, the calls that led there."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable
from itertools import takewhile

from smachac.diagnostics import Related
from smachac.ir.nodes import Node
from smachac.source import NOWHERE, Span

MOST_COMPARED = 20_000
"""So many pairs of names one guesser compares; beyond, only a difference in case is found. So ten
thousand misspelt names take no longer than they should."""

Guesser = Callable[[str], "str | None"]

FAILURES = frozenset(
    ["abort", "aborted", "error", "fail", "failed", "failure", "timed_out", "timeout"]
)
"""The words that outcomes of failure end with: `aborted`, `grasp_failed`."""

PREEMPTED = "preempted"
"""The outcome of a state that was asked to stop; it never comes by itself."""


def is_failure(outcome: str) -> bool:
    name = outcome.lower()
    return name in FAILURES or name.rpartition("_")[2] in FAILURES


def guesser(candidates: Iterable[str]) -> Guesser:
    """A function that finds the candidate nearest to a misspelt name, or None."""
    names = list(dict.fromkeys(candidates))
    folded = {name.casefold(): name for name in reversed(names)}
    known: dict[str, str | None] = {}
    compared = 0

    def guess(word: str) -> str | None:
        nonlocal compared
        if word in known:
            return known[word]
        nearest = folded.get(word.casefold())
        if nearest is None and compared + len(names) <= MOST_COMPARED:
            compared += len(names)
            nearest = next(iter(difflib.get_close_matches(word, names, n=1)), None)
        known[word] = nearest
        return nearest

    return guess


def did_you_mean(name: str | None) -> str | None:
    """The help line for a guess."""
    return f"did you mean `{name}`?" if name else None


def calls(node: Node, span: Span) -> tuple[Related, ...]:
    """The calls of sub-scripts that led into the file where `span` lies, outermost first."""
    outside = takewhile(lambda call: call.source is not span.source, node.via)
    return tuple(Related(span=call, message="in the sub-script called here") for call in outside)


def other_place(span: Span, message: str) -> tuple[Related, ...]:
    """A related place, if there is one."""
    return () if span.source is NOWHERE.source else (Related(span=span, message=message),)
