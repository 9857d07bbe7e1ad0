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
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from smachac.runtime.record import Event, Observe, Recorder, TraceWriter, trace_value
from smachac.runtime.watch import Watch, is_container

__all__ = ["Event", "TraceWriter", "attach", "script", "trace_value"]

PREEMPTED = "preempted"
"""The outcome by which a scripted leaf answers a request to stop."""


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
        if not is_container(state):
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
        if is_container(state):
            children = [child for child in state.get_children().items() if child[1] is not None]
            stack.extend((state, each, child) for each, child in reversed(children))
