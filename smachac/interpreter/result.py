"""What a run is told and tells: what leaves do, events, how it ended."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, TypeAlias

from smachac.diagnostics.source import Span
from smachac.interpreter.userdata import Userdata, UserdataFault
from smachac.ir.nodes import Leaf

Event: TypeAlias = dict[str, Any]
"""One line of a trace: `seq`, `event`, `path`, then what the event has of `outcome`, `to`, `key`,
`value`, `message`, then `t` in seconds and, where known, `src` as `file:line`."""

Behaviour = Callable[[str, Leaf, int, Userdata], str]
"""What a leaf does: from its path, node, number of this visit (from 1) and userdata to an outcome.

It may raise: the run then ends with an error.
"""

Fault = Literal[
    UserdataFault,
    "behaviour",
    "undeclared-outcome",
    "no-outcome",
    "no-transition",
    "no-target",
    "no-state",
    "no-items",
    "no-end",
]
"""Why a run failed: what a leaf did wrong, a graph that leads nowhere, or no end in sight."""

NO_OUTCOME = "ended without an outcome"
"""What a trace says of a state whose code returned nothing."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Failure:
    """Where and why a run failed."""

    kind: Fault
    path: str
    message: str
    span: Span = field(compare=False, repr=False)

    def __str__(self) -> str:
        return f"{self.path}: {self.message}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Choice:
    """A moment at which several branches of a concurrence, by path, could go on, and which did."""

    taken: str
    ready: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Result:
    """How a run ended: an outcome or an error, with all userdata as it was left.

    `scopes` holds the userdata of every container by its path, `userdata` that of the outermost.
    `steps` counts states entered; `time` is virtual, in seconds. `choices` are the turns that were
    taken where several could have been.
    """

    outcome: str | None
    userdata: dict[str, object]
    error: Failure | None = None
    scopes: Mapping[str, dict[str, object]] = field(default_factory=dict)
    steps: int = 0
    time: float = 0.0
    choices: tuple[Choice, ...] = ()


class RunError(Exception):
    """Carries a failure up to the next concurrence, or out of the run."""

    def __init__(self, failure: Failure) -> None:
        super().__init__(str(failure))
        self.failure = failure
