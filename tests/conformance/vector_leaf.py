"""The scripted leaves of a recorded machine, and the recording of what happens to them."""

from __future__ import annotations

import copy
import threading
from collections.abc import Callable
from typing import Any

from smachac.runtime import smach

Json = Any
PATIENCE = 20.0
"""Seconds after which a wait inside a case counts as a hang."""

_EXCEPTIONS: dict[str, Callable[[str], BaseException]] = {
    "ValueError": ValueError,
    "KeyError": KeyError,
    "RuntimeError": RuntimeError,
    "KeyboardInterrupt": KeyboardInterrupt,
}


def join(path: str, label: str) -> str:
    """The path of a child."""
    return f"{path.rstrip('/')}/{label}"


class Recording:
    """Events in order; those inside a concurrence are kept apart by branch.

    `library` is the SMACH that runs the case: the bundled runtime, or SMACH itself.
    """

    def __init__(self, case: Json, library: Any = smach) -> None:
        self.library = library
        self.preempts = bool(case.get("preempt"))
        self.budget = int(case.get("budget", 400))
        self.nodes: dict[str, Any] = {}
        self.types: dict[str, str] = {}
        self.scripted: list[BaseException] = []
        self.changed = threading.Condition()
        self.counts: dict[tuple[str, str], int] = {}
        self.restart()

    def restart(self) -> None:
        """Forget the events of the run before."""
        self.events: list[Json] = []
        self.causes: list[str] = []
        self.branches: dict[str, list[Json]] = {}

    def add(self, kind: str, path: str, *rest: Json) -> None:
        """Note an event where it belongs."""
        with self.changed:
            self._sink(path).append([kind, path, *rest])
            if kind == "<" and self.types[path] == "concurrence":
                inside: dict[str, list[Json]] = {label: [] for label in rest[0]}
                self._sink(path).append(["|", path, inside])
                for label, events in inside.items():
                    self.branches[join(path, label)] = events
            if kind in "+-":
                key = ("wait_started" if kind == "+" else "wait_done", path)
                self.counts[key] = self.counts.get(key, 0) + 1
                self.changed.notify_all()
            if kind == "+":
                self._spend()

    def _sink(self, path: str) -> list[Json]:
        while path:
            if path in self.branches:
                return self.branches[path]
            path = path.rpartition("/")[0]
        return self.events

    def _spend(self) -> None:
        self.budget -= 1
        assert self.budget >= 0, "the machine runs longer than recorded"

    def wait(self, done: Callable[[], bool]) -> None:
        """Wait until an event or a preempt request makes `done` true."""
        with self.changed:
            assert self.changed.wait_for(done, PATIENCE), "a leaf waits for ever"


class Script:
    """What one leaf does at each of its visits."""

    def __init__(self, node: Json, path: str, recording: Recording) -> None:
        self.node, self.path, self.recording = node, path, recording
        self.state: Any = None
        self.visits = 0

    def run(self, ud: Any) -> str | None:
        """One visit: the outcome that the script gives."""
        inputs = {} if self.node.get("blind") else self._inputs(ud)
        marked = self.recording.preempts and self.state.preempt_requested()
        event = [inputs, "P"] if marked else [inputs] if inputs else []
        self.recording.add("+", self.path, *event)
        steps = self.node["steps"]
        step = steps[min(self.visits, len(steps) - 1)]
        self.visits += 1
        try:
            outcome = self._perform(step, ud)
        except BaseException as error:
            cause = self._cause(error)
            self.recording.causes.append(cause)
            self.recording.add("!", self.path, cause)
            raise
        self.recording.add("-", self.path, outcome)
        return outcome

    def _inputs(self, ud: Any) -> dict[str, Json]:
        keys = [*self.node.get("in", []), *self.node.get("io", [])]
        return {key: copy.deepcopy(ud[key]) for key in keys if key in ud}

    def _cause(self, error: BaseException) -> str:
        if any(error is scripted for scripted in self.recording.scripted):
            return "user_exception"
        if isinstance(error, KeyError):
            return "missing_key"
        if isinstance(error, self.recording.library.InvalidUserCodeError):
            return "undeclared_read"
        return f"fault of the replay: {error!r}"

    def _perform(self, step: Json, ud: Any) -> str | None:
        for operation in step.get("do", []):
            self._do(operation, ud)
        if "raise" in step:
            raise scripted(step["raise"], self.recording)
        if "pre" in step and self.state.preempt_requested():
            self.state.service_preempt()
            return str(step["pre"])
        result = step["ret"]
        if isinstance(result, dict):
            left, right = (value(operand, ud) for operand in result["lt"])
            result = result["then"] if left < right else result["else"]
        return result if result is None else str(result)

    def _do(self, operation: Json, ud: Any) -> None:
        name, recording = operation[0], self.recording
        if name == "set" and operation[-1] == "attr" and len(operation) == 4:
            setattr(ud, operation[1], value(operation[2], ud))
        elif name == "set":
            ud[operation[1]] = value(operation[2], ud)
        elif name == "read":
            ud[operation[1]]
        elif name == "push":
            ud[operation[1]].append(value(operation[2], ud))
        elif name == "preempt":
            recording.nodes[operation[1]].request_preempt()
        elif name == "service":
            self.state.service_preempt()
        elif name == "wait_preempt":
            recording.wait(self.state.preempt_requested)
        elif name in ("wait_started", "wait_done"):
            key, times = (name, operation[1]), (*operation, 1)[2]
            recording.wait(lambda: recording.counts.get(key, 0) >= times)
        else:
            raise AssertionError(f"unknown operation {name}")


def scripted(name: str, recording: Recording) -> BaseException:
    """An exception that the case asks for, remembered as such."""
    make = _EXCEPTIONS[name] if name in _EXCEPTIONS else getattr(recording.library, name)
    error: BaseException = make("scripted")
    recording.scripted.append(error)
    return error


def value(expression: Json, ud: Any) -> Any:
    """What an expression of a script is worth; anything but an object is a constant."""
    if not isinstance(expression, dict):
        return copy.deepcopy(expression)
    ((operator, operand),) = expression.items()
    if operator == "k":
        return ud[operand]
    if operator == "get":
        return ud[operand[0]] if operand[0] in ud else copy.deepcopy(operand[1])
    if operator == "has":
        return operand in ud
    if operator == "keys":
        return sorted(ud.keys())
    if operator == "add":
        return value(operand[0], ud) + value(operand[1], ud)
    assert operator == "append"
    return [*value(operand[0], ud), value(operand[1], ud)]


class Follower:
    """What makes a state follow a script and report preempt requests; a State comes behind it."""

    script: Script

    def execute(self, ud: Any, /) -> str | None:
        return self.script.run(ud)

    def request_preempt(self) -> None:
        recording = self.script.recording
        if recording.preempts:
            recording.add("P", self.script.path)
        state: Any = super()
        state.request_preempt()
        with recording.changed:
            recording.changed.notify_all()

    def recall_preempt(self) -> None:
        if self.script.recording.preempts:
            self.script.recording.add("R", self.script.path)
        state: Any = super()
        state.recall_preempt()


class Leaf(Follower, smach.State):
    """A state of the bundled runtime that follows a script."""

    def __init__(self, script: Script) -> None:
        node = script.node
        smach.State.__init__(
            self, node["outcomes"], node.get("in", []), node.get("out", []), node.get("io", [])
        )
        self.script = script
        script.state = self
