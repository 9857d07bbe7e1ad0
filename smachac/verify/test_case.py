"""What is played on targets, and how the traces of it are compared."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run
from smachac.interpreter.scenario import Row, Scenario, plain_steps_by_path, scenario_behaviour
from smachac.interpreter.userdata import Userdata
from smachac.ir.nodes import Leaf, Machine
from smachac.ir.traversal import walk
from smachac.runtime.tracing.compare import Difference, difference
from smachac.runtime.tracing.writer import trace_value
from smachac.verify.paths import Path
from smachac.verify.sample_values import given
from smachac.verify.shared_keys import sure_reads

Event = dict[str, Any]


class UnplayableError(Exception):
    """A target cannot be played here; the words say why."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """What a player is to play: rows by path of every leaf that follows the scenario, those that
    do what they do (`live`), the keys that the others tell of, what the machine finds in its
    userdata, and the most visits of leaves that a run may take."""

    rows: Mapping[str, Sequence[Row]]
    live: frozenset[str]
    reads: Mapping[str, Sequence[str]]
    userdata: Mapping[str, object]
    most: int


Player = Callable[[Sequence[Scene]], Iterable[list[Event]]]
"""Plays scenes on a target: the trace of each, made when it is asked for. May raise
UnplayableError."""


def scenes_of(machine: Machine, paths: Sequence[Path], live: frozenset[str]) -> list[Scene]:
    """The scenes of paths. Leaves that a path does not visit have no rows: to get there is an
    error; but `live` leaves do what they do on a path that is live."""
    reads, userdata = sure_reads(machine), given(machine)
    leaves = [path for path, node in walk(machine.root) if isinstance(node, Leaf)]
    scenes = []
    told = {path: keys for path, keys in reads.items() if path not in live}
    for path in paths:
        own = live if path.live else frozenset()
        rows: dict[str, Sequence[Row]] = {name: () for name in leaves if name not in own}
        rows |= plain_steps_by_path(path.scenario, machine)
        scenes.append(
            Scene(
                rows=rows,
                live=own,
                reads=told if own else reads,
                userdata=userdata,
                most=path.visits,
            )
        )
    return scenes


def expected(machine: Machine, scenario: Scenario, scene: Scene) -> list[Event]:
    """The trace of the interpreter, with what leaves read."""
    events: list[Event] = []
    follow = scenario_behaviour(scenario, machine, builtin_behaviour())

    def behave(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
        for key in scene.reads.get(path, ()):
            if key in userdata:
                see(events, path, key, userdata[key])
        return follow(path, leaf, visit, userdata)

    run(machine, behave, events.append, schedule=(), userdata=scene.userdata)
    return events


def see(events: list[Event], path: str, key: str, value: object) -> None:
    """Add what a leaf reads to a trace, unless that is nothing, which some targets do not tell
    from a key that holds nothing. What JSON cannot say is told apart from nothing only."""
    if value is None:
        return
    try:
        json.dumps(value, allow_nan=False)
        told = trace_value(value)
    except (TypeError, ValueError, RecursionError):
        told = OPAQUE
    events.append({"event": "read", "path": path, "key": key, "value": told})


OPAQUE = "(not JSON)"


def differ(ours: list[Event], theirs: list[Event]) -> Difference | None:
    """Where they differ. To whom a request to stop gets hangs on how far a branch has come, and
    of what is not JSON in one of them nothing is known."""
    opaque = {
        (event["path"], event["key"])
        for event in (*ours, *theirs)
        if event["event"] == "read" and event["value"] == OPAQUE
    }
    kept = [
        [
            event
            for event in events
            if event["event"] != "preempt"
            and not (event["event"] == "read" and (event["path"], event["key"]) in opaque)
        ]
        for events in (ours, theirs)
    ]
    return difference(*kept)
