"""Progress of a running machine as lines of text for the terminal."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from typing import Any, NamedTuple, TextIO

GOOD = frozenset({"succeeded", "success", "done", "ok", "true"})
BAD = frozenset({"aborted", "failed", "failure", "error", "timeout"})

_GREEN, _RED, _YELLOW, _DIM, _PLAIN = "\x1b[32m", "\x1b[31m", "\x1b[33m", "\x1b[2m", "\x1b[0m"

OUTCOME_COLUMN = 40
"""Column of the outcomes, counted from 0; a longer name moves its outcome to the right."""


class Repeated(NamedTuple):
    """A container that repeats one child: the path of the child, the word for a repetition,
    `attempt` or `item`, and their number, empty if it is not known."""

    child: str
    word: str
    number: str


class Sugar(NamedTuple):
    """The containers that time limits, retries and loops put around states, by path.

    `states` are the paths of the states inside, `repeated` the retries and loops, `limits` the time
    limits in words. `added` are the timers and pauses, which are not shown. `catching` are the
    states whose errors become an outcome: their lines have the message, as no report follows.
    """

    states: Mapping[str, str] = {}
    repeated: Mapping[str, Repeated] = {}
    limits: Mapping[str, str] = {}
    added: frozenset[str] = frozenset()
    catching: frozenset[str] = frozenset()


class Progress:
    """Writes a line when a state ends: name, outcome, seconds; for a container also when it starts.

    To be called with the events of a trace, in order. A container of `sugar` has lines of its own
    only for repetitions, and for an end with another outcome than that of its state. `colour` adds
    ANSI colours. Characters that the stream cannot encode become `?`. After an error of the stream
    nothing more is written.
    """

    def __init__(self, stream: TextIO, sugar: Sugar = Sugar(), *, colour: bool = False) -> None:  # noqa: B008 (constant)
        self._stream: TextIO | None = stream
        self._sugar = sugar
        self._around = {repeated.child: path for path, repeated in sugar.repeated.items()}
        self._counts: dict[str, int] = {}
        self._ends: dict[str, str] = {}
        self._colour = colour
        self._lock = threading.RLock()
        self._entered: dict[str, float] = {}
        self._shown: set[str] = set()

    def __call__(self, event: Mapping[str, Any]) -> None:
        with self._lock:
            kind, path = event["event"], event["path"]
            if path in self._sugar.added:
                return
            if kind in ("start", "enter"):
                self._show_containers(path)
                self._started(path)
                self._entered[path] = event["t"]
                self._shown.discard(path)
            elif kind in ("exit", "finish"):
                self._ended(path, event["outcome"], event["t"])
            elif kind == "error":
                message = f": {event['message']}" if path in self._sugar.catching else ""
                self._line(path, f"{self._paint(_RED, 'error')}{message}")
            elif kind == "preempt" and "/" not in path:
                self._line(path, self._paint(_YELLOW, "asked to stop"))
            elif kind == "fault":
                self._line(path, self._paint(_YELLOW, f"injected fault: {event['fault']}"))

    def _show_containers(self, path: str) -> None:
        """Write the start lines of the containers around a state, once for each of their visits."""
        parents = path.split("/")[:-1]
        for depth in range(len(parents)):
            container = "/".join(parents[: depth + 1])
            if container not in self._shown:
                self._shown.add(container)
                self._write("  " * depth + parents[depth])

    def _started(self, path: str) -> None:
        """Count the repetitions of a state, and write their lines: all items of a loop, and the
        attempts after the first."""
        self._counts.pop(path, None)
        if path in self._sugar.states:
            self._ends.pop(self._sugar.states[path], None)
        around = self._around.get(path)
        if around is None:
            return
        count = self._counts[around] = self._counts.get(around, 0) + 1
        _, word, number = self._sugar.repeated[around]
        if count > 1 or word != "attempt":
            state = self._sugar.states[around]
            of = f" of {number}" if number else ""
            self._write(f"{'  ' * state.count('/')}{state.rpartition('/')[2]}: {word} {count}{of}")

    def _ended(self, path: str, outcome: str, t: float) -> None:
        state = self._sugar.states.get(path, path)
        before = self._ends.get(state)
        self._ends[state] = outcome
        if state != path and outcome == before:
            return
        seconds = t - self._entered.get(path, t)
        colour = _GREEN if outcome in GOOD else _RED if outcome in BAD else _YELLOW
        shown = self._paint(colour, outcome) if outcome in GOOD | BAD | {"preempted"} else outcome
        limit = self._sugar.limits.get(path) if outcome == "timeout" else None
        why = f"  (time limit of {limit})" if limit else ""
        self._line(state, f"{shown}  {self._paint(_DIM, f'{seconds:.2f} s')}{why}")

    def _line(self, path: str, text: str) -> None:
        depth = path.count("/")
        name = "  " * depth + path.rpartition("/")[2]
        self._write(f"{name:<{OUTCOME_COLUMN}}  {text}")

    def _paint(self, colour: str, text: str) -> str:
        return f"{colour}{text}{_PLAIN}" if self._colour else text

    def _write(self, line: str) -> None:
        if self._stream is None:
            return
        encoding = getattr(self._stream, "encoding", None) or "utf-8"
        try:
            self._stream.write(line.encode(encoding, "replace").decode(encoding) + "\n")
            self._stream.flush()
        except (OSError, ValueError):
            self._stream = None
