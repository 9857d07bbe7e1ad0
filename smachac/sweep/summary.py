"""The summary of a sweep as plain data: shares, intervals, failures by cause, coverage, times."""

from __future__ import annotations

import shlex
from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from smachac.ir.nodes import Leaf, Machine
from smachac.ir.traversal import outcome_names
from smachac.ir.written import Written, WrittenState, written
from smachac.sweep.failures import Failures, Group
from smachac.sweep.task import Run, merge_states
from smachac.sweep.variation import Single, value_text
from smachac.verify.coverage import CoverageItem, coverage_items, script_coverage
from smachac.verify.result import place
from smachac.verify.trace_statistics import (
    TraceStatistics,
    WrittenStatistics,
    wilson_interval,
    written_statistics,
)

PARTS = 10
"""The parts into which the range of a varied number is divided."""

Summary = dict[str, Any]


class Difference(NamedTuple):
    """The share of runs with a property before and after, and the difference with its interval.
    `what` is empty for the successes, else what failed first."""

    what: str
    before: float
    after: float
    difference: float
    interval: tuple[float, float]

    @property
    def is_clear(self) -> bool:
        """Whether the interval does not contain 0."""
        low, high = self.interval
        return low > 0 or high < 0


class Totals:
    """The totals of the runs of a machine, which are added one by one; the runs themselves are not
    kept. If no outcome is known as a success, each run with an outcome is good."""

    def __init__(self, machine: Machine, successes: Collection[str]) -> None:
        self.successes = successes
        self.failures = Failures(machine, successes)
        self.runs = 0
        self.outcomes: Counter[str | None] = Counter()
        self.statistics = TraceStatistics()
        self.covered: set[CoverageItem] = set()
        self.faults: Counter[str] = Counter()
        self.seconds: list[float] = []
        self.values: dict[str, list[tuple[Single, bool]]] = {}

    def add(self, run: Run) -> None:
        """Add a run, in the order of seeds."""
        self.runs += 1
        self.outcomes[run.outcome] += 1
        merge_states(self.statistics, run.states)
        self.covered.update(run.covered)
        self.faults.update(run.faults)
        if run.outcome is not None:
            self.seconds.append(run.seconds)
        good = self.is_good(run)
        for name, value in run.values.items():
            self.values.setdefault(name, []).append((value, good))
        if not good:
            self.failures.add(run)

    def is_good(self, run: Run) -> bool:
        """Whether a run is no failure."""
        return run.outcome in self.successes if self.successes else run.outcome is not None

    @property
    def succeeded(self) -> int:
        return sum(self.outcomes[name] for name in self.successes)


def summarize(
    machine: Machine, totals: Totals, *, planned: int, first: int, command: Sequence[str]
) -> Summary:
    """The summary as data for JSON. `planned` runs were to be done, with seeds from `first` on;
    `command` are the words that run the script once, without seed and varied values."""
    view = written(machine)
    runs = totals.runs
    names = dict.fromkeys([*outcome_names(machine.root), *filter(None, totals.outcomes)])
    return {
        "machine": machine.root.name,
        "script": machine.source,
        "first_seed": first,
        "planned": planned,
        "runs": runs,
        "success": {"outcomes": sorted(totals.successes), **_share(totals.succeeded, runs)},
        "outcomes": [
            {"outcome": name, **_share(totals.outcomes[name], runs)}
            for name in [*names, *([None] if totals.outcomes[None] else [])]
        ],
        "seconds": _times(totals.seconds),
        "coverage": _coverage(machine, totals, view),
        "states": [
            _state(view.states[path], visits)
            for path, visits in written_statistics(totals.statistics.states, view).items()
        ],
        "failures": [_failure(group, runs, command) for group in totals.failures.groups()],
        "faults": dict(sorted(totals.faults.items())),
        "varied": [_varied(name, values) for name, values in totals.values.items()],
    }


def _share(count: int, total: int) -> dict[str, Any]:
    if not total:
        return {"count": count, "share": None, "interval": None}
    return {
        "count": count,
        "share": count / total,
        "interval": list(wilson_interval(count, total)),
    }


