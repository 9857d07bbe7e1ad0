"""The data flow against the recorded runs: a key that is always set is set in every run, and an
unreachable state is never entered."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from dataclasses import replace
from typing import Any, cast

import pytest

from smachac.analysis.def_use import key_status
from smachac.analysis.definite_assignment import data_flow
from smachac.interpreter.result import Event
from smachac.ir.nodes import Leaf, Machine, Node, StateMachine
from smachac.ir.traversal import containers, outcome_names
from tests.conformance_ir.ir_vectors import Replay, leaves_of, machine_of
from tests.conformance_ir.test_ir_vectors import CASES, RUN
from tests.support.examples import every

Json = Any


def endings(step: Json) -> Iterator[tuple[str, frozenset[str]]]:
    """The outcomes that a step of a recorded leaf can have, and the keys it has set by then."""
    sets = frozenset(operation[1] for operation in step.get("do", []) if operation[0] == "set")
    result = step.get("ret")
    results = [result["then"], result["else"]] if isinstance(result, dict) else [result]
    for outcome in (*results, step.get("pre")):
        if isinstance(outcome, str):
            yield outcome, sets


def with_writes(machine: Machine, leaves: dict[str, Json]) -> Machine:
    """The machine with what its leaves write on each outcome, as an interface would say it."""

    def told(node: Node, path: str) -> Node:
        if not isinstance(node, Leaf):
            children = tuple(told(child, f"{path}/{child.name}") for child in node.children)
            return replace(node, children=children)
        known = [ending for step in leaves[path]["steps"] for ending in endings(step)]
        outputs = {key.name for key in node.outputs}
        writes = []
        for outcome in outcome_names(node):
            sets = [keys for name, keys in known if name == outcome]
            sure = outputs.intersection(*sets) if sets else set()
            writes.append((outcome, tuple(sorted(sure))))
        return replace(node, writes=(*writes, ("-", tuple(sorted(outputs)))))

    root = told(machine.root, "")
    # The interpreter does not mind a root that is another container.
    return replace(machine, root=cast(StateMachine, root))


class Watched(Replay):
    """A recorded run that looks at each entry whether what was said is so."""

    def __init__(self, case: Json) -> None:
        super().__init__(case)
        machine = with_writes(machine_of(case), leaves_of(case))
        self.flow = data_flow(machine)
        given = {*case.get("userdata", {}), *case.get("parent", {})}
        self.judged = 0
        self.wrong: list[tuple[str, str]] = []
        lacking = {key.name for key in machine.root.inputs} - given
        names = {
            name
            for _, node in containers(machine.root)
            for item in (node, *node.children)
            for key in (*item.inputs, *item.outputs)
            for name in (key.name, *(remap.to for remap in item.remaps))
        }
        self.always: dict[str, list[str]] = {
            f"{path}/{child.name}": [
                key
                for key in sorted(names)
                if key_status(self.flow, f"{path}/{child.name}", key) == "always"
            ]
            for path, node in containers(machine.root)
            for child in node.children
            if not lacking
        }

    def observe(self, event: Event) -> None:
        super().observe(event)
        path = event["path"]
        if event["event"] == "enter":
            if path not in self.flow.entered:
                self.wrong.append((path, "unreachable"))
            for key in self.always.get(path, ()):
                self.judged += 1
                if key not in self.interpreter._scopes[path.rpartition("/")[0]]:
                    self.wrong.append((path, key))


@pytest.mark.parametrize("name", every(4, RUN))
def test_what_is_always_set_is_there(name: str) -> None:
    case = CASES[name]
    watched = Watched(case)
    parent = copy.deepcopy(case["parent"]) if "parent" in case else None
    for _ in range(case.get("runs", 1)):
        watched.run(parent)
    assert watched.wrong == []


def test_the_recorded_machines_have_much_that_is_always_set() -> None:
    judged = 0
    for name in RUN:
        watched = Watched(CASES[name])
        watched.run(copy.deepcopy(CASES[name].get("parent")))
        judged += watched.judged
        if judged > 500:
            return
    pytest.fail(f"only {judged} keys are judged")
