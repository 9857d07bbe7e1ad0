"""Requests to stop, and which states they have reached (P*)."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass, field


@dataclass(slots=True)
class Preemption:
    """The states, by path, that were asked to stop and have not answered yet.

    `running` names the children of each running container that have not ended; `wake` is what to
    call when a request reaches a branch that may be waiting. `told` hears of every request that
    reaches a state.
    """

    told: Callable[[str], None]
    asked: set[str] = field(default_factory=set)
    running: dict[str, list[str]] = field(default_factory=dict)
    wake: dict[str, Callable[[], None]] = field(default_factory=dict)

    def request(self, path: str) -> None:
        """Ask a state and all that runs in it, outer before inner (P2)."""
        pending = [path]
        while pending:
            here = pending.pop()
            self.asked.add(here)
            self.told(here)
            if here in self.wake:
                self.wake[here]()
            pending.extend(reversed(self.running.get(here, ())))

    def recall(self, path: str) -> None:
        """Take requests back from a state and all below it."""
        below = path + "/"
        self.asked -= {one for one in self.asked if one == path or one.startswith(below)}

    def before_next(self, path: str, previous: str | None, child: str) -> None:
        """A machine goes on to its next state (P3, P5): what was not answered is asked again.

        The request is taken back from the state before, not from what is below it (P7).
        """
        if path not in self.asked:
            return
        if previous is not None and previous not in self.asked:
            self.asked.discard(path)
            return
        if previous is not None:
            self.asked.discard(previous)
        self.request(child)

    def after_last(self, path: str, last: str) -> None:
        """A machine has ended (P4): its request is served if its last state holds none."""
        self.running.pop(path, None)
        if last not in self.asked:
            self.asked.discard(path)

    def after_all(self, path: str, children: Collection[str]) -> None:
        """A concurrence has ended (P10): its request is served if no child still holds one.

        What the children hold is taken back, or it would stop a later visit.
        """
        self.running.pop(path, None)
        held = [child for child in children if child in self.asked]
        for child in held:
            self.recall(child)
        if not held:
            self.asked.discard(path)
