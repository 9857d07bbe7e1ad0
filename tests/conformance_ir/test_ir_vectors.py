"""The interpreter and generated Python against the recorded runs of SMACH.

Compared are the outcome or the kind of error, the userdata of every container, and the actions of
each leaf in their order; for generated code also the arguments of container callbacks. Machines
that the graph cannot express and deliberate deviations are listed with the reason.
"""

from __future__ import annotations

import copy
import json
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from smachac.checks import check_machine
from smachac.diagnostics.diagnostic import has_errors
from smachac.interpreter.result import Event, InterpreterResult
from tests.conformance_ir import generated_vectors
from tests.conformance_ir.ir_vectors import Replay, machine_of, nodes_of
from tests.support.examples import every

Json = Any

CASES: dict[str, Json] = {
    case["id"]: case
    for path in sorted((Path(__file__).parents[1] / "conformance").glob("vectors-*.json"))
    for case in json.loads(path.read_text("utf-8"))["cases"]
}

KINDS = {
    "missing-key": "missing_key",
    "undeclared-read": "undeclared_read",
    "behaviour": "user_exception",
    "undeclared-outcome": "invalid_transition",
    "no-outcome": "other",
    "no-transition": "invalid_transition",
    "no-target": "invalid_transition",
    "no-items": "other",
    "no-state": "other",
}
"""The kinds of errors in the words of the recordings."""

REFUSED = "refused when built"
INCONSISTENT = "does not run, as a transition leads nowhere"
CALLBACKS = "callbacks of a concurrence that are more than `join: any`"
WAITS = "branches that wait for each other"
CTRL_C = "an exception that is to stop the program"


def left_out(case: Json) -> str | None:
    """Why the graph cannot express a case."""
    if "build" in case["expect"]:
        return REFUSED
    nodes = dict(nodes_of(case))
    for path in case["expect"].get("inconsistent", []):
        if nodes[path.removesuffix("/")]["type"] in ("state_machine", "sequence"):
            return INCONSISTENT
    for node in nodes.values():
        if not all(map(_expressible, [*node.get("term_cb", []), *node.get("outcome_cb", [])])):
            return CALLBACKS
        for step in node.get("steps", []):
            if any(operation[0].startswith("wait") for operation in step.get("do", [])):
                return WAITS
            if step.get("raise") == "KeyboardInterrupt":
                return CTRL_C
    return None


def _expressible(rule: Json) -> bool:
    """Whether a concurrence's callback rule has no effect, or is `join: any` or one more rule."""
    if rule["ret"] is True:
        return "when" not in rule
    if isinstance(rule["ret"], str):
        return bool(rule.get("when"))
    return not isinstance(rule["ret"], dict | list)


EARLY = "no lost request: children are told before they start"

DEVIATIONS: dict[str, tuple[str, list[tuple[str | None, str | None]]]] = {
    "h060-keys-under-remap": ("keys() lists what can be read", [("done", None)]),
    "h089-concurrence-empty": ("no hang: an error", [(None, "other")]),
    "h097-concurrence-child-none": ("no hang: an error", [(None, "other")]),
    "h134-preempt-iterator-before": (EARLY, [("preempted", None), ("exhausted", None)]),
    "h137-preempt-concurrence-before": (EARLY, [("no", None)]),
    "h138-preempt-concurrence-in-machine": (EARLY, [("no", None)]),
}
"""Case -> why interpreter and generated code do something else on purpose, and for each run
(outcome, kind of error)."""

RUN = [name for name, case in CASES.items() if left_out(case) is None]
AS_RECORDED = [name for name in RUN if name not in DEVIATIONS]


def replay(case: Json) -> list[Json]:
    """What the interpreter does: for each run what is compared."""
    replayed = Replay(case)
    parent = copy.deepcopy(case["parent"]) if "parent" in case else None
    runs = []
    for _ in range(case.get("runs", 1)):
        result, events = replayed.run(parent)
        runs.append(_told(case, result, events, copy.deepcopy(parent)))
    return runs


def _told(case: Json, result: InterpreterResult, events: list[Event], parent: Json) -> Json:
    concurrences = {path for path, node in nodes_of(case) if node["type"] == "concurrence"}
    leaves = {path for path, node in nodes_of(case) if node["type"] == "leaf"}
    told = {
        "outcome": result.outcome,
        "category": _category(result),
        "userdata": result.userdata,
        "scopes": {path: scope for path, scope in result.scopes.items() if path},
        "events": _nested(events, concurrences, leaves if case.get("preempt") else set()),
    }
    return told if parent is None else {**told, "parent": parent}


