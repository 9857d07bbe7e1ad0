"""The messages to all readers of a view: one bounded log, in which each reader has a place."""

from __future__ import annotations

import json
import threading
from collections import deque
from collections.abc import Mapping
from typing import Any, TypeAlias

from smachac.records import dataclass

Message: TypeAlias = Mapping[str, Any]

MAX_BYTES = 64_000_000
"""The most memory of the messages that are kept; the oldest are dropped first."""

ADDED = frozenset({"trace", "dropped"})
"""The kinds of messages of which every one counts."""


@dataclass(frozen=True, slots=True)
class Entry:
    """A message as JSON.

    `size` is the number of events in it, 0 for other kinds than `trace`; `before` the number of
    events in all earlier messages.
    """

    number: int
    kind: str
    data: bytes
    size: int = 0
    before: int = 0


class Feed:
    """The messages of a view, from the first to the last.

    Publishing never waits for a reader: a reader has only a position in the log, and may be late.
    Messages of the kinds `trace` and `dropped` add up; of each other kind only the latest counts.
    So a new reader gets those, and the whole trace as far as it is kept.
    """

    def __init__(self, limit: int = MAX_BYTES) -> None:
        self._limit = limit
        self._changed = threading.Condition()
        self._entries: deque[Entry] = deque()
        self._latest: dict[str, Entry] = {}
        self._number = self._events = self._bytes = 0
        self._readers: set[Reader] = set()
        self._closed = False

    def publish(self, message: Message) -> None:
        """Append a message, which has a `kind`."""
        self.append(message["kind"], json.dumps(message).encode())

    def append(self, kind: str, data: bytes, size: int = 0) -> None:
        """Append a message that is JSON already, with `size` events."""
        with self._changed:
            self._number += 1
            entry = Entry(self._number, kind, data, size, self._events)
            self._events += size
            self._entries.append(entry)
            self._bytes += len(data)
            if kind not in ADDED:
                self._latest[kind] = entry
            while self._bytes > self._limit and len(self._entries) > 1:
                self._bytes -= len(self._entries.popleft().data)
            self._changed.notify_all()

    def open(self) -> Reader:
        """A new reader, which gets the whole log."""
        reader = Reader(self)
        with self._changed:
            self._readers.add(reader)
        return reader

    @property
    def readers(self) -> int:
        """The number of readers."""
        return len(self._readers)

    def close(self) -> None:
        """End: each reader receives what there is, and then the end."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()

    def after(self, reader: Reader, timeout: float) -> list[Entry] | None:
        """The messages that a reader has not received; see `Reader.wait`."""
        with self._changed:
            if reader.number is None:
                states = sorted(self._latest.values(), key=lambda entry: entry.number)
                found = [*states, *(entry for entry in self._entries if entry.kind in ADDED)]
            else:
                number = reader.number
                self._changed.wait_for(lambda: self._closed or self._number > number, timeout)
                found = self._newer(number)
            if not found and self._closed:
                return None
            reader.number = self._number
            return found

    def leave(self, reader: Reader) -> None:
        """Remove a reader."""
        with self._changed:
            self._readers.discard(reader)

    def _newer(self, number: int) -> list[Entry]:
        found: list[Entry] = []
        for entry in reversed(self._entries):
            if entry.number <= number:
                break
            found.append(entry)
        return found[::-1]


class Reader:
    """The place of one reader in the log of a feed.

    Attributes:
        number: the number of the last message that it has received; None at first.
    """

    def __init__(self, feed: Feed) -> None:
        self.number: int | None = None
        self._feed = feed
        self._events = 0

    def wait(self, timeout: float) -> list[bytes] | None:
        """The next messages; an empty list after `timeout` seconds, None at the end of the feed.

        A message of the kind `dropped` takes the place of events that are no longer kept.
        """
        entries = self._feed.after(self, timeout)
        if entries is None:
            return None
        messages = []
        for entry in entries:
            if entry.kind == "trace":
                if lost := entry.before - self._events:
                    messages.append(json.dumps({"kind": "dropped", "count": lost}).encode())
                self._events = entry.before + entry.size
            messages.append(entry.data)
        return messages

    def close(self) -> None:
        """Leave the feed."""
        self._feed.leave(self)
