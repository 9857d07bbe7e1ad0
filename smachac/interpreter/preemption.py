"""Preemption: requests to stop, and the states that have not served theirs (docs/semantics.md,
Preemption)."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable

from smachac.records import dataclass, field


@dataclass(slots=True)
class Preemption:
    """The requests to stop in one run. Every state is given by its path.

    `requested`: the states that have received a request and have not served it. `running`: for each
    running container, its children that have not ended. `wake`: for each waiting state, the
    function that resumes it. `on_request` is called for every request that reaches a state.
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
        """Pass an unserved request of a container on to those of `children` that have none."""
        if path in self.requested:
            for child in children:
                if child not in self.requested:
                    self.request(child)

    def recall(self, path: str) -> None:
        """Recall (take back) the requests of a state and of all states below it."""
        below = path + "/"
        self.requested -= {
            text for text in self.requested if text == path or text.startswith(below)
        }

    def before_state(self, path: str, previous: str | None, child: str) -> None:
        """Entry of a state of a machine: an unserved request of the machine is passed on to it.

        `previous` is the state that ran before it; if that has served its request, the request of
        the machine is served too. Otherwise the request of `previous` is recalled, but not those of
        states below it.
        """
        if path not in self.requested:
            return
        if previous is not None and previous not in self.requested:
            self.requested.discard(path)
            return
        if previous is not None:
            self.requested.discard(previous)
        self.request(child)

    def after_machine(self, path: str, last: str) -> None:
        """End of a machine: its request counts as served if its last state has none."""
        self.running.pop(path, None)
        if last not in self.requested:
            self.requested.discard(path)

    def after_concurrence(self, path: str, children: Collection[str]) -> None:
        """End of a concurrence: its request counts as served if none of its children has one.

        Unserved requests of the children are recalled: they would stop a later run of the children.
        """
        self.running.pop(path, None)
        unserved = [child for child in children if child in self.requested]
        for child in unserved:
            self.recall(child)
        if not unserved:
            self.requested.discard(path)
