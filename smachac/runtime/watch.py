"""A watch in front of each state of a machine built with SMACH: it tells what the state does."""

from __future__ import annotations

import json
import re
import sys
import threading
from collections.abc import Callable, Mapping
from typing import Any

Event = dict[str, Any]
Observe = Callable[[Event], None]


class Recorder:
    """Makes events of what the watches see, one at a time."""

    def __init__(
        self, observe: Observe, sources: Mapping[str, str], clock: Callable[[], float]
    ) -> None:
        self._observe: Observe | None = observe
        self._sources = sources
        self._clock = clock
        self._began = clock()
        self._seq = 0
        # A signal handler may ask for a stop, which is an event, in the middle of another one.
        self._lock = threading.RLock()

    def start(self) -> None:
        """Count seconds from now."""
        self._began = self._clock()

    def emit(self, event: str, path: str, **more: object) -> None:
        """Tell the observer of an event."""
        with self._lock:
            if self._observe is None:
                return
            self._seq += 1
            t = round(self._clock() - self._began, 6)
            line: Event = {"seq": self._seq, "event": event, "path": path, **more, "t": t}
            if source := self._sources.get(path):
                line["src"] = source
            try:
                self._observe(line)
            except Exception as error:
                self._observe = None
                print(f"the trace stops here: {type(error).__name__}: {error}", file=sys.stderr)


class Watch:
    """Stands in front of `execute` and `request_preempt` of one state.

    Attributes:
        places: the containers that hold it, each with its label there.
        path: where it ran last.
        failed: a state inside has told of its error in this run.
    """

    def __init__(self, state: Any, recorder: Recorder) -> None:
        self.state = state
        self.recorder = recorder
        self.places: list[tuple[Watch | None, str]] = []
        self.path = ""
        self.failed = False
        self._exits: dict[tuple[str, str], str | None] | None = None
        self._ended: tuple[str, str] | None = None
        self._execute = state.execute
        self._request_preempt = state.request_preempt
        state.execute = self._watched_execute
        state.request_preempt = self._watched_request

    def _watched_execute(self, *arguments: Any, **named: Any) -> Any:
        parent, label = self._place()
        path = self.path = self._path(parent, label)
        emit = self.recorder.emit
        self.failed, self._exits, self._ended = False, None, None
        if parent is None:
            self.recorder.start()
            emit("start", path)
        else:
            parent.entering()
            emit("enter", path)
        if not is_container(self.state) and arguments:
            arguments = (self._watched_userdata(parent, arguments[0]), *arguments[1:])
        try:
            outcome = self._execute(*arguments, **named)
        except BaseException as error:
            self._fail(parent, _message(error))
            raise
        if outcome is None:
            self._fail(parent, "ended without an outcome")
            return outcome
        self._leaving(outcome)
        if parent is None:
            emit("finish", path, outcome=outcome)
        else:
            emit("exit", path, outcome=outcome)
            parent.child_ended(self, label, outcome)
        return outcome

    def _watched_request(self) -> None:
        self.recorder.emit("preempt", self._path(*self._place()))
        self._request_preempt()

    def _watched_userdata(self, parent: Watch | None, userdata: Any) -> Any:
        """The leaf's userdata, with every write that counts told."""
        keys = self.state.get_registered_output_keys()
        loose = parent is None or _is_a(parent.state, "Iterator")
        path = self.path

        def written(key: str, value: object) -> None:
            if loose or key in keys:
                self.recorder.emit("write", path, key=key, value=trace_value(value))

        return _Written(userdata, written)

    def _place(self) -> tuple[Watch | None, str]:
        """The container that runs it now; one state may stand in several places."""
        if len(self.places) > 1:
            for parent, label in self.places:
                if parent is None or label in parent.state.get_active_states():
                    return parent, label
        return self.places[0]

    def _path(self, parent: Watch | None, label: str) -> str:
        """The path, by where the containers around it ran last."""
        labels = [label]
        while parent is not None and not parent.path:
            parent, label = parent.places[0]
            labels.append(label)
        if parent is not None:
            labels.append(parent.path)
        return "/".join(reversed(labels))

    def _fail(self, parent: Watch | None, message: str) -> None:
        """Tell of an error, unless a state inside has done so."""
        if not self.failed:
            self.recorder.emit("error", self.path, message=message)
        if parent is not None:
            parent.failed = True

    def entering(self) -> None:
        """A child is about to start: in an iterator, the one before has looped."""
        if self._ended is not None:
            path, outcome = self._ended
            self.recorder.emit("transition", path, outcome=outcome, to=path)
            self._ended = None

    def child_ended(self, child: Watch, label: str, outcome: str) -> None:
        """A child has ended: tell where that leads."""
        if _is_a(self.state, "Iterator"):
            self._ended = (child.path, outcome)
            return
        if _is_a(self.state, "Concurrence"):
            return
        if outcome not in child.state.get_registered_outcomes():
            message = f"ended with `{outcome}`, which is not one of its outcomes"
            child._fail(self, message)
            return
        if self._exits is None:
            edges = self.state.get_internal_edges()
            self._exits = {(edge[1], edge[0]): edge[2] for edge in edges}
        target = self._exits.get((label, outcome))
        inside = bool(target) and target in self.state.get_children()
        to = f"{self.path}/{target}" if inside else f"{self.path}:{target or outcome}"
        self.recorder.emit("transition", child.path, outcome=outcome, to=to)

    def _leaving(self, outcome: str) -> None:
        """In an iterator, its child's last outcome has led to its end."""
        if self._ended is not None:
            path, ended = self._ended
            self.recorder.emit("transition", path, outcome=ended, to=f"{self.path}:{outcome}")


class _Written:
    """A leaf's userdata that tells of writes; all else goes through."""

    __iter__ = None  # as SMACH's userdata, this cannot be gone through

    def __init__(self, userdata: Any, written: Callable[[str, object], None]) -> None:
        object.__setattr__(self, "_userdata", userdata)
        object.__setattr__(self, "_written", written)

    def __getattr__(self, name: str) -> Any:
        if name == "_userdata":  # of a copy that is being made
            raise AttributeError(name)
        return getattr(self._userdata, name)

    def __getitem__(self, key: str) -> Any:
        return self._userdata[key]

    def __contains__(self, key: object) -> bool:
        return key in self._userdata

    def __setattr__(self, name: str, value: object) -> None:
        setattr(self._userdata, name, value)
        if not name.startswith("_"):
            self._written(name, value)

    def __setitem__(self, key: str, value: object) -> None:
        self._userdata[key] = value
        self._written(key, value)

    def update(self, userdata: Any) -> None:
        self._userdata.update(userdata)
        for key in userdata.keys():  # noqa: SIM118 (SMACH's userdata cannot be iterated)
            self._written(key, userdata[key])


def is_container(state: Any) -> bool:
    """Whether a state holds states."""
    return hasattr(state, "get_children")


def _is_a(state: Any, kind: str) -> bool:
    """Whether a state is of a class of SMACH's, whichever SMACH it is."""
    return any(base.__name__ == kind for base in type(state).__mro__)


def _message(error: BaseException) -> str:
    """An exception in one line."""
    first = next((line for line in str(error).splitlines() if line.strip()), "")
    return f"{type(error).__name__}: {first}" if first else type(error).__name__


def trace_value(value: object) -> object:
    """A value as a trace shows it: a copy of what JSON can say, else its `repr`."""
    try:
        return json.loads(json.dumps(value, allow_nan=False))
    except (TypeError, ValueError, RecursionError):
        return re.sub(r" at 0x[0-9a-fA-F]+", "", repr(value))
