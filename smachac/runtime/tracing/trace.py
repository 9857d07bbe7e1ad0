"""The trace of a state machine built with SMACH, and leaves that follow a script of outcomes.

Only SMACH's public interface is used, so the machine may be built with the bundled runtime or with
SMACH itself. A machine that is not traced runs as fast as before. An event is one JSON object:

    {"seq": 1, "event": "exit", "path": "sm/PICK/GRASP", "outcome": "succeeded", "t": 1.5,
     "src": "pick.yml:21"}

`event` is one of start, enter, exit, transition, write, preempt, error, finish. `t` is the time in
seconds since the start. `src` is the place of the state in the script, where known. The section
"Traces" of docs/semantics.md describes every event.
"""

from __future__ import annotations

import copy
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from itertools import count
from typing import Any, NamedTuple

from smachac.runtime.tracing.gate import Gate
from smachac.runtime.tracing.instrument import InstrumentedState, is_container
from smachac.runtime.tracing.writer import (
    Event,
    EventQueue,
    Observer,
    Recorder,
    Sink,
    TraceWriter,
    trace_value,
)

__all__ = ["Event", "StrictScript", "TraceWriter", "Visit", "attach", "script", "trace_value"]

PREEMPTED = "preempted"
"""The outcome of a scripted leaf with a preempt request, if the leaf has that outcome."""

LONGEST_WAIT = 5.0
"""Longest time (s) that a scripted leaf waits for a preempt request."""


class Visit(NamedTuple):
    """One visit of a scripted leaf: its outcome and the values that it writes, by key.

    `stop`: the leaf first preempts the whole machine. `wait`: it waits for a preempt request.
    `error`: it raises RuntimeError with this text instead of ending.
    """

    outcome: str
    writes: Mapping[str, object] = {}
    wait: bool = False
    error: str = ""
    stop: bool = False


class ScriptViolationError(RuntimeError):
    """A run deviates from its script: a visit too many, or a missing preempt request."""


class StrictScript(NamedTuple):
    """Limits of a run that follows its script exactly, for runs that are compared.

    `reads` are the keys, by path, that a leaf reads when it starts; `on_read(path, key, value)` is
    called for those that are present. After `max_visits` visits of leaves the run ends with an
    error.
    """

    reads: Mapping[str, Sequence[str]]
    on_read: Callable[[str, str, object], None]
    max_visits: int


def attach(
    machine: Any,
    name: str,
    observe: Observer | Sink | EventQueue,
    sources: Mapping[str, str] = {},
    *,
    clock: Callable[[], float] = time.monotonic,
    paths: Mapping[str, str] = {},
    gate: Gate | None = None,
    secret: Mapping[str, Set[str]] = {},
) -> Callable[..., None]:
    """Trace a built machine: `observe` is called with every event from now on.

    The function that is returned records an event of something else, such as a simulation: its
    arguments are the name of the event, its path, and its other fields by keyword.

    `name` is the path of the machine itself, `sources` the places of states in the script by path,
    `clock` returns seconds. `paths` are paths to show in place of those of states that SMACH's
    labels make. `observe` is called by the threads of the machine, one call at a time.
    If a call raises, the error is printed to stderr, the machine continues, and no more calls are
    made. A sink, as a `TraceWriter` is one, is not called: it receives events that are prepared at
    their first use; so does a queue. `gate` lets a debugger stop the machine between two states.
    `secret` are the keys of states, by path, whose values are shown as `SECRET`.
    """
    recorder = Recorder(observe, sources, clock, paths)
    instrumented: dict[int, InstrumentedState] = {}
    for parent, label, state in _walk(machine, name):
        known = instrumented.get(id(state))
        if known is None:
            known = InstrumentedState(state, recorder, instrumented, gate, secret)
            instrumented[id(state)] = known
        known.places.append((None if parent is None else instrumented[id(parent)], label))
    if gate is not None:
        gate.opened(machine.request_preempt)
    return recorder.emit


