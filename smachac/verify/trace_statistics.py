"""Statistics of recorded traces: visits, durations and outcomes of each state."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from math import sqrt
from typing import NamedTuple

from smachac.analysis.markov_prediction import Measured
from smachac.interpreter.result import Event
from smachac.ir.written import Round, Written
from smachac.records import dataclass, field


@dataclass(slots=True)
class StateStatistics:
    """The visits of one state in all traces: those that have ended, by outcome, their total and
    longest duration (s), and the visits that have not ended, for example by an exception."""

    outcomes: Counter[str] = field(default_factory=Counter)
    seconds: float = 0.0
    longest: float = 0.0
    unfinished: int = 0

    @property
    def ended(self) -> int:
        return self.outcomes.total()

    @property
    def visits(self) -> int:
        return self.ended + self.unfinished

    @property
    def mean(self) -> float:
        """The mean duration (s) of a visit that has ended; 0 if there is none."""
        return self.seconds / self.ended if self.ended else 0.0

    def probabilities(self) -> dict[str, float]:
        """The relative frequency of each outcome."""
        return {outcome: count / self.ended for outcome, count in self.outcomes.items()}


def wilson_interval(count: int, total: int) -> tuple[float, float]:
    """The 95 % confidence interval of a probability of which `count` of `total` were seen, for a
    total above 0 (Wilson, "Probable inference", J. Am. Stat. Assoc. 22, 1927)."""
    z = 1.959964
    share, spread = count / total, z * z / total
    middle = (share + spread / 2) / (1 + spread)
    half = z / (1 + spread) * sqrt(share * (1 - share) / total + spread / (4 * total))
    return max(0.0, middle - half), min(1.0, middle + half)


class WrittenStatistics(NamedTuple):
    """The visits of a state as it was written, and the numbers of its tries and items."""

    visits: StateStatistics
    rounds: Mapping[Round, int]


def written_statistics(
    states: Mapping[str, StateStatistics], view: Written
) -> dict[str, WrittenStatistics]:
    """The statistics of the states of a view by path, in the order of the script, from those of
    the graph by full path."""
    return {
        state.path: WrittenStatistics(
            states[state.outer_full],
            {
                part.begins: states[part.full].visits
                for part in state.parts
                if part.begins is not None and part.full in states
            },
        )
        for state in view.states.values()
        if state.outer_full in states
    }


def rounds_in_words(rounds: Mapping[Round, int]) -> str:
    """The numbers of tries and items: `303 tries`."""
    words = {"try": ("try", "tries"), "item": ("item", "items")}
    return ", ".join(f"{n} {words[what][n != 1]}" for what, n in rounds.items())


OPENING = {"start": "finish", "enter": "exit"}
"""The event that begins a visit -> the event that ends it."""


class TraceStatistics:
    """The statistics of states, by full path; the root has the runs of the whole machine."""

    def __init__(self) -> None:
        self.states: dict[str, StateStatistics] = {}
        self._begun: dict[str, float] = {}

    def record(self, event: Event) -> None:
        """Update the statistics with one event with full paths."""
        kind, path = event["event"], event["path"]
        if kind in OPENING:
            state = self.states.setdefault(path, StateStatistics())
            state.unfinished += 1
            self._begun[path] = _time(event)
        elif kind in OPENING.values() and path in self._begun:
            state = self.states[path]
            state.unfinished -= 1
            state.outcomes[event["outcome"]] += 1
            duration = max(0.0, _time(event) - self._begun.pop(path))
            state.seconds += duration
            state.longest = max(state.longest, duration)

    def end_trace(self) -> None:
        """The end of one trace: visits that have not ended stay unfinished."""
        self._begun.clear()

    def measured(self) -> dict[str, Measured]:
        """What was measured of each state that has ended, by full path."""
        return {
            path: Measured(state.ended, state.probabilities(), state.mean)
            for path, state in self.states.items()
            if state.ended
        }


def _time(event: Event) -> float:
    time = event.get("t", 0.0)
    return float(time) if isinstance(time, int | float) else 0.0
