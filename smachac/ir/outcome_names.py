"""What the names of outcomes mean: success, failure, preemption."""

from __future__ import annotations

from collections.abc import Iterable

GOOD_OUTCOMES = ("succeeded", "success", "done", "ok", "true")
"""Names of the outcome by which a state usually ends."""


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
