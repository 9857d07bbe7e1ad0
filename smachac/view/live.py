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
"""The most parts of the trace that wait to be encoded. If the machine is faster, the oldest are
dropped: it never waits."""

Queued: TypeAlias = "tuple[Any, int, float, object] | Message"


class LiveTrace:
    """A sink of trace events (smachac.runtime.tracing.writer) that puts them into a feed.

    The thread of the machine copies values, cut to a limited size, and appends to a queue; all else
    is done by the thread that `start` starts, 20 times a second. `errors` are the error events.
    """

    def __init__(self, feed: Feed, most_queued: int = MOST_QUEUED) -> None:
        self._feed = feed
        self._queue: deque[Queued] = deque(maxlen=most_queued)
        self._filled = threading.Event()
        self._closing = threading.Event()
        self._lines = TraceWriter(len)
        self._next = 0
        self._thread = threading.Thread(target=self._work, name="smachac-view", daemon=True)
        self.errors = self._lines.errors

    # The machine's thread

    def prepare(self, events: Sequence[Event]) -> tuple[bytes, int]:
        """The lines of the events, as those of a trace."""
        return self._lines.prepare(events)

    def put(self, prepared: tuple[bytes, int], seq: int, t: float, value: object) -> int:
        """Queue prepared events."""
        if value is not NO_VALUE:
            value = shown_value(value)
        self._queue.append((prepared, seq, t, value))
        if not self._filled.is_set():
            self._filled.set()
        return seq + prepared[1]

    def __call__(self, event: Mapping[str, Any]) -> None:
        """Queue a complete event."""
        event = {**event, "value": shown_value(event["value"])} if "value" in event else event
        self.send({"kind": "trace", "events": [event]})

    def send(self, message: Message) -> None:
        """Queue a message, which is published after the events before it."""
        self._queue.append(message)
        if not self._filled.is_set():
            self._filled.set()

    # The other thread

    def start(self) -> None:
        """Start to publish."""
        self._thread.start()

    def close(self) -> None:
        """Publish what is queued, and end. No events may follow."""
        self._closing.set()
        self._filled.set()
        if self._thread.is_alive():
            self._thread.join()
        self.publish_queued()

    def _work(self) -> None:
        while not self._closing.is_set():
            self._filled.wait()
            self._closing.wait(PAUSE)
            self._filled.clear()
            self.publish_queued()

    def publish_queued(self) -> None:
        """Publish what is queued now, in messages of many events."""
        lines: list[bytes] = []
        for _ in range(len(self._queue)):
            item = self._queue.popleft()
            if isinstance(item, tuple):
                lines.append(self._encoded(*item))
            elif item["kind"] == "trace":
                event = item["events"][0]
                self._check_gap(event["seq"], 1)
                lines.append(json.dumps(event, default=repr).encode() + b"\n")
            else:
                self._publish(lines)
                self._feed.publish(item)
            if len(lines) >= BATCH:
                self._publish(lines)
        self._publish(lines)

    def _encoded(self, prepared: tuple[bytes, int], seq: int, t: float, value: object) -> bytes:
        template, count = prepared
        self._check_gap(seq, count)
        seconds = b"%.6f" % t
        if value is not NO_VALUE:
            return template % (seq, json.dumps(value).encode(), seconds)
        if count == 1:
            return template % (seq, seconds)
        return template % (seq, seconds, seq + 1, seconds)

    def _check_gap(self, seq: int, count: int) -> None:
        """Report the events that the queue has dropped before the number `seq`."""
        if self._next and seq > self._next:
            self._feed.publish({"kind": "dropped", "count": seq - self._next})
        self._next = seq + count

    def _publish(self, lines: list[bytes]) -> None:
        """Publish lines of JSON as one message; the list is empty afterwards."""
        if not lines:
            return
        text = b"".join(lines)
        events = text.count(b"\n")
        data = b'{"kind": "trace", "events": [' + text.rstrip(b"\n").replace(b"\n", b",") + b"]}"
        self._feed.append("trace", data, events)
        lines.clear()
