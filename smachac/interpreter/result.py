"""Inputs and results of a run: behaviour of leaves, trace events, failures, the final result."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Literal, TypeAlias

from smachac.diagnostics.source import Span
from smachac.interpreter.userdata import Userdata, UserdataErrorKind
from smachac.ir.nodes import Leaf
from smachac.records import dataclass, field

Event: TypeAlias = dict[str, Any]
"""One event of a trace: `seq`, `event`, `path`; then `outcome`, `to`, `key`, `value` or `message`,
depending on the kind of event; then `t` in seconds and, where known, `src` as `file:line`."""

Behaviour = Callable[[str, Leaf, int, Userdata], str]
"""The behaviour of leaves: from path, node, visit number (from 1) and userdata to an outcome.

If it raises an exception the run ends with an error.
"""

ErrorKind = Literal[
    UserdataErrorKind,
    "behaviour",
    "undeclared-outcome",
    "no-outcome",
    "no-transition",
    "no-target",
    "no-state",
    "no-items",
    "no-end",
]
"""The kind of error that ended a run: a fault of a leaf, an incomplete graph, or too many steps."""

NO_OUTCOME = "ended without an outcome"
"""The message of a trace for a state whose code returned nothing."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RunFailure:
    """The place and the reason of a failed run. `cycle`: the states that a run without end repeats,
    by path."""

    kind: ErrorKind
    path: str
    message: str
    cycle: tuple[str, ...] = ()
    span: Span = field(compare=False, repr=False)

    def __str__(self) -> str:
        return f"{self.path}: {self.message}"


@dataclass(frozen=True, slots=True, kw_only=True)
class SchedulingChoice:
    """A choice between branches of a concurrence, by path, that could continue, and the one that
    did."""

    taken: str
    ready: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class InterpreterResult:
    """The result of a run: an outcome or an error, and the userdata at the end.

    `scopes` holds the userdata of every container by its path, `userdata` that of the outermost
    one. `steps` counts the states entered; `time` is virtual, in seconds. `choices` are the
    scheduling choices that had more than one branch.
    """

    outcome: str | None
    userdata: dict[str, object]
    error: RunFailure | None = None
    scopes: Mapping[str, dict[str, object]] = field(default_factory=dict)
    steps: int = 0
    time: float = 0.0
    choices: tuple[SchedulingChoice, ...] = ()


class RunError(Exception):
    """Carries a failure to the enclosing concurrence, or out of the run."""

    def __init__(self, failure: RunFailure) -> None:
        super().__init__(str(failure))
        self.failure = failure
