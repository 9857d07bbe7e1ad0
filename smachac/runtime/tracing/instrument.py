"""Instrumentation of a machine built with SMACH: wrapped states that record their events."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping, Set
from operator import itemgetter
from typing import Any

from smachac.runtime.messages import message_of
from smachac.runtime.tracing.gate import Gate
from smachac.runtime.tracing.writer import SECRET, Event, Recorder


class PathEvents:
    """The prepared events of a state at one of its paths; they recur at each visit.

    Attributes:
        parent: the container around the state; None for the machine itself.
        entered: the event of its start.
        exits: outcome -> the events of an end with that outcome.
        userdata: the userdata of the leaf's last visit.
        traced_userdata: the same, wrapped so that writes are recorded.
    """

    __slots__ = ("entered", "exits", "label", "parent", "path", "traced_userdata", "userdata")

    def __init__(
        self, parent: InstrumentedState | None, label: str, path: str, entered: Any
    ) -> None:
        self.parent, self.label, self.path, self.entered = parent, label, path, entered
        self.exits: dict[Any, Any] = {}
        self.userdata: Any = None
        self.traced_userdata: Any = None


class InstrumentedState:
    """A state whose `execute` and `request_preempt` are wrapped to record events.

    Attributes:
        places: the containers that hold the state, each with its label there.
        path: the path at which it ran last.
        failed: whether the error of a state inside was recorded in this run.
    """

    def __init__(
        self,
        state: Any,
        recorder: Recorder,
        others: Mapping[int, InstrumentedState],
        gate: Gate | None = None,
        secret: Mapping[str, Set[str]] = {},
    ) -> None:
        self.state = state
        self.recorder = recorder
        self._others = others
        self._gate = gate
        self._secret = secret
        self.places: list[tuple[InstrumentedState | None, str]] = []
        self.path = ""
        self.failed = False
        self._is_container = is_container(state)
        self._is_iterator = _is_a(state, "Iterator")
        self._is_concurrence = _is_a(state, "Concurrence")
        # A generated state that turns exceptions into an outcome keeps the exception here.
        self._catches = hasattr(state, "caught")
        self._events: dict[str, PathEvents] = {}
        self._only_events: PathEvents | None = None
        self._exits: dict[tuple[str, str], str | None] | None = None
        self._iteration: tuple[str, str] | None = None
        self._execute = state.execute
        self._request_preempt = state.request_preempt
        state.execute = self._traced_execute
        state.request_preempt = self._traced_request

    def _clear_cache(self) -> None:
        """Forget paths and transitions: the machine may be changed between two runs."""
        self._only_events = self._exits = None
        self._events.clear()

    def _traced_execute(self, *arguments: Any, **named: Any) -> Any:
        here = self._only_events or self._events_here()
        parent = here.parent
        if parent is not None and parent._iteration is not None:
            parent.record_next_iteration()
        if self._gate is not None and self._gate.armed and parent is not None:
            forced = self._gate.before(here.path, self._outcomes())
            if forced is not None:
                self._iteration = None
                self.recorder.record(here.entered)
                return self._ends(here, forced, forced=True)
        if self._is_container:
            self.failed, self._iteration = False, None
        elif arguments:
            arguments = (self._trace_writes(here, arguments[0]), *arguments[1:])
        record = self.recorder.record
        record(here.entered)
        try:
            outcome = self._execute(*arguments, **named)
        except BaseException as error:
            self._record_failure(parent, _message(error))
            raise
        if self._catches and self.state.caught is not None:
            self._record_error(_message(self.state.caught))
            self.state.caught = None
        if outcome is None:
            self._record_failure(parent, "ended without an outcome")
            return outcome
        if self._gate is not None and self._gate.armed and parent is not None:
            chosen = self._gate.after(here.path, outcome, self._outcomes())
            if chosen != outcome:
                return self._ends(here, chosen, forced=True)
        return self._ends(here, outcome)

    def _ends(self, here: PathEvents, outcome: Any, *, forced: bool = False) -> Any:
        """Record the end of a visit; its outcome."""
        if self._iteration is not None:
            self._record_last_iteration(outcome)
        if forced:
            ended = self._ended(here, outcome, forced=True)
        else:
            try:
                ended = here.exits[outcome]
            except (KeyError, TypeError):
                ended = self._ended(here, outcome)
        if ended is not None:
            self.recorder.record(ended)
        if here.parent is not None and here.parent._is_iterator:
            here.parent._iteration = (here.path, outcome)
        return outcome

    def _outcomes(self) -> tuple[str, ...]:
        return tuple(self.state.get_registered_outcomes())

    def _traced_request(self) -> None:
        place = self._place()
        self.recorder.emit("preempt", self._path(*place))
        self._request_preempt()
        if self._gate is not None and place[0] is None:
            self._gate.release()  # after the request, which the state that waits must find

    def _trace_writes(self, here: PathEvents, userdata: Any) -> Any:
        """The leaf's userdata, wrapped so that every write to an output key is recorded."""
        if userdata is here.userdata:
            return here.traced_userdata
        any_key = here.parent is None or here.parent._is_iterator
        prepared: dict[str, Any] = {}
        secret = self._secret.get(here.path, frozenset())

        def written(key: str, value: object) -> None:
            if key in secret:
                value = SECRET
            if key in prepared:
                self.recorder.record(prepared[key], value)
            elif any_key or key in self.state.get_registered_output_keys():
                event = {"event": "write", "path": here.path, "key": key, "value": None}
                prepared[key] = self.recorder.prepare(event)
                self.recorder.record(prepared[key], value)

        inputs = frozenset(self.state.get_registered_input_keys())
        here.userdata = userdata
        here.traced_userdata = _traced_userdata_class(inputs)(userdata, written)
        return here.traced_userdata

    def _events_here(self) -> PathEvents:
        """The events at the path at which the state starts now; the root starts a new trace."""
        parent, label = self._place()
        if parent is None:
            self.recorder.start()
            for other in self._others.values():
                other._clear_cache()
        path = self.path = self._path(parent, label)
        here = self._events.get(path)
        if here is None:
            kind = "start" if parent is None else "enter"
            entered = self.recorder.prepare({"event": kind, "path": path})
            here = self._events[path] = PathEvents(parent, label, path, entered)
        if parent is not None and len(self.places) == 1 and parent._is_fixed():
            self._only_events = here
        return here

    def _is_fixed(self) -> bool:
        """Whether the path is the same in the whole run."""
        return self._only_events is not None or self.places[0][0] is None

    def _place(self) -> tuple[InstrumentedState | None, str]:
        """The container that runs the state now, and its label there; one of several places."""
        if len(self.places) > 1:
            for parent, label in self.places:
                if parent is None or label in parent.state.get_active_states():
                    return parent, label
        return self.places[0]

    def _path(self, parent: InstrumentedState | None, label: str) -> str:
        """The path of the state, by the paths at which the containers around it ran last."""
        labels = [label]
        while parent is not None and not parent.path:
            parent, label = parent.places[0]
            labels.append(label)
        if parent is not None:
            labels.append(parent.path)
        return "/".join(reversed(labels))

    def _record_failure(self, parent: InstrumentedState | None, message: str) -> None:
        """Record an error that leaves this state."""
        self._record_error(message)
        if parent is not None:
            parent.failed = True

    def _record_error(self, message: str) -> None:
        """Record an error, unless that of a state inside was recorded."""
        if not self.failed:
            self.recorder.emit("error", self.path, message=message)

    def record_next_iteration(self) -> None:
        """Record the transition of an iterator's child to itself: it starts for the next item."""
        assert self._iteration is not None
        path, outcome = self._iteration
        self.recorder.emit("transition", path, outcome=outcome, to=path)
        self._iteration = None

    def _record_last_iteration(self, outcome: str) -> None:
        """Record the transition of an iterator's child to the end of the iterator."""
        assert self._iteration is not None
        path, ended = self._iteration
        self.recorder.emit("transition", path, outcome=ended, to=f"{self.path}:{outcome}")

    def _ended(self, here: PathEvents, outcome: Any, *, forced: bool = False) -> Any:
        """The events of an end with this outcome; None, and an error, if it is not registered."""
        parent, path = here.parent, here.path
        kind = "finish" if parent is None else "exit"
        events: list[Event] = [{"event": kind, "path": path, "outcome": outcome}]
        if forced:
            events[0]["forced"] = True
        if parent is not None and not (parent._is_iterator or parent._is_concurrence):
            if outcome not in self.state.get_registered_outcomes():
                self.recorder.record(self.recorder.prepare(*events))
                message = f"ended with `{outcome}`, which is not one of its outcomes"
                self._record_failure(parent, message)
                return None
            to = parent.target(here.label, outcome)
            events.append({"event": "transition", "path": path, "outcome": outcome, "to": to})
        prepared = self.recorder.prepare(*events)
        if not forced:
            here.exits[outcome] = prepared
        return prepared

    def target(self, label: str, outcome: str) -> str:
        """The target of a child's outcome: a path, or `path:outcome` if this container ends."""
        if self._exits is None:
            edges = self.state.get_internal_edges()
            self._exits = {(edge[1], edge[0]): edge[2] for edge in edges}
        target = self._exits.get((label, outcome))
        inside = bool(target) and target in self.state.get_children()
        return f"{self.path}/{target}" if inside else f"{self.path}:{target or outcome}"


