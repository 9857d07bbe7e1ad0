"""Meaning of outcome names: success, failure, preemption."""

from __future__ import annotations

from collections.abc import Iterable

GOOD_OUTCOMES = ("succeeded", "success", "done", "ok", "true")
"""Names of outcomes with which a state usually ends."""


FAILURES = frozenset(
    ["abort", "aborted", "error", "fail", "failed", "failure", "timed_out", "timeout"]
)
"""The last words of outcomes of failure: `aborted`, `grasp_failed`."""

SUCCESSES = frozenset(["succeed", "succeeded", "success", "successful"])
"""Outcomes that always mean success."""

GOOD = frozenset(
    ["complete", "completed", "done", "finished", "ok", "okay", "ready", "true", "valid", "yes"]
)
"""Outcomes that mean success if the state also has an outcome of failure."""

PREEMPTED = "preempted"
"""The outcome of a preempted state; without a request to stop it does not occur."""


def is_failure(outcome: str) -> bool:
    """Whether an outcome means failure."""
    name = outcome.lower()
    return name in FAILURES or name.rpartition("_")[2] in FAILURES


def successes(outcomes: Iterable[str]) -> frozenset[str]:
    """The outcomes of one state that certainly mean success."""
    names = [*outcomes]
    words = SUCCESSES | GOOD if any(map(is_failure, names)) else SUCCESSES
    return frozenset(name for name in names if name.lower() in words)


def good_first(outcomes: Iterable[str]) -> tuple[str, ...]:
    """Outcomes sorted: success first, failure and preemption last."""

    def rank(name: str) -> int:
        word = name.lower()
        if word in SUCCESSES or word in GOOD:
            return 0
        return 3 if name == PREEMPTED else 2 if is_failure(name) else 1

    return tuple(sorted(outcomes, key=rank))
