"""The two workloads of bench/runtime.py in public state machine packages.

These packages are driven by events: code runs when a state is entered, and its caller sends the
next event. So here a leaf is a state whose entry runs the body, and the outcome of the body is the
event to send. The body is the same for all three. None of them has userdata with borders between
machines; the counter stands in one object, or context, for all states.
"""

from __future__ import annotations

import importlib
import importlib.util
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

Measured = Callable[[], int]
"""Runs a machine from count 0 to its end and gives the count reached."""

Tree = Mapping[str, Any]
"""States by name: a leaf has a dict of targets by event, a container a dict under `states`.

The first state of each is its initial one. Names are unique in the whole tree, and have no `_`,
which is how `transitions` joins them to paths.
"""

PING_PONG: Tree = {
    "PING": {"next": "PONG", "done": "END"},
    "PONG": {"next": "PING", "done": "END"},
}
HIERARCHY: Tree = {
    "TOP1": {"next": "MID"},
    "MID": {
        "states": {
            "MID1": {"next": "INNER"},
            "INNER": {
                "states": {
                    "INNER1": {"next": "INNER2"},
                    "INNER2": {"next": "MID2", "done": "END"},
                }
            },
            "MID2": {"next": "TOP2"},
        }
    },
    "TOP2": {"next": "TOP1"},
}


@dataclass(frozen=True, slots=True)
class Peer:
    """A package on PyPI: what `pip install` and `import` call it, and how it runs a tree."""

    package: str
    module: str
    build: Callable[[Tree, int], Measured]

    def is_installed(self) -> bool:
        """Whether it can be imported here."""
        return importlib.util.find_spec(self.module) is not None


@dataclass(slots=True)
class Work:
    """The body of every leaf, and what it counts."""

    limit: int
    count: int = 0
    outcome: str = "next"

    def step(self) -> None:
        """What a leaf does when it is entered."""
        self.count = count = self.count + 1
        self.outcome = "next" if count < self.limit else "done"


def _edges(tree: Tree) -> list[tuple[str, str, str]]:
    """Every edge of a tree as (event, source, target)."""
    found = []
    for name, state in tree.items():
        if "states" in state:
            found += _edges(state["states"])
        else:
            found += [(event, name, target) for event, target in state.items()]
    return found


def build_transitions(tree: Tree, limit: int) -> Measured:
    """A model of its own, `on_enter` callbacks, nested states; the event goes to `trigger`.

    The initial state is not entered, so one more state stands before it.
    """
    from transitions import Machine
    from transitions.extensions import HierarchicalMachine

    nested = any("states" in state for state in tree.values())
    paths: dict[str, str] = {"END": "END"}

    def states(part: Tree, above: str) -> list[dict[str, Any]]:
        rows: list[dict[str, Any]] = []
        for name, state in part.items():
            paths[name] = f"{above}{name}"
            row: dict[str, Any] = {"name": name}
            if "states" in state:
                row["initial"] = next(iter(state["states"]))
                row["children"] = states(state["states"], f"{paths[name]}{separator}")
            else:
                row["on_enter"] = "step"
            rows.append(row)
        return rows

    separator = HierarchicalMachine.state_cls.separator
    rows = [{"name": "START"}, *states(tree, ""), {"name": "END"}]
    edges = [["next", "START", next(iter(tree))]]
    edges += [[event, paths[source], paths[target]] for event, source, target in _edges(tree)]

    class Model:
        """The work, and what the machine puts into its model."""

        state: str
        trigger: Callable[[str], bool]

        def __init__(self) -> None:
            self.work = Work(limit)
            self.step = self.work.step

    model = Model()
    kind = HierarchicalMachine if nested else Machine
    machine = kind(model, rows, transitions=edges, initial="START", auto_transitions=False)

    def measured() -> int:
        work = model.work
        work.count, work.outcome = 0, "next"
        machine.set_state("START")
        while model.state != "END":
            model.trigger(work.outcome)
        return work.count

    return measured


def build_statemachine(tree: Tree, limit: int) -> Measured:
    """A class of states and events, compound states as classes; the event goes to `send`."""
    package: Any = importlib.import_module("statemachine")  # its metaclasses say more than mypy
    State = package.State  # noqa: N806
    found: dict[str, Any] = {"END": State(final=True)}
    events: dict[str, Any] = {}

    def states(part: Tree) -> dict[str, Any]:
        own: dict[str, Any] = {}
        for name, state in part.items():
            first = not own
            if "states" in state:
                inner = states(state["states"])
                made = type(State.Compound)(name, (State.Compound,), inner, initial=first)
            else:
                made = State(initial=first, enter="step")
            own[name] = found[name] = made
        return own

    body = states(tree)
    for event, source, target in _edges(tree):
        edge = found[source].to(found[target])
        events[event] = events[event] | edge if event in events else edge

    class Base(package.StateChart):  # type: ignore[misc]
        """The work; states and events come below."""

        def __init__(self) -> None:
            self.work = Work(limit)
            super().__init__()

        def step(self) -> None:
            self.work.step()

    chart = type(package.StateChart)("Chart", (Base,), {**body, "END": found["END"], **events})

    def measured() -> int:
        machine = chart()
        while not machine.is_terminated:
            machine.send(machine.work.outcome)
        return int(machine.work.count)

    return measured


def build_sismic(tree: Tree, limit: int) -> Measured:
    """A statechart in YAML (JSON is a part of it), code `on entry`; the event goes to `queue`."""
    from sismic.interpreter import Interpreter
    from sismic.io import import_from_yaml

    def states(part: Tree) -> list[dict[str, Any]]:
        rows: list[dict[str, Any]] = []
        for name, state in part.items():
            row: dict[str, Any] = {"name": name}
            if "states" in state:
                row["initial"] = next(iter(state["states"]))
                row["states"] = states(state["states"])
            else:
                row["on entry"] = "work.step()"
                row["transitions"] = [
                    {"event": event, "target": target} for event, target in state.items()
                ]
            rows.append(row)
        return rows

    rows = [*states(tree), {"name": "END", "type": "final"}]
    root = {"name": "root", "initial": next(iter(tree)), "states": rows}
    chart = import_from_yaml(json.dumps({"statechart": {"name": "bench", "root state": root}}))

    def measured() -> int:
        work = Work(limit)
        interpreter = Interpreter(chart, initial_context={"work": work})
        interpreter.execute()
        while not interpreter.final:
            interpreter.queue(work.outcome).execute()
        return work.count

    return measured


PEERS = (
    Peer("transitions", "transitions", build_transitions),
    Peer("sismic", "sismic", build_sismic),
    Peer("python-statemachine", "statemachine", build_statemachine),
)
