"""Requests to stop, answered or not, over several runs: random machines, compiled, against the
interpreter."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

from tests.conformance_ir import test_ir_vectors as recorded
from tests.cpp.compilers import Compiler, last_with
from tests.cpp.test_vectors import told
from tests.cpp.vector_programs import Part, part, replay

Json = Any

MACHINES = 40
RUNS = 3
DEPTH = 3


def leaf(draw: random.Random, quiet: bool) -> Json:
    """A state that asks the machine to stop, answers, or does neither, as it is drawn."""
    steps = []
    for number in range(draw.randint(1, 4)):
        asks = not quiet and draw.random() < 0.25
        steps.append(
            {
                "do": [["preempt", "/"]] if asks else [],
                **({"pre": "preempted"} if draw.random() < 0.4 else {}),
                "ret": draw.choice(["done", "again"]) if number < 2 else "done",
            }
        )
    steps[-1]["ret"] = "done"
    return {"type": "leaf", "outcomes": ["done", "again", "preempted"], "steps": steps}


def container(draw: random.Random, depth: int, quiet: bool) -> Json:
    """A container whose end comes: back it goes no more than a leaf asks for, twice.

    `quiet`: no leaf in it makes a request, as nobody knows how far the other branches are.
    """
    kind = draw.choice(["state_machine", "state_machine", "iterator", "concurrence"])
    outcomes = ["done", "again", "preempted"]
    if kind == "iterator":
        child = {"label": "X", "node": node(draw, depth - 1, quiet)}
        return {
            "type": kind,
            "outcomes": outcomes,
            "it": list(range(draw.randint(0, 3))),
            "loop": draw.choice([["done"], ["done", "again"], ["done", "preempted"]]),
            "exhausted": "done",
            "child": child,
        }
    if kind == "concurrence":
        children = [
            {"label": label, "node": node(draw, depth - 1, True)}
            for label in "VW"[: draw.randint(1, 2)]
        ]
        ended = [["preempted", {children[0]["label"]: "preempted"}]]
        return {
            "type": kind,
            "outcomes": ["done", "preempted"],
            "default": "done",
            "map": ended,
            "children": children,
        }
    return machine(draw, depth, quiet)


def machine(draw: random.Random, depth: int, quiet: bool) -> Json:
    labels = "ABC"[: draw.randint(1, 3)]
    states = []
    for at, label in enumerate(labels):
        inner = node(draw, depth - 1, quiet)
        later = [*labels[at + 1 :], "done"]
        targets = {"done": draw.choice(later), "preempted": draw.choice([*later, "preempted"])}
        if "again" in inner["outcomes"]:
            single = inner["type"] == "leaf"
            targets["again"] = draw.choice([*labels, "again"] if single else [*later, "again"])
        states.append({"label": label, "node": inner, "transitions": targets})
    outcomes = ["done", "again", "preempted"]
    return {"type": "state_machine", "outcomes": outcomes, "states": states}


def node(draw: random.Random, depth: int, quiet: bool) -> Json:
    deeper = depth > 0 and draw.random() < 0.6
    return container(draw, depth, quiet) if deeper else leaf(draw, quiet)


def cases(seed: int, count: int) -> list[Json]:
    draw = random.Random(seed)
    return [
        {
            "id": f"r{number}",
            "machine": machine(draw, DEPTH, False),
            "runs": RUNS,
            "preempt": True,
            "preempt_before": draw.random() < 0.2,
        }
        for number in range(count)
    ]


def differing(seed: int, count: int, compiler: Compiler, folder: Path) -> list[str]:
    """Machines that do something else when compiled."""
    drawn = cases(seed, count)
    parts = [part(case, f"r{number}") for number, case in enumerate(drawn)]
    assert all(isinstance(each, Part) for each in parts), parts
    runs = replay([each for each in parts if isinstance(each, Part)], compiler, folder)
    return [
        case["id"]
        for case in drawn
        if [told(case, ran) for ran in runs[case["id"]]] != recorded.replay(case)
    ]


def test_requests_reach_the_same_states(tmp_path: Path) -> None:
    assert differing(1, MACHINES, last_with(), tmp_path) == []


def test_machines_are_of_use() -> None:
    """In many a state is asked that keeps a request: it is asked, and its machine was not."""
    asked = [
        event
        for case in cases(1, MACHINES)
        for run in recorded.replay(case)
        for event in run["events"]
        if isinstance(event, list) and event[0] == "+" and event[-1] == "P"
    ]
    assert len(asked) > MACHINES
