"""How much of the machines in Python files is known, as text and as JSON."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from smachac.pysource.machines.coverage import Coverage, UnknownPlace
from smachac.report.json import place

MOST_SHOWN = 3
"""The most unknown places of a single file that are shown without `--notes`."""


def coverage_lines(found: Mapping[str, Coverage], *, every: bool) -> Iterator[str]:
    """The coverage of Python files by name, in lines. Of one file the first unknown places are
    shown, of several none; with `every` all, on lines of their own."""
    if not found:
        return
    states = sum(coverage.states for coverage in found.values())
    exact = sum(coverage.exact for coverage in found.values())
    places = [unknown for coverage in found.values() for unknown in coverage.unknown]
    if not states:
        what = next(iter(found)) if len(found) == 1 else f"{len(found)} Python files"
        yield f"no state machine found in {what}"
        return
    words = f"{exact} of {states} states exact"
    if len(found) > 1:
        words += f" in {len(found)} Python files"
    if states > exact:
        words += f"; {states - exact} unknown"
    if not places or every:
        yield words
        yield from (f"unknown: {_in_words(unknown)}" for unknown in places)
    elif len(found) > 1:
        yield f"{words} (--notes lists them)"
    else:
        shown = "; ".join(map(_in_words, places[:MOST_SHOWN]))
        more = len(places) - MOST_SHOWN
        yield f"{words}: {shown}" + (f"; {more} more (--notes lists them)" if more > 0 else "")


def _in_words(unknown: UnknownPlace) -> str:
    return f"{unknown.span.source.name}:{unknown.span.line}: {unknown.reason}"


def coverage_data(found: Mapping[str, Coverage]) -> list[dict[str, Any]]:
    """The coverage of Python files by name as data."""
    return [
        {
            "file": name,
            "states": coverage.states,
            "exact": coverage.exact,
            "unknown": [
                {"place": place(unknown.span), "reason": unknown.reason}
                for unknown in coverage.unknown
            ],
        }
        for name, coverage in found.items()
    ]
