"""The recorded machines of SMACH on SCION: what their leaves do is replayed, and the traces are
those of the interpreter, with the inputs that each leaf finds."""

from __future__ import annotations

import copy
from collections import Counter
from typing import Any

import pytest

from smachac.interpreter.userdata import Userdata
from smachac.ir.nodes import Leaf
from smachac.runtime.tracing.compare import compare
from smachac.targets.scxml.plan import Plan
from tests.conformance_ir.ir_vectors import Replay, machine_of
from tests.conformance_ir.test_ir_vectors import CASES, RUN
from tests.scxml.scion import played, text_of

pytestmark = pytest.mark.browser

Json = Any

ALIASES = "a leaf changes a shared list"
NO_OUTCOME = "a leaf ends with an outcome that it does not declare, or with none"
TWICE = "a leaf writes a key twice in one visit: its answer has the last value only"
NO_STATES = "a container without states"


class _Recorded(Replay):
    """A case on the interpreter, with the steps that its leaves performed by path."""

    def __init__(self, case: Json) -> None:
        super().__init__(case)
        self.rows: dict[str, list[Json]] = {path: [] for path in self.leaves}
        self.reads: dict[str, list[str]] = {}
        self.left_out = ""

    def behave(self, path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
        node = self.leaves[path]
        keys = self.reads[path] = [*node.get("in", []), *node.get("io", [])]
        for key in keys:
            if key in userdata and userdata[key] is not None:
                value = copy.deepcopy(userdata[key])
                self.events.append({"event": "read", "path": path, "key": key, "value": value})
        step = node["steps"][min(visit, len(node["steps"])) - 1]
        asked, before = userdata.preempted, len(self.events)
        stops = [op[1] for op in step.get("do", []) if op[0] == "preempt"]
        if any(op[0] == "push" for op in step.get("do", [])):
            self.left_out = ALIASES
        assert all(stop == "/" for stop in stops)
        row = {"exact": True, "stop": bool(stops), "outcome": "", "error": ""}
        self.rows[path].append(row)
        try:
            outcome = row["outcome"] = self._perform(step, userdata)
        except Exception as error:
            row["error"] = str(error) or "raised"
            raise
        finally:
            new = self.events[before:]
            keys_written = [item["key"] for item in new if item["event"] == "write"]
            if len(set(keys_written)) < len(keys_written):
                self.left_out = TWICE
            row["writes"] = {item["key"]: item["value"] for item in new if item["event"] == "write"}
            row["answered"] = (asked or bool(stops)) and not userdata.preempted
        if outcome not in {item.name for item in leaf.outcomes}:
            self.left_out = NO_OUTCOME
        assert outcome != "preempted" or row["answered"] or not userdata.preempted
        return str(outcome)


def _in_machine(case: Json) -> Json:
    """The case with a state machine outside: a script has no other outermost container."""
    node = case["machine"]
    if node["type"] in ("state_machine", "sequence"):
        return case
    inner = {**node, "preset": {**node.get("preset", {}), **case.get("userdata", {})}}
    states = [{"label": "M", "node": inner}]
    outer = {"type": "state_machine", "outcomes": node["outcomes"], "states": states}
    return {**case, "machine": outer, "userdata": {}}


def recorded(name: str) -> tuple[str, Json, Json] | str:
    """The document, the case for SCION and the expected trace; or why SCXML does not run it."""
    case = _in_machine(CASES[name])
    replayed = _Recorded(case)
    result, events = replayed.run(None)
    assert result.error is None or result.error.kind != "no-end"
    if replayed.left_out:
        return replayed.left_out
    machine = machine_of(case)
    text = text_of(machine)
    if text is None:
        return NO_STATES
    ids = Plan(machine, [], traced=False).ids
    played = {
        "inputs": case.get("userdata", {}),
        "stopped": bool(case.get("preempt_before")),
        "most": 1000,
        "paths": {ids[path]: path for path in replayed.rows},
        "rows": {ids[path]: row for path, row in replayed.rows.items()},
        "reads": {ids[path]: keys for path, keys in replayed.reads.items()},
    }
    return text, played, [event for event in events if event["event"] != "preempt"]


def test_machines_do_what_the_interpreter_does() -> None:
    texts: list[str] = []
    cases: list[Json] = []
    expected: list[tuple[str, Json]] = []
    left_out: Counter[str] = Counter()
    for name in RUN:
        found = recorded(name)
        if isinstance(found, str):
            left_out[found] += 1
            continue
        text, case, events = found
        texts.append(text)
        cases.append({**case, "document": len(cases)})
        expected.append((name, events))
    differing = {}
    traces = played(texts, cases, scripted=True)
    for (name, ours), theirs in zip(expected, traces, strict=True):
        difference = compare(ours, theirs)
        if difference is not None:
            differing[name] = difference
    assert differing == {}
    assert len(expected) > 300
    assert left_out == {NO_OUTCOME: 18, NO_STATES: 2, ALIASES: 1, TWICE: 1}
