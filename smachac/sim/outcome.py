"""The result of a skill: its outcome, the reason, and the value that it found."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

Outcome = Literal["succeeded", "aborted", "preempted"]

Preempted = Callable[[], bool] | None
"""The preempt check of a skill, called before each physics step; None: it is never preempted."""


@dataclass(frozen=True, slots=True)
class Result:
    """The end of a skill. `reason` is empty if it succeeded; `value` depends on the skill."""

    outcome: Outcome
    reason: str = ""
    value: Any = None
