"""Random machines with requests to stop at random moments, in the form of the recorded machines.

A leaf makes a request, answers one, or does neither. A request also comes before the start, and a
second one while the first is not answered, or after that.
"""

from __future__ import annotations

import random
from typing import Any

Json = Any

RUNS = 3
DEPTH = 3


def leaf(draw: random.Random, quiet: bool) -> Json:
    """A state that requests a stop of the machine, answers one, or does neither, as it is drawn."""
    steps = []
    for number in range(draw.randint(1, 4)):
        asks = 0 if quiet else draw.choice([0, 0, 0, 1, 2])
        steps.append(
            {
                "do": [["preempt", "/"]] * asks,
                **({"pre": "preempted"} if draw.random() < 0.4 else {}),
                "ret": draw.choice(["done", "again"]) if number < 2 else "done",
            }
        )
    steps[-1]["ret"] = "done"
    return {"type": "leaf", "outcomes": ["done", "again", "preempted"], "steps": steps}


def container(draw: random.Random, depth: int, quiet: bool) -> Json:
    """A container that comes to an end: a leaf leads back to it no more than twice.

    `quiet`: no leaf in it makes a request, because it is not determined how far other branches are.
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
            "sugar": draw.choice(["", "for_each", "retry"]),
        }
    if kind == "concurrence":
        labels = "VW"[: draw.randint(1, 2)]
        quiet = quiet or len(labels) > 1
        children = [{"label": label, "node": node(draw, depth - 1, quiet)} for label in labels]
        ended = [["preempted", {children[0]["label"]: "preempted"}]]
        return {
            "type": kind,
            "outcomes": ["done", "preempted"],
            "default": "done",
            "map": ended,
            "children": children,
            "sugar": draw.choice(["", "timeout"]),
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


def once(runs: list[Json]) -> list[Json]:
    """Runs, without requests to a leaf that has an unanswered one: a program may leave them out."""
    return [{**run, "events": _once(run["events"])} for run in runs]


def _once(events: Json) -> Json:
    kept: list[Json] = []
    flagged: set[str] = set()
    for event in events:
        if isinstance(event, dict):
            kept.append({label: _once(inner) for label, inner in event.items()})
            continue
        name, path = event[:2]
        if name == "P" and path in flagged:
            continue
        if name == "-":
            flagged.discard(path)
        elif event[0] == "P" or event[-1] == "P":  # a request, or a start with a request
            flagged.add(path)
        kept.append(event)
    return kept
