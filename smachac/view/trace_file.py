"""A trace that is read from a file, also while it grows, as messages of a view."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from smachac.runtime.tracing.writer import LONGEST_LINE
from smachac.targets.html.trace import read_event
from smachac.view.feed import Feed
from smachac.view.live import BATCH


class TraceText:
    """Publishes the events in the bytes of a trace, which come in pieces of any size.

    A line that is no event is counted in `wrong` and left out. `places` are the states that ran, as
    the keys of a dict.
    """

    def __init__(self, feed: Feed) -> None:
        self._feed = feed
        self._rest = b""
        self.wrong = 0
        self.places: dict[str, None] = {}

    def add(self, data: bytes) -> None:
        """Publish the events of the lines that are complete."""
        *lines, rest = (self._rest + data).split(b"\n")
        self._rest = rest[: LONGEST_LINE + 1]  # of a longer line, which is no event
        events: list[Any] = []
        for line in lines:
            if not line.strip():
                continue
            event = read_event(line)
            if event is None:
                self.wrong += 1
                continue
            events.append(event)
            if event["event"] in ("start", "enter"):
                self.places[event["path"]] = None
        publish(self._feed, events)

    def restart(self) -> None:
        """The file begins anew."""
        self._rest = b""
        self.places.clear()


def publish(feed: Feed, events: Sequence[Any]) -> None:
    """Publish events in messages of limited size."""
    for start in range(0, len(events), BATCH):
        part = events[start : start + BATCH]
        data = json.dumps({"kind": "trace", "events": part}).encode()
        feed.append("trace", data, len(part))
