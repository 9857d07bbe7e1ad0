"""Control of a running machine: pause, step, breakpoints, forced outcomes, a request to stop."""

from __future__ import annotations

import threading
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any, Literal

from smachac.records import dataclass

Action = Literal["pause", "resume", "step", "break", "unbreak", "outcome", "stop"]


class ControlError(Exception):
    """An action that is not possible now; the message gives the reason."""


@dataclass(slots=True)
class Waiting:
    """A state that waits at the gate.

    `outcome` is None before its start, else the one that it has ended with. `answer` is the outcome
    that it is forced to; it goes on as soon as `free` is true.
    """

    path: str
    outcome: str | None
    outcomes: tuple[str, ...]
    answer: str | None = None
    free: bool = False


class Control:
    """A gate (smachac.runtime.tracing.gate) that a user opens and shuts.

    `paths` are the paths to show in place of those of the state graph; actions use those shown.
    `places` are the paths of all states, for breakpoints. `on_change` is called after each change,
    with the lock held; it must not wait.
    """

    def __init__(
        self,
        paths: Mapping[str, str] = {},
        on_change: Callable[[Mapping[str, Any]], None] = lambda status: None,
        *,
        paused: bool = False,
        places: Collection[str] | None = None,
    ) -> None:
        self._paths = paths
        self._places = places
        self._on_change = on_change
        self._changed = threading.Condition(threading.RLock())
        self._paused = paused
        self._stopping = self._ended = False
        self._waiting: list[Waiting] = []
        self._breakpoints: dict[tuple[str, str | None], None] = {}
        self._request_stop: Callable[[], None] | None = None
        self.armed = paused

    # The gate: called by the machine

    def opened(self, request_stop: Callable[[], None]) -> None:
        """A machine is ready to start."""
        with self._changed:
            self._request_stop = request_stop
            stopping = self._stopping
            self._report()
        if stopping:
            request_stop()

    def before(self, path: str, outcomes: Sequence[str]) -> str | None:
        """Wait if the run is paused or the state has a breakpoint."""
        shown = self._paths.get(path, path)
        with self._changed:
            self._stop_at((shown, None))
            if not self._paused:
                return None
            return self._wait(Waiting(shown, None, tuple(outcomes)))

    def after(self, path: str, outcome: str, outcomes: Sequence[str]) -> str:
        """Wait if the outcome of the state has a breakpoint."""
        shown = self._paths.get(path, path)
        with self._changed:
            if not self._stop_at((shown, outcome)):
                return outcome
            return self._wait(Waiting(shown, outcome, tuple(outcomes))) or outcome

    def release(self) -> None:
        """The machine has a request to stop: nothing waits any more."""
        with self._changed:
            self._stopping = True
            self._go_on()

    def _stop_at(self, place: tuple[str, str | None]) -> bool:
        """Whether a place is a breakpoint that counts; if so the run is paused."""
        if self._stopping or place not in self._breakpoints:
            return False
        self._paused = True
        return True

    def _wait(self, waiting: Waiting) -> str | None:
        self._waiting.append(waiting)
        self._report()
        while not waiting.free:
            self._changed.wait()
        self._waiting.remove(waiting)
        self._report()
        return waiting.answer

    def _go_on(self) -> None:
        """End the pause."""
        self._paused = False
        for waiting in self._waiting:
            waiting.free = True
        self._report()

    def _report(self) -> None:
        self.armed = self._paused or (bool(self._breakpoints) and not self._stopping)
        self._on_change(self.status())
        self._changed.notify_all()

    # The user: called by another thread

    def ended(self) -> None:
        """The run has ended."""
        with self._changed:
            self._ended = True
            self._go_on()

    def status(self) -> dict[str, Any]:
        """The message `control` of a view."""
        with self._changed:
            return {
                "kind": "control",
                "paused": self._paused,
                "stopping": self._stopping,
                "ended": self._ended,
                "at": [
                    {"path": each.path, "outcome": each.outcome, "outcomes": each.outcomes}
                    for each in self._waiting
                    if not each.free
                ],
                "breakpoints": [
                    {"path": path, "outcome": outcome} for path, outcome in self._breakpoints
                ],
            }

    def wait_for(self, condition: Callable[[Mapping[str, Any]], bool], timeout: float) -> bool:
        """Wait until the status fulfils a condition; whether it does."""
        with self._changed:
            return self._changed.wait_for(lambda: condition(self.status()), timeout)

    def act(self, action: str, path: str | None = None, outcome: str | None = None) -> None:
        """Do one action. Raises ControlError.

        `step` and `outcome` are about the state that waits at `path`; without a path, about the one
        that has waited longest. `break` and `unbreak` are about the start of a state or, with an
        outcome, about its end.
        """
        if action == "stop":
            self._stop()
            return
        with self._changed:
            if self._ended:
                raise ControlError("the run has ended")
            match action:
                case "pause":
                    self._paused = not self._stopping
                case "resume":
                    self._go_on()
                case "step":
                    self._waiting_at(path).free = True
                case "break" if path is not None:
                    if self._places is not None and path not in self._places:
                        raise ControlError(f"there is no state `{path[:200]}`")
                    self._breakpoints[path, outcome] = None
                case "unbreak" if path is not None:
                    self._breakpoints.pop((path, outcome), None)
                case "outcome" if outcome is not None:
                    self._force(self._waiting_at(path), outcome)
                case _:
                    raise ControlError(f"there is no action `{action[:40]}` with these arguments")
            self._report()

    def _waiting_at(self, path: str | None) -> Waiting:
        for waiting in self._waiting:
            if not waiting.free and path in (None, waiting.path):
                return waiting
        raise ControlError("no state waits" if path is None else f"`{path[:200]}` does not wait")

    def _force(self, waiting: Waiting, outcome: str) -> None:
        if outcome not in waiting.outcomes:
            raise ControlError(f"`{outcome[:80]}` is not an outcome of `{waiting.path}`")
        waiting.answer, waiting.free = outcome, True

    def _stop(self) -> None:
        """Send the request to stop, from this thread: a machine may pass it on at once. A machine
        that is not ready yet gets it when it is."""
        with self._changed:
            if self._ended:
                raise ControlError("the run has ended")
            request = self._request_stop
            if request is None:
                self._stopping = True
        if request is not None:
            request()
        self.release()  # after the request, which the state that waits must find