def _category(result: InterpreterResult) -> str | None:
    if result.error is not None:
        return KINDS[result.error.kind]
    return "no_outcome" if result.outcome is None else None


def _nested(events: list[Event], concurrences: set[str], leaves: set[str]) -> Json:
    """The events of leaves as the recordings have them: branches apart, sorted by name."""
    found: list[Json] = []
    at = 0
    while at < len(events):
        event = events[at]
        at += 1
        name, path = event["event"], event["path"]
        if name in "+-!":
            found.append([name, path, *event["rest"]])
        elif name == "preempt" and path in leaves:
            found.append(["P", path])
        elif name in ("start", "enter") and path in concurrences:
            closing = ("finish", path) if name == "start" else ("exit", path)
            end = at
            while end < len(events) and (events[end]["event"], events[end]["path"]) != closing:
                end += 1
            branches: dict[str, list[Event]] = {}
            for inner in events[at:end]:
                if inner["path"].startswith(f"{path}/"):
                    label = inner["path"].removeprefix(f"{path}/").partition("/")[0]
                    branches.setdefault(label, []).append(inner)
            found.append({b: _nested(branches[b], concurrences, leaves) for b in sorted(branches)})
            at = end
    return _without_empty(found)


def _without_empty(events: Json) -> Json:
    kept = []
    for event in events:
        if isinstance(event, dict):
            event = {label: inner for label, inner in event.items() if inner}
        if event:
            kept.append(event)
    return kept


def expected(case: Json, recorded: Json) -> list[Json]:
    """What was recorded, in the same form."""
    return [
        {
            "outcome": run.get("outcome"),
            "category": run.get("category"),
            "userdata": run["userdata"],
            "scopes": run.get("scopes", {}),
            "events": _recorded(run["events"]),
            **({"parent": run["parent"]} if "parent" in run else {}),
        }
        for run in recorded["runs"]
    ]


def _recorded(events: Json) -> Json:
    found: list[Json] = []
    for event in events:
        if event[0] in "+-P":
            found.append(event)
        elif event[0] == "!":
            found.append(event[:2])
        elif event[0] == "|":
            found.append({label: _recorded(inner) for label, inner in sorted(event[2].items())})
    return _without_empty(found)


@pytest.mark.parametrize("name", AS_RECORDED)
def test_interpreter_does_what_smach_did(name: str) -> None:
    case = CASES[name]
    assert replay(case) == expected(case, case["expect"])


@pytest.mark.parametrize("runtime", generated_vectors.RUNTIMES)
@pytest.mark.parametrize("name", every(4, AS_RECORDED))
def test_generated_code_does_what_smach_did(name: str, runtime: str) -> None:
    case = CASES[name]
    branches = [case["expect"], case["expect_noetic"]] if "expect_noetic" in case else []
    told = generated_vectors.replay(case, runtime)
    assert told in branches if runtime == "smach" and branches else told == case["expect"]


@pytest.mark.parametrize("name", DEVIATIONS)
def test_both_deviate_as_stated(name: str) -> None:
    case = CASES[name]
    why, instead = DEVIATIONS[name]
    assert {"quirk", "hang", "preempt"} & set(case["tags"])
    generated = expected(case, generated_vectors.replay(case))
    replayed = replay(case)
    assert [(run["outcome"], run["category"]) for run in replayed] == instead, why
    assert replayed == generated
    assert replayed != expected(case, case["expect"])


def test_what_the_graph_cannot_express_is_known() -> None:
    recorded = [case for name, case in CASES.items() if name.startswith(("h", "A20-"))]
    reasons = Counter(left_out(case) for case in recorded)
    assert reasons == {
        None: 380,
        REFUSED: 26,
        INCONSISTENT: 22,
        CALLBACKS: 7,
        WAITS: 4,
        CTRL_C: 1,
    }


NO_ERROR = {
    "h087-concurrence-none-default": "no default outcome in a script is told by its reader",
}
"""Machines that SMACH refuses to build, without a fault that the graph shows."""


@pytest.mark.parametrize(
    "name", [name for name in CASES if left_out(CASES[name]) in (REFUSED, INCONSISTENT)]
)
def test_rules_find_what_smach_refuses(name: str) -> None:
    machine = machine_of(CASES[name])
    report = check_machine(replace(machine, root=replace(machine.root, name="sm")))
    assert has_errors(report) == (name not in NO_ERROR)
