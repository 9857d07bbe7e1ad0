"""Two sweeps, before and after a change: the differences of shares, with their intervals."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from math import sqrt
from typing import Any

from smachac.sweep.summary import Difference, Summary
from smachac.sweep.text import EXCEPTION, end_text
from smachac.verify.trace_statistics import wilson_interval


class BaselineError(Exception):
    """A file is no report of a sweep; the message gives the reason."""


def read_baseline(text: str) -> Summary:
    """The summary in a report of `sweep --format json`. Raises BaselineError."""
    try:
        data = json.loads(text)
    except (ValueError, RecursionError):
        raise BaselineError("it is no JSON; `sweep --format json` writes it") from None
    if not isinstance(data, dict) or not {"machine", "runs", "success", "failures"} <= data.keys():
        raise BaselineError("it is no report of `sweep --format json`")
    try:
        _counts(data)
        int(data["success"]["count"])
    except (KeyError, TypeError, ValueError, AttributeError, IndexError):
        raise BaselineError("it is the report of another version of smachac") from None
    if not data["runs"]:
        raise BaselineError("it has no runs")
    return data


def compare(before: Summary, after: Summary) -> list[Difference]:
    """The difference of the successes, then those of the failures, the largest first."""
    return [
        _difference("", before, before["success"]["count"], after, after["success"]["count"]),
        *sorted(_failures(before, after), key=lambda failure: -abs(failure.difference)),
    ]


def _failures(before: Summary, after: Summary) -> Iterator[Difference]:
    old, new = _counts(before), _counts(after)
    for what in dict.fromkeys([*new, *old]):
        yield _difference(what, before, old.get(what, 0), after, new.get(what, 0))


def _counts(summary: Mapping[str, Any]) -> dict[str, int]:
    """The numbers of failed runs by what failed first."""
    found: dict[str, int] = {}
    for group in summary["failures"]:
        step = group["steps"][group["first"]] if group["steps"] else None
        what = f"{step['path']}: {step['outcome'] or EXCEPTION}" if step else end_text(group)
        found[what] = found.get(what, 0) + int(group["count"])
    return found


def _difference(what: str, before: Summary, old: int, after: Summary, new: int) -> Difference:
    interval = difference_interval(new, after["runs"], old, before["runs"])
    one, other = old / before["runs"], new / after["runs"]
    return Difference(what, one, other, other - one, interval)


def difference_interval(
    count: int, total: int, other_count: int, other_total: int
) -> tuple[float, float]:
    """The 95 % confidence interval of the difference of two probabilities, `count` of `total` minus
    `other_count` of `other_total` (Newcombe, "Interval estimation for the difference between
    independent proportions", Stat. Med. 17, 1998, method 10)."""
    share, other = count / total, other_count / other_total
    low, high = wilson_interval(count, total)
    other_low, other_high = wilson_interval(other_count, other_total)
    difference = share - other
    return (
        difference - sqrt((share - low) ** 2 + (other_high - other) ** 2),
        difference + sqrt((high - share) ** 2 + (other - other_low) ** 2),
    )
