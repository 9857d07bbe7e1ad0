"""Control of a running machine: pause, step, breakpoints, forced outcomes, a request to stop."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, NamedTuple

from smachac.ir.traversal import outcome_names
from smachac.ir.written import Round, Written, WrittenState
from smachac.records import dataclass

Action = Literal["pause", "resume", "step", "break", "unbreak", "outcome", "stop"]


class ControlError(Exception):
    """An action that is not possible now; the message gives the reason."""


class Place(NamedTuple):
    """Where a run can be paused: before a state starts, or where it ends with an outcome; with a
    `round` before each of its tries or items."""

    path: str
    outcome: str | None = None
    round: Round | None = None


@dataclass(slots=True)
class Waiting:
    """A state that waits at the gate, as a whole or with one part.

    `full` is the path of the part in the graph, `place` where it waits. `outcomes` are those that
    it can be forced to. `answer` is the outcome that it is forced to; it goes on as soon as `free`
    is true.
    """

    full: str
    place: Place
    outcomes: tuple[str, ...]
    answer: str | None = None
    free: bool = False


class Control:
    """A gate (smachac.runtime.tracing.gate) that a user opens and shuts.

    `view` has the states that can wait (ir/written.py): a state with `timeout`, `retry` or
    `for_each` waits once for each of its visits, and where that is wanted before each try or item.
    A forced outcome acts on the part of the state that has it: `timeout` on its time limit,
    `exhausted` on its tries. Without a view each state of the graph waits. `on_change` is called
    after each change, with the lock held; it must not wait.
    """

    def __init__(
        self,
        view: Written | None = None,
        on_change: Callable[[Mapping[str, Any]], None] = lambda status: None,
        *,
        paused: bool = False,
    ) -> None:
        self._view = view
        self._on_change = on_change
        self._changed = threading.Condition(threading.RLock())
        self._paused = paused
        self._stopping = self._ended = False
        self._waiting: list[Waiting] = []
        self._breakpoints: dict[Place, None] = {}
        self._forced: dict[str, str] = {}
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
        with self._changed:
            if path in self._forced:
                answer = self._forced.pop(path)
                self._report()
                return answer
            state, round_ = self._state(path), self._round(path)
            if state is None or path == state.outer_full:
                place = Place(path if state is None else state.path)
                self._stop_at(place)
                if not self._paused:
                    return None
                choices = tuple(outcomes)
                if state is not None:
                    choices = tuple(dict.fromkeys([*outcomes, *state.repeated]))
                return self._wait(Waiting(path, place, choices))
            if round_ is not None and self._stop_at(place := Place(state.path, None, round_)):
                return self._wait(Waiting(path, place, tuple(outcomes)))
            return None

    def after(self, path: str, outcome: str, outcomes: Sequence[str]) -> str:
        """Wait if the outcome of the state has a breakpoint."""
        with self._changed:
            state = self._state(path)
            if state is not None and path == state.outer_full:
                for part in state.parts:
                    self._forced.pop(part.full, None)
            elif state is not None and (
                outcome in outcome_names(state.outer) or state.part_with(outcome).full != path
            ):
                return outcome  # the whole state may end with it
            place = Place(path if state is None else state.path, outcome)
            if not self._stop_at(place):
                return outcome
            return self._wait(Waiting(path, place, tuple(outcomes))) or outcome

    def _state(self, path: str) -> WrittenState | None:
        """The state of the view at a full path; None if there is none."""
        part = None if self._view is None else self._view.parts.get(path)
        return None if part is None or self._view is None else self._view.states[part.state]

    def _round(self, path: str) -> Round | None:
        part = None if self._view is None else self._view.parts.get(path)
        return None if part is None else part.begins

    def release(self) -> None:
        """The machine has a request to stop: nothing waits any more."""
        with self._changed:
            self._stopping = True
            self._go_on()

    def _stop_at(self, place: Place) -> bool:
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
        wanted = bool(self._breakpoints or self._forced)
        self.armed = self._paused or (wanted and not self._stopping)
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
                    {**waiting.place._asdict(), "outcomes": waiting.outcomes}
                    for waiting in self._waiting
                    if not waiting.free
                ],
                "breakpoints": [place._asdict() for place in self._breakpoints],
            }

    def wait_for(self, condition: Callable[[Mapping[str, Any]], bool], timeout: float) -> bool:
        """Wait until the status fulfils a condition; whether it does."""
        with self._changed:
            return self._changed.wait_for(lambda: condition(self.status()), timeout)

    def act(
        self,
        action: str,
        path: str | None = None,
        outcome: str | None = None,
        round: str | None = None,
    ) -> None:
        """Do one action. Raises ControlError.

        `step` and `outcome` are about the state that waits at `path`; without a path, about the one
        that has waited longest. `break` and `unbreak` are about the start of a state; with an
        outcome, about its end; with a `round`, about each of its tries or items.
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
                    self._breakpoints[self._known_place(path, outcome, round)] = None
                case "unbreak" if path is not None:
                    self._breakpoints.pop(Place(path, outcome, _round(round)), None)
                case "outcome" if outcome is not None:
                    self._force(self._waiting_at(path), outcome)
                case _:
                    raise ControlError(f"there is no action `{action[:40]}` with these arguments")
            self._report()

    def _known_place(self, path: str, outcome: str | None, round_: str | None) -> Place:
        if self._view is not None and path not in self._view.states:
            raise ControlError(f"there is no state `{path[:200]}`")
        return Place(path, outcome, _round(round_))

    def _waiting_at(self, path: str | None) -> Waiting:
        for waiting in self._waiting:
            if not waiting.free and path in (None, waiting.place.path):
                return waiting
        raise ControlError("no state waits" if path is None else f"`{path[:200]}` does not wait")

    def _force(self, waiting: Waiting, outcome: str) -> None:
        if outcome not in waiting.outcomes:
            raise ControlError(f"`{outcome[:80]}` is not an outcome of `{waiting.place.path}`")
        state, waiting.free = self._state(waiting.full), True
        full = waiting.full
        is_start = waiting.place.outcome is None
        if state is not None and is_start and not self._ends_loop(state, waiting, outcome):
            full = state.part_with(outcome).full
        if full == waiting.full:
            waiting.answer = outcome
        else:
            self._forced[full] = outcome

    def _ends_loop(self, state: WrittenState, waiting: Waiting, outcome: str) -> bool:
        """Whether a forced outcome ends the loop of a state, not its next item alone."""
        return waiting.full == state.outer_full and outcome in {
            name for name in state.repeated if name in outcome_names(state.outer)
        }

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


def _round(text: str | None) -> Round | None:
    match text:
        case "try" | "item":
            return text
    return None