class _TracedUserdata:
    """A leaf's userdata that reports writes to a callback; all else is passed through."""

    __iter__ = None  # like SMACH's userdata, it cannot be iterated

    def __init__(self, userdata: Any, written: Callable[[str, object], None]) -> None:
        object.__setattr__(self, "_userdata", userdata)
        object.__setattr__(self, "_written", written)

    def __getattr__(self, name: str) -> Any:
        if name == "_userdata":  # while a copy is being made
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
    """Whether a state is a container."""
    return callable(getattr(state, "get_children", None))


def _is_a(state: Any, kind: str) -> bool:
    """Whether a state is of the class named `kind` of any SMACH."""
    return any(base.__name__ == kind for base in type(state).__mro__)


def _message(error: BaseException) -> str:
    """The type and the first line of an exception."""
    first = next((line for line in message_of(error).splitlines() if line.strip()), "")
    return f"{type(error).__name__}: {first}" if first else type(error).__name__


@functools.cache
def _traced_userdata_class(keys: frozenset[str]) -> type[_TracedUserdata]:
    """The class with a property for each of these keys, which is faster than `__getattr__`.

    Cached for the process: making a class takes 21 us, and states of a kind have the same keys.
    """
    names = [key for key in keys if not key.startswith("_") and not hasattr(_TracedUserdata, key)]
    properties = {name: property(itemgetter(name)) for name in names}
    return type("TracedUserdata", (_TracedUserdata,), properties)
