"""Meaning of outcomes: success, failure, preemption.

An interface or a script declares it (`failure: true`); otherwise the words of the name decide.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

from smachac.ir import nodes
from smachac.ir.nodes import Node

GOOD_OUTCOMES = ("succeeded", "success", "done", "ok", "true")
"""Names of outcomes with which a state usually ends."""


TIMEOUTS = frozenset(["timed_out", "timeout"])
"""Outcomes after a time limit. They are failures, but a script may lead them to a success: many
waits have a limit on purpose."""

FAILURES = TIMEOUTS | {"abort", "aborted", "error", "fail", "failed", "failure"}
"""The last words of outcomes of failure: `aborted`, `grasp_failed`."""

NEGATIONS = frozenset(["never", "no", "non", "not", "without", "zero"])
"""Words that deny the word of failure behind them: `no_error`, `not_failed`."""

SUCCESSES = frozenset(["succeed", "succeeded", "success", "successful"])
"""Outcomes that always mean success."""

GOOD = frozenset(
    ["complete", "completed", "done", "finished", "ok", "okay", "ready", "true", "valid", "yes"]
)
"""Outcomes that mean success if the state also has an outcome of failure."""

PREEMPTED = "preempted"
"""The outcome of a preempted state; without a request to stop it does not occur."""

OF_SMACH = ("succeeded", "aborted", PREEMPTED)
"""The outcomes of SMACH's own states."""

STOPS = frozenset(
    [PREEMPTED, "cancel", "canceled", "cancelled", "halted", "interrupted", "stopped"]
)
"""Words of SMACH and of other frameworks for the outcome after a request to stop."""

_ENDS, _DIGITS = (*sorted(FAILURES), "out"), "0123456789_-. "
_WORDS = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])")


def is_failure(outcome: str) -> bool:
    """Whether the name of an outcome means failure."""
    name = outcome.lower()
    if name in FAILURES:
        return True
    if not name.rstrip(_DIGITS).endswith(_ENDS):
        return False
    *before, last = [word.lower() for word in _WORDS.findall(outcome)] or [""]
    if before[-1:] == ["timed"] and last == "out":
        before, last = before[:-1], "timed_out"
    return last in FAILURES and not NEGATIONS.intersection(before[-1:])


def fails(node: Node, outcome: str) -> bool:
    """Whether an outcome of a state is a failure: declared, an exception, used up tries of which
    one can fail, or by its name."""
    for result in node.outcomes:
        if result.name == outcome and result.failure is not None:
            return result.failure
    return _is_implied_failure(node, outcome)


def _is_implied_failure(node: Node, outcome: str) -> bool:
    if outcome and outcome == node.catches:
        return True
    match node:
        case nodes.Iterator(sugar="retry", exhausted_outcome=end) if outcome == end:
            return not tries_may_end(node)
    return is_failure(outcome)


def failures_of(node: Node) -> frozenset[str]:
    """The outcomes of a state that are failures."""
    declared = {outcome.name: outcome.failure for outcome in reversed(node.outcomes)
                if outcome.failure is not None}  # fmt: skip
    return frozenset([
        name for name in {outcome.name for outcome in node.outcomes}
        if (declared[name] if name in declared else _is_implied_failure(node, name))
    ])  # fmt: skip


def tries_may_end(retry: nodes.Iterator) -> bool:
    """Whether used up tries are no failure: each outcome that leads to another try is declared to
    be none, beside the end of a time limit."""
    declared = {
        outcome.name: outcome.failure for child in retry.children for outcome in child.outcomes
    }
    others = {name for name in retry.loop_outcomes if declared.get(name) is not False}
    return len(others) < len(retry.loop_outcomes) and others <= TIMEOUTS


def successes(node: Node) -> frozenset[str]:
    """The outcomes of a state that certainly mean success."""
    names = [outcome.name for outcome in node.outcomes]
    failures = failures_of(node)
    words = SUCCESSES | GOOD if failures else SUCCESSES
    return frozenset([name for name in names if name.lower() in words]).difference(failures)


def meaning(outcome: str, failure: bool) -> str:
    """`failure`, `stop`, `success`, or empty for an outcome with another meaning."""
    if failure:
        return "failure"
    if outcome.lower() in STOPS:
        return "stop"
    return "success" if outcome.lower() in GOOD | SUCCESSES else ""


def of_one_meaning(node: Node, word: str, names: Iterable[str]) -> str | None:
    """The only one of these outcomes of a state that has the meaning of an unknown one."""
    wanted = meaning(word, is_failure(word))
    alike = [name for name in names if meaning(name, fails(node, name)) == wanted]
    return alike[0] if wanted and len(alike) == 1 else None


def good_first(
    outcomes: Iterable[str], failed: Callable[[str], bool] = is_failure
) -> tuple[str, ...]:
    """Outcomes of one state sorted: success first, those that `failed` and preemption last."""

    def rank(name: str) -> int:
        word = name.lower()
        if word in SUCCESSES or word in GOOD:
            return 0
        return 3 if name == PREEMPTED else 2 if failed(name) else 1

    return tuple(sorted(outcomes, key=rank))
