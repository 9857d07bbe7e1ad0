"""Runs of a machine whose leaves do at random what their interfaces allow, and what they show."""

from __future__ import annotations

import random
import re
from collections.abc import Iterator

from smachac.diagnostics.diagnostic import Report, Severity
from smachac.interpreter.interpreter import run
from smachac.interpreter.result import Behaviour, Event, InterpreterResult
from smachac.interpreter.userdata import Userdata
from smachac.ir.leaf import default_outcome, variable
from smachac.ir.nodes import Leaf, Machine, Struct
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import containers, outcome_names, walk

MOST_STEPS = 150
VALUE = [1, 2]
"""What leaves write: something that an iterator can go through."""


def anything(seed: int) -> Behaviour:
    """A leaf reads its inputs, draws an outcome, and writes what comes with that.

    It says `preempted` only when it is asked to stop, and then may also finish.
    """
    draw = random.Random(f"stand-in/{seed}")

    def behave(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
        for key in reads(leaf):
            userdata[key]
        own = [name for name in outcome_names(leaf) if name != PREEMPTED]
        if (
            PREEMPTED in outcome_names(leaf)
            and userdata.preempted
            and (not own or draw.random() < 0.7)
        ):
            userdata.service_preempt()
            return PREEMPTED
        outcome = draw.choice(own) if own else default_outcome(leaf)
        for key in writes(leaf, outcome, draw):
            userdata[key] = list(VALUE)
        return outcome

    return behave


def reads(leaf: Leaf) -> Iterator[str]:
    """The inputs that have to be there; functions say themselves which keys those are."""
    functions = variable(leaf, "callbacks")
    optional = {key.name for key in leaf.inputs if key.type.name == "optional"}
    named = [key.name for key in leaf.inputs]
    if isinstance(functions, Struct):
        named = re.findall(r"\bud\.(\w+)", str(functions))
    return (key for key in named if key not in optional)


def writes(leaf: Leaf, outcome: str, draw: random.Random) -> list[str]:
    """The outputs that come with an outcome; a ScriptedState's are those of one of its steps."""
    outputs = [key.name for key in leaf.outputs]
    if leaf.type == "ScriptedState":
        steps = list(_steps(leaf))
        ever = {key for _, keys in steps for key in keys}
        fitting = [keys for name, keys in steps if name == outcome]
        if not fitting:
            return outputs
        return [key for key in outputs if key not in ever] + sorted(draw.choice(fitting))
    if leaf.type == "CallbacksState":
        functions = variable(leaf, "callbacks")
        return [key for key, _ in functions.entries] if isinstance(functions, Struct) else []
    told = {key for _, keys in leaf.writes for key in keys}
    here = {key for name, keys in leaf.writes for key in keys if name == outcome}
    return [key for key in outputs if key not in told or key in here]


def _steps(leaf: Leaf) -> Iterator[tuple[object, set[str]]]:
    """The outcome and the keys of each step."""
    data = variable(leaf, "steps")
    for step in data if isinstance(data, tuple) else ():
        told = dict(step.entries) if isinstance(step, Struct) else {}
        sets = told.get("set")
        keys = {key for key, _ in sets.entries} if isinstance(sets, Struct) else set()
        yield told.get("outcome", default_outcome(leaf)), keys


def runs(machine: Machine, count: int) -> Iterator[tuple[InterpreterResult, list[Event]]]:
    """So many runs with their events; in every third one somebody asks the machine to stop."""
    for seed in range(count):
        events: list[Event] = []
        asked = {seed % 7} if seed % 3 == 2 else set()
        yield (
            run(
                machine,
                anything(seed),
                events.append,
                seed=seed,
                max_steps=MOST_STEPS,
                preempt_at=asked,
            ),
            events,
        )


def missing(machine: Machine, count: int) -> set[str]:
    """The states that found a key missing in so many runs."""
    found = set()
    for result, _ in runs(machine, count):
        if result.error is not None and result.error.kind in ("missing-key", "no-items"):
            found.add(result.error.path)
    return found


def contradictions(machine: Machine, report: Report, events: list[Event]) -> Iterator[str]:
    """What a run shows of findings that say what can never happen.

    SM201: the state is entered. SM301 and SM303, as errors: the state ends, though it must have
    found a key missing; a container may end before the state in it reads. SM202: its container ends
    after it was entered. Of two states of one name (SM106) no event says which it is of. A state
    that catches its exceptions ends in spite of a missing key, a container in spite of a trap.
    """
    if any(item.code == "SM106" for item in report):
        return
    around = {path for path, _ in containers(machine.root)}
    entered = {event["path"] for event in events if event["event"] == "enter"}
    catching = {(path, node.catches) for path, node in walk(machine.root) if node.catches}
    events = [event for event in events if (event["path"], event.get("outcome")) not in catching]
    ended = {event["path"] for event in events if event["event"] == "exit"}
    for item in report:
        path = item.finding.node or ""
        match item.code:
            case "SM201" if path in entered:
                yield f"SM201: {path} is entered"
            case "SM301" | "SM303" if path in ended - around:
                if item.severity is not Severity.ERROR:
                    continue
                yield f"{item.code}: {path} ends"
            case "SM202" if ends_after(events, path):
                yield f"SM202: what {path} is in ends"


def ends_after(events: list[Event], path: str) -> bool:
    """Whether the container of a state ends in the visit in which the state was entered."""
    around = path.rpartition("/")[0]
    inside = False
    for event in events:
        if event["path"] == path and event["event"] == "enter":
            inside = True
        if event["path"] == around and event["event"] == "enter":
            inside = False
        if event["path"] == around and event["event"] in ("exit", "finish") and inside:
            return True
    return False
