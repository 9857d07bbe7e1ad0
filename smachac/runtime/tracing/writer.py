"""Writing a trace: numbered and timed events as lines of JSON, or as calls of an observer."""

from __future__ import annotations

import json
import re
import sys
import threading
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol, runtime_checkable

from smachac.runtime.messages import described
from smachac.runtime.tracing.values import shown_value

Event = dict[str, Any]
Observer = Callable[[Event], None]

SECRET = "(secret)"
"""What a trace shows in place of the value of a secret key."""

LONGEST_LINE = 4_000_000
"""The most characters of an event as JSON; a trace with a longer one is refused, because JSON takes
up to fifty times its size in memory."""

LONGEST_NAME = 10_000
"""The most characters of a path, an outcome or a key in an event."""

LONGEST_VALUE = LONGEST_LINE - 10 * LONGEST_NAME
"""The most characters of a value as JSON; of a longer one a trace has the form that views show."""

NO_VALUE: object = object()
"""Stands for the value in an event that is not a write."""


@runtime_checkable
class Sink(Protocol):
    """The destination of events. It takes them in two steps, as the same events recur.

    `prepare` makes the constant part of events that happen at one moment, once. `put` completes
    and delivers it each time: `seq` is the number of the first event, `t` the time (s), `value` the
    value of a write, else `NO_VALUE`. It returns the next number.
    """

    def prepare(self, events: Sequence[Event]) -> Any: ...
    def put(self, prepared: Any, seq: int, t: float, value: object) -> int: ...


@runtime_checkable
class EventQueue(Protocol):
    """A destination of events that receives them from several threads, without a lock.

    `prepare` makes the constant part of events that happen at one moment, once. `append` receives
    it each time, with the time (s) and the shown form of a written value, else `NO_VALUE`. It must
    be atomic, and raise nothing. Events have no numbers.
    """

    append: Callable[[tuple[Any, float, object]], None]

    def prepare(self, events: Sequence[Event]) -> Any: ...


class Record(Protocol):
    """Records prepared events, which happen now; `value` is that of a write."""

    def __call__(self, prepared: Any, value: object = NO_VALUE, /) -> None: ...


class TraceWriter:
    """Writes each event at once as a line of JSON, without a buffer.

    `write` takes bytes and returns how many it has written, like `os.write` of a file.

    Attributes:
        errors: the events of the kind "error".
    """

    def __init__(self, write: Callable[[bytes], int]) -> None:
        self.errors: list[Event] = []
        self._write = write
        self._lock = threading.RLock()
        self._seq = 0

    def __call__(self, event: Mapping[str, Any]) -> None:
        """Write a complete event; the number is added if it is missing."""
        with self._lock:
            self._seq += 1
            line = json.dumps({"seq": self._seq, **event}, default=repr)
            self._append(line.encode() + b"\n")

    def prepare(self, events: Sequence[Event]) -> tuple[bytes, int]:
        """The lines of the events, a template for numbers, values and times, and their count."""
        self.errors += [event for event in events if event["event"] == "error"]
        return b"".join(_line(event) for event in events), len(events)

    def put(self, prepared: tuple[bytes, int], seq: int, t: float, value: object) -> int:
        """Fill in prepared lines and write them."""
        lines, count = prepared
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
        """Write all of `data`: a pipe may accept a part at a time."""
        while data:
            data = data[self._write(data) :]


class ObserverSink:
    """Calls an observer with each complete event."""

    def __init__(self, observe: Observer) -> None:
        self._observe = observe

    def prepare(self, events: Sequence[Event]) -> Sequence[Event]:
        """The events as they are."""
        return events

    def put(self, prepared: Sequence[Event], seq: int, t: float, value: object) -> int:
        """Call the observer with each event."""
        for number, event in enumerate(prepared, seq):
            complete = {**event, "seq": number, "t": round(t, 6)}
            if "value" in event:
                complete["value"] = trace_value(value)
            self._observe(complete)
        return seq + len(prepared)


