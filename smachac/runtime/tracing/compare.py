"""Comparison of two traces, without times and the order between branches of a concurrence."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

Event = Mapping[str, Any]

COMPARED = ("event", "path", "outcome", "to", "key", "value")
"""The compared fields of an event. Messages of errors differ between the programs compared."""


class Difference(NamedTuple):
    """Two traces in comparable order, and the index of the first event that differs."""

    first: list[Event]
    second: list[Event]
    at: int


def difference(first: Iterable[Event], second: Iterable[Event]) -> Difference | None:
    """The first difference between two traces, or None.

    Times, places in the script, numbers of events, messages, and the order between the branches of
    a concurrence are not compared.
    """
    one, other = list(first), list(second)
    concurrences = _concurrences(one) | _concurrences(other)
    ours, theirs = _in_order(one, concurrences), _in_order(other, concurrences)
    for at, (mine, yours) in enumerate(zip(ours, theirs, strict=False)):
        if core(mine) != core(yours):
            return Difference(ours, theirs, at)
    if len(ours) == len(theirs):
        return None
    return Difference(ours, theirs, min(len(ours), len(theirs)))


def compare(first: Iterable[Event], second: Iterable[Event]) -> str | None:
    """The first difference between two traces (see `difference`) as text, or None."""
    found = difference(first, second)
    if found is None:
        return None
    ours, theirs, at = found
    if at < min(len(ours), len(theirs)):
        return f"event {at + 1}: {_words(ours[at])}, but then {_words(theirs[at])}"
    longer, which = (ours, "first") if at < len(ours) else (theirs, "second")
    return f"event {at + 1}: only the {which} trace has {_words(longer[at])}"


def core(event: Event) -> dict[str, Any]:
    """The compared fields of an event."""
    return {name: event[name] for name in COMPARED if name in event}


def _words(event: Event) -> str:
    return "`" + " ".join(str(value) for value in core(event).values()) + "`"


def _concurrences(events: Sequence[Event]) -> set[str]:
    """The paths of concurrences: containers whose children overlap, or end without a transition."""
    found: set[str] = set()
    running: dict[str, set[str]] = {}
    left: set[str] = set()
    for event in events:
        path = event["path"]
        parent = path.rpartition("/")[0]
        if event["event"] == "enter":
            if running.setdefault(parent, set()) or parent in left:
                found.add(parent)
            running[parent].add(path)
        elif event["event"] == "exit":
            running.setdefault(parent, set()).discard(path)
            failed = [path]  # states in which an exception was raised have no exit of their own
            while failed:
                failed += running.pop(failed.pop(), ())
            left.add(parent)
        elif event["event"] == "transition":
            left.discard(parent)
    return found | left


OPENING = ("start", "enter")
CLOSING = ("finish", "exit")
"""The events that begin and end a state."""


def _ends(event: Event, path: str) -> bool:
    """Whether an event is the end of a state, or of a container around it: a state in which an
    exception is raised has no event at its end, if a container around it catches the exception."""
    return event["event"] in CLOSING and f"{path}/".startswith(f"{event['path']}/")


def _in_order(events: Sequence[Event], concurrences: set[str]) -> list[Event]:
    """The events, those inside a concurrence sorted by branch and in their own order there."""
    ordered: list[Event] = []
    at = 0
    while at < len(events):
        event = events[at]
        ordered.append(event)
        at += 1
        path = event["path"]
        if event["event"] not in OPENING or path not in concurrences:
            continue
        end = at
        while end < len(events) and not _ends(events[end], path):
            end += 1
        branches: dict[str, list[Event]] = {}
        for inner in events[at:end]:
            below = inner["path"].removeprefix(f"{path}/")
            if below == inner["path"]:
                ordered.append(inner)
            else:
                branches.setdefault(below.partition("/")[0], []).append(inner)
        for name in sorted(branches):
            ordered.extend(_in_order(branches[name], concurrences))
        at = end
    return ordered
