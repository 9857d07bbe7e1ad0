"""A watch in front of each state of a machine built with SMACH: it tells what the state does."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from operator import itemgetter
from typing import Any

from smachac.runtime.tracing.writer import Event, Recorder


class Stay:
    """A state at one of its places, with what is told there again and again.

    Attributes:
        parent: the watch of the container around it.
        ends: outcome -> what is told when it ends so.
        userdata: what the leaf was given last.
        written: the same, with every write told.
    """

    __slots__ = ("ends", "entered", "label", "parent", "path", "userdata", "written")

    def __init__(self, parent: Watch | None, label: str, path: str, entered: Any) -> None:
        self.parent, self.label, self.path, self.entered = parent, label, path, entered
        self.ends: dict[Any, Any] = {}
        self.userdata: Any = None
        self.written: Any = None


class Watch:
    """Stands in front of `execute` and `request_preempt` of one state.

    Attributes:
        places: the containers that hold it, each with its label there.
        path: where it ran last.
        failed: a state inside has told of its error in this run.
    """

    def __init__(self, state: Any, recorder: Recorder, family: Mapping[int, Watch]) -> None:
        self.state = state
        self.recorder = recorder
        self._family = family
        self.places: list[tuple[Watch | None, str]] = []
        self.path = ""
        self.failed = False
        self._is_container = is_container(state)
        self._is_iterator = _is_a(state, "Iterator")
        self._is_concurrence = _is_a(state, "Concurrence")
        self._catches = hasattr(state, "caught")  # a state of ours that ends with its exceptions
        self._stays: dict[str, Stay] = {}
        self._only: Stay | None = None
        self._exits: dict[tuple[str, str], str | None] | None = None
        self._looped: tuple[str, str] | None = None
        self._execute = state.execute
        self._request_preempt = state.request_preempt
        state.execute = self._watched_execute
        state.request_preempt = self._watched_request

    def _forget(self) -> None:
        """Ask the machine anew where things lead: it may have been changed between two runs."""
        self._only = self._exits = None
        self._stays.clear()

    def _watched_execute(self, *arguments: Any, **named: Any) -> Any:
        stay = self._only or self._stay()
        parent = stay.parent
        if parent is not None and parent._looped is not None:
            parent.looping()
        if self._is_container:
            self.failed, self._looped = False, None
        elif arguments:
            arguments = (self._watched_userdata(stay, arguments[0]), *arguments[1:])
        tell = self.recorder.tell
        tell(stay.entered)
        try:
            outcome = self._execute(*arguments, **named)
        except BaseException as error:
            self._fail(parent, _message(error))
            raise
        if self._catches and self.state.caught is not None:
            self._tell_error(_message(self.state.caught))
            self.state.caught = None
        if outcome is None:
            self._fail(parent, "ended without an outcome")
            return outcome
        if self._looped is not None:
            self._leaving(outcome)
        try:
            ended = stay.ends[outcome]
        except (KeyError, TypeError):
            ended = self._ended(stay, outcome)
        if ended is not None:
            tell(ended)
        if parent is not None and parent._is_iterator:
            parent._looped = (stay.path, outcome)
        return outcome

    def _watched_request(self) -> None:
        self.recorder.emit("preempt", self._path(*self._place()))
        self._request_preempt()

    def _watched_userdata(self, stay: Stay, userdata: Any) -> Any:
        """The leaf's userdata, with every write that counts told."""
        if userdata is stay.userdata:
            return stay.written
        loose = stay.parent is None or stay.parent._is_iterator
        known: dict[str, Any] = {}

        def written(key: str, value: object) -> None:
            if key in known:
                self.recorder.tell(known[key], value)
            elif loose or key in self.state.get_registered_output_keys():
                event = {"event": "write", "path": stay.path, "key": key, "value": None}
                known[key] = self.recorder.prepare(event)
                self.recorder.tell(known[key], value)

        inputs = frozenset(self.state.get_registered_input_keys())
        stay.userdata, stay.written = userdata, _writing(inputs)(userdata, written)
        return stay.written

    def _stay(self) -> Stay:
        """Where it starts to run now."""
        parent, label = self._place()
        if parent is None:
            self.recorder.start()
            for watch in self._family.values():
                watch._forget()
        path = self.path = self._path(parent, label)
        stay = self._stays.get(path)
        if stay is None:
            kind = "start" if parent is None else "enter"
            told = self.recorder.prepare({"event": kind, "path": path})
            stay = self._stays[path] = Stay(parent, label, path, told)
        if parent is not None and len(self.places) == 1 and parent._is_fixed():
            self._only = stay
        return stay

    def _is_fixed(self) -> bool:
        """Whether its path is the same in the whole run."""
        return self._only is not None or self.places[0][0] is None

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
        """Tell of an error that goes on."""
        self._tell_error(message)
        if parent is not None:
            parent.failed = True

    def _tell_error(self, message: str) -> None:
        """Tell of an error, unless a state inside has done so."""
        if not self.failed:
            self.recorder.emit("error", self.path, message=message)

    def looping(self) -> None:
        """The child of an iterator starts again: its last outcome has led to itself."""
        assert self._looped is not None
        path, outcome = self._looped
        self.recorder.emit("transition", path, outcome=outcome, to=path)
        self._looped = None

    def _leaving(self, outcome: str) -> None:
        """In an iterator, its child's last outcome has led to its end."""
        assert self._looped is not None
        path, ended = self._looped
        self.recorder.emit("transition", path, outcome=ended, to=f"{self.path}:{outcome}")

    def _ended(self, stay: Stay, outcome: Any) -> Any:
        """What is told when it ends with an outcome; None if that leads nowhere, which is told."""
        parent, path = stay.parent, stay.path
        kind = "finish" if parent is None else "exit"
        events: list[Event] = [{"event": kind, "path": path, "outcome": outcome}]
        if parent is not None and not (parent._is_iterator or parent._is_concurrence):
            if outcome not in self.state.get_registered_outcomes():
                self.recorder.tell(self.recorder.prepare(*events))
                self._fail(parent, f"ended with `{outcome}`, which is not one of its outcomes")
                return None
            to = parent.target(stay.label, outcome)
            events.append({"event": "transition", "path": path, "outcome": outcome, "to": to})
        told = stay.ends[outcome] = self.recorder.prepare(*events)
        return told

    def target(self, label: str, outcome: str) -> str:
        """Where an outcome of a child leads: a path, or `path:outcome` where this ends."""
        if self._exits is None:
            edges = self.state.get_internal_edges()
            self._exits = {(edge[1], edge[0]): edge[2] for edge in edges}
        target = self._exits.get((label, outcome))
        inside = bool(target) and target in self.state.get_children()
        return f"{self.path}/{target}" if inside else f"{self.path}:{target or outcome}"


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


@functools.cache
def _writing(keys: frozenset[str]) -> type[_Written]:
    """The class with these keys as attributes: the detour over `__getattr__` is slow."""
    names = [key for key in keys if not key.startswith("_") and not hasattr(_Written, key)]
    return type("Written", (_Written,), {name: property(itemgetter(name)) for name in names})