def script(
    machine: Any,
    name: str,
    steps: Mapping[str, Sequence[tuple[Any, ...]]],
    strict: StrictScript | None = None,
) -> None:
    """Replace what leaves do, by path, with scripted visits (`steps`, see Visit).

    Visit n takes step n, and the last step repeats. With `strict`, a visit without a step of its
    own raises ScriptViolationError, which ends the run. A leaf with a preempt request ends as
    `preempted` if it has that outcome. To be called before `attach`. Raises KeyError for a path
    that is no leaf and, without `strict`, for a leaf without steps.
    """
    leaves = _leaves(machine, name)
    for path, row in steps.items():
        if path not in leaves or not (row or strict):
            raise KeyError(path)
        visits = [Visit(*other) for other in row]
        _replace(leaves[path], _scripted(machine, leaves[path], visits) if row else _refused)
    if strict is not None:
        total = count(1)
        for path, state in leaves.items():
            last = len(steps[path]) if path in steps else strict.max_visits
            if last:
                execute = getattr(state, "attempted", state.execute)
                _replace(state, _counted(path, execute, last, total, strict))


def _replace(state: Any, execute: Callable[[Any], str]) -> None:
    """Replace what a state does; a generated state that catches its exceptions still does so."""
    setattr(state, "attempted" if hasattr(state, "attempted") else "execute", execute)


def _refused(userdata: Any) -> str:
    raise ScriptViolationError("is not in the script")


def _counted(
    path: str, execute: Callable[[Any], Any], last: int, total: Iterator[int], strict: StrictScript
) -> Callable[[Any], Any]:
    visits = count(1)

    def counted(userdata: Any) -> Any:
        if next(visits) > last or next(total) > strict.max_visits:
            raise ScriptViolationError("is once more than in the script")
        for key in strict.reads.get(path, ()):
            if key in userdata:
                strict.on_read(path, key, userdata[key])
        return execute(userdata)

    return counted


def _leaves(machine: Any, name: str) -> dict[str, Any]:
    leaves = {}
    paths = {id(machine): name}
    for parent, label, state in _walk(machine, name):
        path = label if parent is None else f"{paths[id(parent)]}/{label}"
        paths[id(state)] = path
        if not is_container(state):
            leaves[path] = state
    return leaves


def _scripted(machine: Any, state: Any, steps: Sequence[Visit]) -> Callable[[Any], str]:
    visits = 0
    requested = _preempt_event(state) if any(step.wait for step in steps) else None

    def execute(userdata: Any) -> str:
        nonlocal visits
        visits += 1
        step = steps[min(visits, len(steps)) - 1]
        if step.stop:
            machine.request_preempt()
        if step.wait and requested is not None and not state.preempt_requested():
            requested.clear()
            if not state.preempt_requested() and not requested.wait(LONGEST_WAIT):
                raise ScriptViolationError("was not asked to stop")
        if state.preempt_requested() and PREEMPTED in state.get_registered_outcomes():
            state.service_preempt()
            return PREEMPTED
        if step.error:
            raise RuntimeError(step.error)
        for key, value in step.writes.items():
            userdata[key] = copy.deepcopy(value)
        return step.outcome

    return execute


def _preempt_event(state: Any) -> threading.Event:
    """An event that is set by each preempt request of a leaf."""
    requested, request = threading.Event(), state.request_preempt

    def request_preempt() -> None:
        request()
        requested.set()

    state.request_preempt = request_preempt
    return requested


def _walk(machine: Any, name: str) -> Iterator[tuple[Any, str, Any]]:
    """(container, label, state) for every state, containers before their children."""
    stack: list[tuple[Any, str, Any]] = [(None, name, machine)]
    while stack:
        parent, label, state = stack.pop()
        yield parent, label, state
        if is_container(state):
            children = [child for child in state.get_children().items() if child[1] is not None]
            stack.extend((state, item, child) for item, child in reversed(children))
