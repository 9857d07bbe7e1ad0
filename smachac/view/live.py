"""The trace of a running machine as messages: queued by the machine, encoded by another thread."""

from __future__ import annotations

import json
import threading
from collections import deque
from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

from smachac.runtime.tracing.values import shown_value
from smachac.runtime.tracing.writer import NO_VALUE, Event, TraceWriter
from smachac.view.feed import Feed, Message

PAUSE = 0.05
"""Seconds between two batches."""

BATCH = 5_000
"""The most events in one message."""

MOST_QUEUED = 200_000
"""The most parts of the trace that wait to be encoded, a few more for a moment. If the machine is
faster, the oldest are dropped: it never waits."""

Prepared: TypeAlias = "tuple[bytes, int]"
"""Lines of a trace, a template, and their number."""

Queued: TypeAlias = "tuple[Prepared, float, object] | Message"


class LiveTrace:
    """A queue of trace events (smachac.runtime.tracing.writer) that are put into a feed.

    The thread of the machine copies values, cut to a limited size, and appends; all else is done by
    the thread that `start` starts, 20 times a second. `errors` are the error events.
    """

    def __init__(self, feed: Feed, most_queued: int = MOST_QUEUED) -> None:
        self._feed = feed
        self._most_queued = most_queued
        self._queue: deque[Queued] = deque()
        self.append = self._queue.append
        self._closing = threading.Event()
        self._lines = TraceWriter(len)
        self._next = 1
        self._thread = threading.Thread(target=self._work, name="smachac-view", daemon=True)
        self.errors = self._lines.errors

    # The machine's thread

    def prepare(self, events: Sequence[Event]) -> Prepared:
        """The lines of the events, as those of a trace."""
        return self._lines.prepare(events)

    def __call__(self, event: Mapping[str, Any]) -> None:
        """Queue a complete event."""
        event = {**event, "value": shown_value(event["value"])} if "value" in event else event
        self.append({"kind": "trace", "events": [event]})

    def send(self, message: Message) -> None:
        """Queue a message, which is published after the events before it."""
        self.append(message)

    # The other thread

    def start(self) -> None:
        """Start to publish."""
        self._thread.start()

    def close(self) -> None:
        """Publish what is queued, and end. No events may follow."""
        self._closing.set()
        if self._thread.is_alive():
            self._thread.join()
        self.publish_queued()

    def _work(self) -> None:
        while not self._closing.wait(PAUSE):
            self.publish_queued()

    def publish_queued(self) -> None:
        """Publish what is queued now, in messages of many events."""
        lines: list[bytes] = []
        self._drop_oldest()
        left = len(self._queue)
        while left and self._queue:
            left -= 1
            item = self._queue.popleft()
            if isinstance(item, tuple):
                lines.append(self._encoded(*item))
            elif item["kind"] == "trace":
                event = item["events"][0]
                self._next = event["seq"] + 1
                lines.append(json.dumps(event, default=repr).encode() + b"\n")
            else:
                self._publish(lines)
                self._feed.publish(item)
            if len(lines) >= BATCH:
                self._publish(lines)
                self._drop_oldest()
        self._publish(lines)

    def _drop_oldest(self) -> None:
        """Drop events if more are queued than may be, and report their number."""
        dropped = 0
        for _ in range(len(self._queue) - self._most_queued):
            item = self._queue.popleft()
            if isinstance(item, tuple):
                dropped += item[0][1]
            elif item["kind"] == "trace":
                dropped += 1
            else:
                self._feed.publish(item)
        if dropped:
            self._next += dropped
            self._feed.publish({"kind": "dropped", "count": dropped})

    def _encoded(self, prepared: Prepared, t: float, value: object) -> bytes:
        template, count = prepared
        number, seconds = self._next, b"%.6f" % t
        self._next += count
        if value is not NO_VALUE:
            return template % (number, json.dumps(value).encode(), seconds)
        if count == 1:
            return template % (number, seconds)
        return template % (number, seconds, number + 1, seconds)

    def _publish(self, lines: list[bytes]) -> None:
        """Publish lines of JSON as one message; the list is empty afterwards."""
        if not lines:
            return
        text = b"".join(lines)
        events = text.count(b"\n")
        data = b'{"kind": "trace", "events": [' + text.rstrip(b"\n").replace(b"\n", b",") + b"]}"
        self._feed.append("trace", data, events)
        lines.clear()