class Recorder:
    """Numbers and times the events of all instrumented states, and passes them to a sink.

    Events of several threads are recorded one at a time. After an error of the sink, which is
    printed to stderr, no more events are recorded. A queue receives them without a lock.
    """

    def __init__(
        self,
        observe: Observer | Sink | EventQueue,
        sources: Mapping[str, str],
        clock: Callable[[], float],
        paths: Mapping[str, str] = {},
    ) -> None:
        self._queue = observe if isinstance(observe, EventQueue) else None
        self._sink: Sink | None = None
        if not isinstance(observe, EventQueue):
            self._sink = observe if isinstance(observe, Sink) else ObserverSink(observe)
        self._sources = sources
        self._paths = paths
        self._clock = clock
        self._began = clock()
        self._seq = 1
        # A signal handler may request a stop, which is an event, while another one is recorded.
        self._lock = threading.RLock()
        self._recording = False
        self._deferred: deque[tuple[Any, object]] = deque()
        self.record: Record = self._record
        if self._queue is not None:
            self.record = self._to_queue(self._queue)

    def start(self) -> None:
        """Set the zero of the times to now."""
        self._began = self._clock()

    def prepare(self, *events: Event) -> Any:
        """The argument of `record` for events that happen at one moment."""
        destination = self._queue or self._sink
        if destination is None:
            return None
        return destination.prepare([self._with_frame(event) for event in events])

    def _with_frame(self, event: Event) -> Event:
        place = self._sources.get(event["path"])
        shown = with_shown_paths(event, self._paths)
        return {"seq": 0, **shown, "t": 0.0, **({"src": place} if place else {})}

    def _to_queue(self, queue: EventQueue) -> Record:
        """The function that appends events to a queue: it costs the machine least."""
        append, clock = queue.append, self._clock

        def record(prepared: Any, value: object = NO_VALUE, /) -> None:
            if value is not NO_VALUE:
                value = shown_value(value)
            append((prepared, clock() - self._began, value))

        return record

    def _record(self, prepared: Any, value: object = NO_VALUE, /) -> None:
        with self._lock:
            if self._recording:
                self._deferred.append((prepared, value))
                return
            self._recording = True
            try:
                if self._sink is not None:
                    t = self._clock() - self._began
                    self._seq = self._sink.put(prepared, self._seq, t, value)
            except Exception as error:
                self._sink = None
                print(f"the trace stops here: {described(error)}", file=sys.stderr)
            finally:
                self._recording = False
            while self._deferred:
                self._record(*self._deferred.popleft())

    def emit(self, event: str, path: str, **more: object) -> None:
        """Record an event that occurs too rarely to be prepared once."""
        self.record(self.prepare({"event": event, "path": path, **more}))


def with_shown_paths(event: Mapping[str, Any], paths: Mapping[str, str]) -> Event:
    """An event with other paths, `paths` by the path of a state; the same event if it has none."""
    if not paths:
        return dict(event)
    shown = {**event, "path": paths.get(event["path"], event["path"])}
    if "to" in event:
        shown["to"] = shown_path(event["to"], paths)
    return shown


def shown_path(path: str, paths: Mapping[str, str]) -> str:
    """The path that takes the place of a path or of `path:outcome`, the end of a container."""
    if not paths or path in paths:
        return paths.get(path, path)
    at = path.find(":")
    while at >= 0:
        if path[:at] in paths:
            return paths[path[:at]] + path[at:]
        at = path.find(":", at + 1)
    return path


def _line(event: Event) -> bytes:
    """An event as a line of JSON: a bytes template for its number, value and time."""
    placeholders = {"seq": "%d", "value": "%b", "t": "%b"}
    fields = []
    for name, content in event.items():
        text = placeholders.get(name) or json.dumps(content, default=repr).replace("%", "%%")
        fields.append(f'"{name}": {text}')
    return f"{{{', '.join(fields)}}}\n".encode()


_ENCODE = json.JSONEncoder(allow_nan=False).encode


def _json(value: object) -> bytes:
    """The JSON of `trace_value(value)`, or of the form that views show if it is too long."""
    try:
        text = repr(value) if type(value) is int else _ENCODE(value)
    except (TypeError, ValueError, RecursionError):
        text = json.dumps(trace_value(value))
    return (text if len(text) <= LONGEST_VALUE else _ENCODE(shown_value(value))).encode()


def trace_value(value: object) -> object:
    """The form of a value in a trace: a copy through JSON, else its `repr` without addresses."""
    try:
        return json.loads(json.dumps(value, allow_nan=False))
    except (TypeError, ValueError, RecursionError):
        return re.sub(r" at 0x[0-9a-fA-F]+", "", _repr(value))


def _repr(value: object) -> str:
    """The `repr` of a value, or its type if that raises: a trace must not stop a machine."""
    try:
        return repr(value)
    except Exception:
        return f"<{type(value).__name__}>"
