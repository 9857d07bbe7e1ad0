"""The recorded machines of SMACH on FlexBE: the traces are those of the interpreter, with the
inputs that each leaf finds."""

from __future__ import annotations

import contextlib
import copy
import logging
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from smachac.frontend.files import disk_library
from smachac.frontend.loader import memory_library
from smachac.interpreter.userdata import Userdata
from smachac.ir.nodes import Leaf
from smachac.runtime.tracing.compare import compare
from tests.conformance_ir import generated_vectors
from tests.conformance_ir.ir_vectors import Replay, leaves_of, machine_of
from tests.conformance_ir.test_ir_vectors import CASES, RUN
from tests.flexbe.programs import files_of, loaded, ready
from tests.scxml.test_recorded import _in_machine
from tests.support.examples import every
from tests.yasmin.recorded_leaf import PERFORMED

Json = Any

TEMPLATE = generated_vectors.TEMPLATE.split("{% block class_defs %}")[0].replace(
    "from tests.conformance.vector_leaf import Follower",
    "from tests.yasmin.recorded_leaf import Vector",
)

LIBRARY = memory_library(
    {"templates/Vector.yml": generated_vectors.INTERFACE, "templates/Vector.tpl.py": TEMPLATE},
    disk_library(Path("main.yml"), []),
)


class _Reading(Replay):
    """A case on the interpreter, with the inputs that its leaves find."""

    def behave(self, path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
        node = self.leaves[path]
        for key in [*node.get("in", []), *node.get("io", [])]:
            if key in userdata and userdata[key] is not None:
                value = copy.deepcopy(userdata[key])
                self.events.append({"event": "read", "path": path, "key": key, "value": value})
        step = node["steps"][min(visit, len(node["steps"])) - 1]
        outcome: str = self._perform(step, userdata)
        return outcome


def events_of_flexbe(case: Json) -> list[Json] | None:
    machine = machine_of(case)
    root: Any = generated_vectors._with_scripts(machine.root, "", leaves_of(case))
    root = replace(root, name="sm")
    files = files_of(replace(machine, root=root), LIBRARY)
    if files is None:
        return None
    events: list[Json] = []
    with loaded(files) as made:
        behavior = ready(made)
        machine = behavior._state_machine
        for key, value in case.get("userdata", {}).items():
            machine.userdata[key] = copy.deepcopy(value)
        PERFORMED.update(events=events, request=machine.request_preempt)
        machine.observe(events.append)
        if case.get("preempt_before"):
            machine.request_preempt()
        with contextlib.suppress(Exception):
            behavior.execute()
    return [{**event, "path": event["path"].removeprefix("sm")} for event in events]


def renamed(event: Json) -> Json:
    to = event.get("to")
    return event if to is None else {**event, "to": to.removeprefix("sm")}


@pytest.fixture(autouse=True)
def _no_log(silent_smach: None) -> None:
    logging.getLogger("flexbe").setLevel(logging.CRITICAL)


REFUSED = "FlexBE refuses it: a container without states"
UNDECLARED = "a state ends with an outcome that it does not declare: FlexBE has no event for it"
LEAVES_MACHINE = "the machine has no transition for an outcome: FlexBE has no event for it"

KINDS = {
    "undeclared-outcome": UNDECLARED,
    "no-outcome": UNDECLARED,
    "no-transition": LEAVES_MACHINE,
}
"""Why the events around the end of a failed run differ."""

SMACH_GOES_ON = ("h082-concurrence-unregistered-child-outcome", "A20-226")
"""Branches of a concurrence that end with an undeclared outcome: FlexBE raises an error."""


def difference(name: str) -> str | None:
    """Why a case differs; None if the traces are equal."""
    case = _in_machine(CASES[name])
    replayed = _Reading(case)
    result, ours = replayed.run(None)
    theirs = events_of_flexbe(case)
    if theirs is None:
        return REFUSED
    kinds = [[e for e in events if e["event"] != "preempt"] for events in (ours, theirs)]
    found = compare(kinds[0], map(renamed, kinds[1]))
    if found is None:
        return None
    if name in SMACH_GOES_ON:
        return UNDECLARED
    return KINDS.get(result.error.kind, found) if result.error is not None else found


PARTS = 8


@pytest.mark.parametrize("part", every(4, range(PARTS)))
def test_machines_do_what_the_interpreter_does(part: int) -> None:
    found = {name: difference(name) for name in RUN[part::PARTS]}
    reasons = Counter(found.values())
    assert set(reasons) <= {None, REFUSED, UNDECLARED, LEAVES_MACHINE}, found
    assert reasons[None] > 40
