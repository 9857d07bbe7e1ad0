"""The gate of a debugger: each state of a running machine passes it before its start and after its
end."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol


class Gate(Protocol):
    """The interface between a running machine and a debugger.

    While `armed` is true, the machine calls `before` and `after` in the thread of the state. Both
    may wait. Paths are those of the state graph. `outcomes` are those that the state can end with.
    """

    armed: bool

    def opened(self, request_stop: Callable[[], None]) -> None:
        """A machine is ready to start; `request_stop` sends it a request to stop."""

    def before(self, path: str, outcomes: Sequence[str]) -> str | None:
        """Called before a state starts. Returns None, or the outcome in place of its execution."""

    def after(self, path: str, outcome: str, outcomes: Sequence[str]) -> str:
        """Called when a state has ended with `outcome`. Returns the outcome to continue with."""
        ...

    def release(self) -> None:
        """The machine has a request to stop: `before` and `after` must not wait any more."""
