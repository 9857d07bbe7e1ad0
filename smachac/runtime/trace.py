"""What a state machine built with SMACH does, as events; leaves that follow a script.

Only SMACH's public interface is used, so the machine may be built with the bundled runtime or with
SMACH itself. A machine that is not watched pays nothing. An event is one JSON object:

    {"seq": 1, "event": "exit", "path": "sm/PICK/GRASP", "outcome": "succeeded", "t": 1.5,
     "src": "pick.yml:21"}

`event` is one of start, enter, exit, transition, write, preempt, error, finish. `t` counts seconds
from the start. `src` is the place of the state in the script, where known.
"""

from __future__ import annotations

import copy
import json
import re
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, TextIO

Event = dict[str, Any]
Observe = Callable[[Event], None]

PREEMPTED = "preempted"
"""The outcome by which a scripted leaf answers a request to stop."""


def attach(
    machine: Any,
    name: str,
    observe: Observe,
    sources: Mapping[str, str] = {},
    *,
    clock: Callable[[], float] = time.monotonic,
) -> None:
    """Watch a built machine: `observe` hears of everything that it does from now on.

    `name` is the path of the machine itself, `sources` the places of states by path, `clock`
    seconds. Calls of `observe` come one at a time, from the threads of the machine; when one
    raises, that is told on stderr, the machine goes on, and no more calls are made.
    """
    recorder = _Recorder(observe, sources, clock)
    watches: dict[int, _Watch] = {}
    for parent, label, state in _walk(machine, name):
        known = watches.get(id(state))
        if known is None:
            known = watches[id(state)] = _Watch(state, recorder)
        known.places.append((watches[id(parent)] if parent is not None else None, label))


def script(
    machine: Any, name: str, steps: Mapping[str, Sequence[tuple[str, Mapping[str, object]]]]
) -> None:
    """Let leaves, by path, follow steps (outcome, keys to write) instead of what they do.

    Visit n takes step n, the last one repeats. A leaf that was asked to stop ends as `preempted`
    where it has that outcome. To be called before `attach`. Raises KeyError for a path that is
    no leaf, or has no steps.
    """
    leaves = {}
    paths = {id(machine): name}
    for parent, label, state in _walk(machine, name):
        path = label if parent is None else f"{paths[id(parent)]}/{label}"
        paths[id(state)] = path
        if not _is_container(state):
            leaves[path] = state
    for path, row in steps.items():
        if path not in leaves or not row:
            raise KeyError(path)
        leaves[path].execute = _scripted(leaves[path], row)


def _scripted(
    state: Any, steps: Sequence[tuple[str, Mapping[str, object]]]
) -> Callable[[Any], str]:
    visits = 0

    def execute(userdata: Any) -> str:
        nonlocal visits
        visits += 1
        if state.preempt_requested() and PREEMPTED in state.get_registered_outcomes():
            state.service_preempt()
            return PREEMPTED
        outcome, writes = steps[min(visits, len(steps)) - 1]
        for key, value in writes.items():
            userdata[key] = copy.deepcopy(value)
        return outcome

    return execute


def _walk(machine: Any, name: str) -> Iterator[tuple[Any, str, Any]]:
    """Every state with the container around it and its label, containers before what they hold."""
    stack: list[tuple[Any, str, Any]] = [(None, name, machine)]
    while stack:
        parent, label, state = stack.pop()
        yield parent, label, state
        if _is_container(state):
            children = state.get_children()
            stack.extend((state, each, children[each]) for each in reversed(list(children)))


def _is_container(state: Any) -> bool:
    return hasattr(state, "get_children")


def _is_a(state: Any, kind: str) -> bool:
    """Whether a state is of a class of SMACH's, whichever SMACH it is."""
    return any(base.__name__ == kind for base in type(state).__mro__)


class _Recorder:
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
        self._began = self._clock()

    def emit(self, event: str, path: str, **more: object) -> None:
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


class _Watch:
    """Stands in front of `execute` and `request_preempt` of one state.

    Attributes:
        places: the containers that hold it, each with its label there.
        path: where it ran last.
        failed: a state inside has told of its error in this run.
    """

    def __init__(self, state: Any, recorder: _Recorder) -> None:
        self.state = state
        self.recorder = recorder
        self.places: list[tuple[_Watch | None, str]] = []
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
        if not _is_container(self.state) and arguments:
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

    def _watched_userdata(self, parent: _Watch | None, userdata: Any) -> Any:
        """The leaf's userdata, with every write that counts told."""
        keys = self.state.get_registered_output_keys()
        loose = parent is None or _is_a(parent.state, "Iterator")
        path = self.path

        def written(key: str, value: object) -> None:
            if loose or key in keys:
                self.recorder.emit("write", path, key=key, value=trace_value(value))

        return _Written(userdata, written)

    def _place(self) -> tuple[_Watch | None, str]:
        """The container that runs it now; one state may stand in several places."""
        if len(self.places) > 1:
            for parent, label in self.places:
                if parent is None or label in parent.state.get_active_states():
                    return parent, label
        return self.places[0]

    def _path(self, parent: _Watch | None, label: str) -> str:
        """The path, by where the containers around it ran last."""
        labels = [label]
        while parent is not None and not parent.path:
            parent, label = parent.places[0]
            labels.append(label)
        if parent is not None:
            labels.append(parent.path)
        return "/".join(reversed(labels))

    def _fail(self, parent: _Watch | None, message: str) -> None:
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

    def child_ended(self, child: _Watch, label: str, outcome: str) -> None:
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


class TraceWriter:
    """Writes events to a stream, one JSON object a line, each at once."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._lock = threading.RLock()
        self._seq = 0

    def __call__(self, event: Mapping[str, Any]) -> None:
        with self._lock:
            self._seq += 1
            line = json.dumps({"seq": self._seq, **event}, default=repr)
            self._stream.write(line + "\n")
            self._stream.flush()
