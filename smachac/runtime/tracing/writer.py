"""What watches tell becomes lines of a file, or calls of an observer: in order, one at a time."""

from __future__ import annotations

import json
import re
import sys
import threading
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol

Event = dict[str, Any]
Observe = Callable[[Event], None]

NO_VALUE: object = object()
"""In place of the value of an event that is no write."""


class Sink(Protocol):
    """Takes events in two steps, so that what stays the same is made only once.

    `put` gets what `prepare` made of events, the number of the first, the seconds, and the value
    of a write (else `NO_VALUE`). It returns the number that comes next.
    """

    def prepare(self, events: Sequence[Event]) -> Any: ...
    def put(self, told: Any, seq: int, t: float, value: object) -> int: ...


class TraceWriter:
    """Writes events as lines of JSON, each at once: what has happened is in the file.

    `write` takes bytes and returns how many it took, as `os.write` with a file does.

    Attributes:
        errors: the events that told of an error.
    """

    def __init__(self, write: Callable[[bytes], int]) -> None:
        self.errors: list[Event] = []
        self._write = write
        self._lock = threading.RLock()
        self._seq = 0

    def __call__(self, event: Mapping[str, Any]) -> None:
        """Write an event that is complete, but perhaps for its number."""
        with self._lock:
            self._seq += 1
            line = json.dumps({"seq": self._seq, **event}, default=repr)
            self._append(line.encode() + b"\n")

    def prepare(self, events: Sequence[Event]) -> tuple[bytes, int]:
        """The lines of events, with holes for what is not yet known; and their count."""
        self.errors += [event for event in events if event["event"] == "error"]
        return b"".join(_line(event) for event in events), len(events)

    def put(self, told: tuple[bytes, int], seq: int, t: float, value: object) -> int:
        """Write prepared lines."""
        lines, count = told
        seconds = b"%.6f" % t
        if value is not NO_VALUE:
            data = lines % (seq, _json(value), seconds)
        elif count == 1:
            data = lines % (seq, seconds)
        else:
            data = lines % (seq, seconds, seq + 1, seconds)
        written = self._write(data)
        if written < len(data):
            self._append(data[written:])
        return seq + count

    def _append(self, data: bytes) -> None:
        """Write all of it: a pipe may take a part at a time."""
        while data:
            data = data[self._write(data) :]


class Calls:
    """Calls an observer with each event."""

    def __init__(self, observe: Observe) -> None:
        self._observe = observe

    def prepare(self, events: Sequence[Event]) -> Sequence[Event]:
        """The events as they are."""
        return events

    def put(self, told: Sequence[Event], seq: int, t: float, value: object) -> int:
        """Make the calls."""
        for number, event in enumerate(told, seq):
            complete = {**event, "seq": number, "t": round(t, 6)}
            if "value" in event:
                complete["value"] = trace_value(value)
            self._observe(complete)
        return seq + len(told)


class Recorder:
    """Numbers and times what the watches see, and passes it on."""

    def __init__(
        self, observe: Observe | TraceWriter, sources: Mapping[str, str], clock: Callable[[], float]
    ) -> None:
        self._sink: Sink | None = observe if isinstance(observe, TraceWriter) else Calls(observe)
        self._sources = sources
        self._clock = clock
        self._began = clock()
        self._seq = 1
        # A signal handler may ask for a stop, which is an event, in the middle of another one.
        self._lock = threading.RLock()
        self._telling = False
        self._late: deque[tuple[Any, object]] = deque()

    def start(self) -> None:
        """Count seconds from now."""
        self._began = self._clock()

    def prepare(self, *events: Event) -> Any:
        """What `tell` wants, for events of one moment."""
        if self._sink is None:
            return None
        return self._sink.prepare([self._framed(event) for event in events])

    def _framed(self, event: Event) -> Event:
        place = self._sources.get(event["path"])
        return {"seq": 0, **event, "t": 0.0, **({"src": place} if place else {})}

    def tell(self, told: Any, value: object = NO_VALUE) -> None:
        """Tell of prepared events, which happen now; `value` is that of a write."""
        with self._lock:
            if self._telling:
                self._late.append((told, value))
                return
            self._telling = True
            try:
                if self._sink is not None:
                    t = self._clock() - self._began
                    self._seq = self._sink.put(told, self._seq, t, value)
            except Exception as error:
                self._sink = None
                print(f"the trace stops here: {type(error).__name__}: {error}", file=sys.stderr)
            finally:
                self._telling = False
            while self._late:
                self.tell(*self._late.popleft())

    def emit(self, event: str, path: str, **more: object) -> None:
        """Tell of an event that is not worth preparing."""
        self.tell(self.prepare({"event": event, "path": path, **more}))


def _line(event: Event) -> bytes:
    """An event as a line, with holes for number, value and time."""
    holes = {"seq": "%d", "value": "%b", "t": "%b"}
    fields = []
    for name, told in event.items():
        text = holes.get(name) or json.dumps(told, default=repr).replace("%", "%%")
        fields.append(f'"{name}": {text}')
    return f"{{{', '.join(fields)}}}\n".encode()


_ENCODE = json.JSONEncoder(allow_nan=False).encode


def _json(value: object) -> bytes:
    """A value as a trace shows it, in JSON."""
    try:
        return (repr(value) if type(value) is int else _ENCODE(value)).encode()
    except (TypeError, ValueError, RecursionError):
        return json.dumps(trace_value(value)).encode()


def trace_value(value: object) -> object:
    """A value as a trace shows it: a copy of what JSON can say, else its `repr`."""
    try:
        return json.loads(json.dumps(value, allow_nan=False))
    except (TypeError, ValueError, RecursionError):
        return re.sub(r" at 0x[0-9a-fA-F]+", "", _repr(value))


def _repr(value: object) -> str:
    """The `repr` of a value, or its type: a trace must not stop a machine."""
    try:
        return repr(value)
    except Exception:
        return f"<{type(value).__name__}>"
