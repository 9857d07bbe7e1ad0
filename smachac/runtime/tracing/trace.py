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
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import count
from typing import Any, NamedTuple

from smachac.runtime.tracing.instrument import Watch, is_container
from smachac.runtime.tracing.writer import Event, Observe, Recorder, TraceWriter, trace_value

__all__ = ["Event", "Strictly", "TraceWriter", "Visit", "attach", "script", "trace_value"]

PREEMPTED = "preempted"
"""The outcome by which a scripted leaf answers a request to stop."""

LONGEST_WAIT = 5.0
"""Seconds that a leaf which is to wait for a request to stop waits for one."""


class Visit(NamedTuple):
    """One visit of a scripted leaf: its outcome and the keys that it writes.

    `stop`: it first asks the whole machine to stop. `wait`: it waits until it is asked to stop.
    `error`: it raises this instead of ending.
    """

    outcome: str
    writes: Mapping[str, object] = {}
    wait: bool = False
    error: str = ""
    stop: bool = False


class LeftScriptError(RuntimeError):
    """A leaf did not get what its script foresees: another visit, or a request to stop."""


class Strictly(NamedTuple):
    """How leaves follow a script to the letter, for runs that are compared.

    `reads` are the keys that a leaf, by path, looks at when it starts; `seen` hears of those that
    are there. `most` visits of leaves end a run that would go on for ever.
    """

    reads: Mapping[str, Sequence[str]]
    seen: Callable[[str, str, object], None]
    most: int


def attach(
    machine: Any,
    name: str,
    observe: Observe | TraceWriter,
    sources: Mapping[str, str] = {},
    *,
    clock: Callable[[], float] = time.monotonic,
) -> None:
    """Watch a built machine: `observe` hears of everything that it does from now on.

    `name` is the path of the machine itself, `sources` the places of states by path, `clock`
    seconds. Calls of `observe` come one at a time, from the threads of the machine; when one
    raises, that is told on stderr, the machine goes on, and no more calls are made. For a
    `TraceWriter` no event is made at all: its lines are prepared when they come the first time.
    """
    recorder = Recorder(observe, sources, clock)
    watches: dict[int, Watch] = {}
    for parent, label, state in _walk(machine, name):
        known = watches.get(id(state))
        if known is None:
            known = watches[id(state)] = Watch(state, recorder, watches)
        known.places.append((watches[id(parent)] if parent is not None else None, label))


def script(
    machine: Any,
    name: str,
    steps: Mapping[str, Sequence[tuple[Any, ...]]],
    strictly: Strictly | None = None,
) -> None:
    """Let leaves, by path, follow steps (see Visit) instead of what they do.

    Visit n takes step n, the last one repeats; but `strictly` a visit that no step is for raises
    LeftScriptError, and so ends the run. A leaf that was asked to stop ends as `preempted` where it
    has that outcome. To be called before `attach`. Raises KeyError for a path that is no leaf, or
    that has no steps and would need one.
    """
    leaves = _leaves(machine, name)
    for path, row in steps.items():
        if path not in leaves or not (row or strictly):
            raise KeyError(path)
        visits = [Visit(*each) for each in row]
        _replace(leaves[path], _scripted(machine, leaves[path], visits) if row else _refused)
    if strictly is not None:
        total = count(1)
        for path, state in leaves.items():
            last = len(steps[path]) if path in steps else strictly.most
            if last:
                execute = getattr(state, "attempted", state.execute)
                _replace(state, _counted(path, execute, last, total, strictly))


def _replace(state: Any, execute: Callable[[Any], str]) -> None:
    """Let a state do something else; one of ours that catches its exceptions still does."""
    setattr(state, "attempted" if hasattr(state, "attempted") else "execute", execute)


def _refused(userdata: Any) -> str:
    raise LeftScriptError("is not in the script")


def _counted(
    path: str, execute: Callable[[Any], Any], last: int, total: Iterator[int], how: Strictly
) -> Callable[[Any], Any]:
    visits = count(1)

    def counted(userdata: Any) -> Any:
        if next(visits) > last or next(total) > how.most:
            raise LeftScriptError("is once more than in the script")
        for key in how.reads.get(path, ()):
            if key in userdata:
                how.seen(path, key, userdata[key])
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
    asked = _requests(state) if any(step.wait for step in steps) else None

    def execute(userdata: Any) -> str:
        nonlocal visits
        visits += 1
        step = steps[min(visits, len(steps)) - 1]
        if step.stop:
            machine.request_preempt()
        if step.wait and asked is not None and not state.preempt_requested():
            asked.clear()
            if not state.preempt_requested() and not asked.wait(LONGEST_WAIT):
                raise LeftScriptError("was not asked to stop")
        if state.preempt_requested() and PREEMPTED in state.get_registered_outcomes():
            state.service_preempt()
            return PREEMPTED
        if step.error:
            raise RuntimeError(step.error)
        for key, value in step.writes.items():
            userdata[key] = copy.deepcopy(value)
        return step.outcome

    return execute


def _requests(state: Any) -> threading.Event:
    """An event that is set when a leaf is asked to stop."""
    asked, request = threading.Event(), state.request_preempt

    def request_preempt() -> None:
        request()
        asked.set()

    state.request_preempt = request_preempt
    return asked


def _walk(machine: Any, name: str) -> Iterator[tuple[Any, str, Any]]:
    """Every state with the container around it and its label, containers before what they hold."""
    stack: list[tuple[Any, str, Any]] = [(None, name, machine)]
    while stack:
        parent, label, state = stack.pop()
        yield parent, label, state
        if is_container(state):
            children = [child for child in state.get_children().items() if child[1] is not None]
            stack.extend((state, each, child) for each, child in reversed(children))