def _times(seconds: Sequence[float]) -> dict[str, Any]:
    """Mean, middle and longest duration, and a histogram."""
    if not seconds:
        return {"mean": None, "median": None, "longest": None, "histogram": []}
    ordered = sorted(seconds)
    return {
        "mean": sum(ordered) / len(ordered),
        "median": ordered[len(ordered) // 2],
        "longest": ordered[-1],
        "histogram": [
            {"low": low, "high": high, "count": len(inside)}
            for low, high, inside in _parts([(number, number) for number in ordered], 2 * PARTS)
        ],
    }


def _parts(values: Sequence[tuple[float, Any]], count: int) -> list[tuple[float, float, list[Any]]]:
    """Values in equal parts of their range: the ends of each part, and what belongs to it."""
    low, high = min(value for value, _ in values), max(value for value, _ in values)
    count = count if high > low else 1
    inside: list[list[Any]] = [[] for _ in range(count)]
    for value, what in values:
        at = int((value - low) / (high - low) * count) if high > low else 0
        inside[min(at, count - 1)].append(what)
    ends = [low + (high - low) * number / count for number in range(count + 1)]
    return [(ends[k], ends[k + 1], row) for k, row in enumerate(inside)]


def _coverage(machine: Machine, totals: Totals, view: Written) -> dict[str, Any]:
    covered = script_coverage(coverage_items(machine), totals.covered, view)
    missing = covered.missing()
    unvisited = [
        path
        for path, state in view.states.items()
        if state.outer_full not in totals.statistics.states
    ]
    return {
        "states": {
            "visited": len(view.states) - len(unvisited),
            "total": len(view.states),
            "missing": unvisited,
        },
        "transitions": {
            "taken": len(covered.items) - len(missing),
            "total": len(covered.items),
            "missing": [
                {
                    "path": item.path,
                    "outcome": item.outcome,
                    "to": item.target,
                    "src": place(covered.items[item]),
                }
                for item in missing
            ],
        },
    }


def _state(state: WrittenState, found: WrittenStatistics) -> dict[str, Any]:
    visits = found.visits
    return {
        "path": state.path,
        "leaf": isinstance(state.node, Leaf),
        "visits": visits.visits,
        "unfinished": visits.unfinished,
        "mean": visits.mean,
        "longest": visits.longest,
        "seconds": visits.seconds,
        "outcomes": dict(sorted(visits.outcomes.items(), key=lambda pair: (-pair[1], pair[0]))),
        "rounds": dict(found.rounds),
    }


def _failure(group: Group, runs: int, command: Sequence[str]) -> dict[str, Any]:
    """A group of failures: `first` and `turning` are numbers of steps, from 0."""
    seed, values = group.runs[0]
    return {
        **_share(len(group.runs), runs),
        "outcome": group.outcome,
        "error": group.error,
        "steps": [step._asdict() for step in group.steps],
        "first": group.first,
        "turning": group.turning,
        "left_out": group.left_out,
        "seeds": [seed for seed, _ in group.runs],
        "replay": replay(command, seed, values),
    }


def replay(command: Sequence[str], seed: int, values: Mapping[str, Single]) -> str:
    """The command line that repeats a run."""
    words = [*command, "--seed", str(seed)]
    for name, value in values.items():
        words += ["--set", f"{name}={value_text(value)}"]
    return shlex.join(words)


def _varied(name: str, values: Sequence[tuple[Single, bool]]) -> dict[str, Any]:
    """The successes by value, or by part of the range of a number."""
    kinds = {value for value, _ in values}
    numbers = [(float(v), good) for v, good in values if not isinstance(v, bool | str)]
    if len(numbers) == len(values) and len(kinds) > PARTS:
        rows = [
            {"low": low, "high": high, **_share(sum(goods), len(goods)), "runs": len(goods)}
            for low, high, goods in _parts(numbers, PARTS)
        ]
    else:
        by_value = _by_value(values)
        rows = [
            {"value": value, **_share(sum(goods), len(goods)), "runs": len(goods)}
            for value, goods in sorted(
                by_value.items(), key=lambda pair: (str(type(pair[0])), pair[0])
            )
        ]
    return {"name": name, "parts": rows}


def _by_value(values: Iterable[tuple[Single, bool]]) -> dict[Any, list[bool]]:
    found: dict[Any, list[bool]] = {}
    for value, good in values:
        found.setdefault(value, []).append(good)
    return found


def progress_line(done: int, planned: int, at_start: int, seconds: float) -> str:
    """A line with a bar, the runs that are done, and the time left. `at_start` of them were done
    before; the others took `seconds`."""
    width = 24
    filled = width * done // planned
    bar = (
        f"[{'#' * filled}{'.' * (width - filled)}] {done} of {planned} ({100 * done // planned} %)"
    )
    fresh = done - at_start
    if not fresh or done == planned:
        return bar
    return f"{bar}, {clock_time(seconds / fresh * (planned - done))} left"


def clock_time(seconds: float) -> str:
    """A time as minutes and seconds, or hours and minutes."""
    whole = round(seconds)
    if whole >= 3600:
        return f"{whole // 3600} h {whole % 3600 // 60:02d} min"
    return f"{whole // 60}:{whole % 60:02d} min"
