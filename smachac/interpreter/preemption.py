"""Preemption: requests to stop, and the states that have not served theirs (docs/semantics.md,
Preemption)."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass, field


@dataclass(slots=True)
class Preemption:
    """The paths of the states that have received a request to stop and have not served it.

    `running` holds the children of each running container that have not ended. `wake` holds
    functions that resume waiting branches. `on_request` is called for every request that reaches a
    state.
    """

    on_request: Callable[[str], None]
    requested: set[str] = field(default_factory=set)
    running: dict[str, list[str]] = field(default_factory=dict)
    wake: dict[str, Callable[[], None]] = field(default_factory=dict)

    def request(self, path: str) -> None:
        """Send a request to a state and to all states that run in it, outer before inner."""
        pending = [path]
        while pending:
            here = pending.pop()
            self.requested.add(here)
            self.on_request(here)
            if here in self.wake:
                self.wake[here]()
            pending.extend(reversed(self.running.get(here, ())))

    def pass_on(self, path: str, children: Iterable[str]) -> None:
        """Pass an unserved request of a container on to those of its states that have none."""
        if path in self.requested:
            for child in children:
                if child not in self.requested:
                    self.request(child)

    def recall(self, path: str) -> None:
        """Withdraw the requests of a state and of all states below it."""
        below = path + "/"
        self.requested -= {one for one in self.requested if one == path or one.startswith(below)}

    def before_next(self, path: str, previous: str | None, child: str) -> None:
        """Pass an unserved request on to the next state of a machine.

        The request of the previous state is withdrawn, but not those of states below it.
        """
        if path not in self.requested:
            return
        if previous is not None and previous not in self.requested:
            self.requested.discard(path)
            return
        if previous is not None:
            self.requested.discard(previous)
        self.request(child)

    def after_last(self, path: str, last: str) -> None:
        """End of a machine: its request counts as served if its last state has served it."""
        self.running.pop(path, None)
        if last not in self.requested:
            self.requested.discard(path)

    def after_all(self, path: str, children: Collection[str]) -> None:
        """End of a concurrence: its request counts as served if every child has served it.

        Unserved requests of the children are withdrawn; otherwise they would stop a later visit.
        """
        self.running.pop(path, None)
        held = [child for child in children if child in self.requested]
        for child in held:
            self.recall(child)
        if not held:
            self.requested.discard(path)
