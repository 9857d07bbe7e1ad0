"""Machines on another executive give the traces of the interpreter: recorded and random ones.

A request to stop reaches a state of another executive at another moment between two of its events:
the events `preempt` are left out.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from hypothesis import HealthCheck, given, seed, settings

from smachac.driver import analyse_script
from smachac.frontend.files import disk_library
from smachac.frontend.loader import Library, memory_library
from smachac.interpreter.userdata import Userdata
from smachac.ir.nodes import Leaf, Machine
from smachac.runtime.tracing.compare import compare
from tests.conformance_ir import generated_vectors
from tests.conformance_ir.ir_vectors import Replay, leaves_of, machine_of
from tests.conformance_ir.test_ir_vectors import CASES
from tests.pipeline.test_differential import LIBRARY, of_interpreter
from tests.scxml.test_recorded import _in_machine
from tests.strategies.full_machines import busy_machines

Json = Any
Events = list[Json]

ROOT = Path(__file__).parents[2]

SCRIPTS = [
    *sorted(ROOT.glob("examples/0[1-7]*/main.yml")),
    *(ROOT / "tests" / "cases" / name / "main.yml"
      for name in ("containers", "deep_nesting", "on_error", "sugar", "concurrence_any")),
]  # fmt: skip

TEMPLATE = generated_vectors.TEMPLATE.split("{% block class_defs %}")[0].replace(
    "from tests.conformance.vector_leaf import Follower",
    "from tests.support.recorded_leaf import Vector",
)

RECORDED = memory_library(
    {"templates/Vector.yml": generated_vectors.INTERFACE, "templates/Vector.tpl.py": TEMPLATE},
    disk_library(Path("main.yml"), []),
)
"""The library of recorded machines: `Vector` is the type of their leaves."""

REFUSED = "the executive refuses it: a container without states"
UNDECLARED = "a state ends with an outcome that it does not declare: there is no event for it"
LEAVES_MACHINE = "the machine has no transition for an outcome: there is no event for it"

KINDS: Mapping[str, str] = {
    "undeclared-outcome": UNDECLARED,
    "no-outcome": UNDECLARED,
    "no-transition": LEAVES_MACHINE,
}
"""Why the events around the end of a failed run differ."""

SMACH_GOES_ON = ("h082-concurrence-unregistered-child-outcome", "A20-226")
"""Branches of a concurrence that end with an undeclared outcome: an error on other executives."""


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


def recorded_difference(name: str, played: Callable[[Machine, Json], Events | None]) -> str | None:
    """Why a recorded case differs; None if the traces are equal.

    `played(machine, case)` are the events of the executive; None where it refuses the machine,
    whose outermost container is `sm`.
    """
    case = _in_machine(CASES[name])
    replayed = _Reading(case)
    result, ours = replayed.run(None)
    machine = machine_of(case)
    root: Any = generated_vectors._with_scripts(machine.root, "", leaves_of(case))
    events = played(replace(machine, root=replace(root, name="sm")), case)
    if events is None:
        return REFUSED
    theirs = [_renamed(event) for event in events]
    found = compare(without_requests(ours), without_requests(theirs))
    if found is None:
        return None
    if name in SMACH_GOES_ON:
        return UNDECLARED
    return KINDS.get(result.error.kind, found) if result.error is not None else found


def _renamed(event: Json) -> Json:
    """An event with the paths of a recording, which do not start with the name of the machine."""
    names = {"path", "to"} & event.keys()
    return {**event, **{name: event[name].removeprefix("sm") for name in names}}


def without_requests(events: Events) -> Events:
    return [event for event in events if event["event"] != "preempt"]


def compare_random_machines(
    number: int,
    files_of: Callable[[Machine, Library], dict[str, str] | None],
    trace: Callable[[dict[str, str], tuple[str, int]], Events],
) -> None:
    """40 random machines with every construct, in one visit of which a request to stop comes."""
    compared = 0

    @seed(number)
    @settings(
        max_examples=40, database=None, deadline=None, suppress_health_check=list(HealthCheck)
    )
    @given(busy_machines())
    def check(given: tuple[Machine, tuple[str, int]]) -> None:
        nonlocal compared
        machine, asked = given
        ours = of_interpreter(machine, asked)
        if ours is None:
            return
        files = files_of(machine, LIBRARY)
        assert files is not None
        theirs = trace(files, asked)
        assert compare(without_requests(ours), without_requests(theirs)) is None
        compared += 1

    check()
    assert compared > 20


def compare_script(
    script: Path,
    files_of: Callable[[Machine, Library], dict[str, str] | None],
    trace: Callable[[dict[str, str], tuple[str, int]], Events],
) -> None:
    """The program of a script, which runs its own states."""
    machine = analyse_script(script).checked
    assert machine is not None
    ours = of_interpreter(machine)
    assert ours is not None
    files = files_of(machine, disk_library(script, []))
    assert files is not None
    assert compare(without_requests(ours), without_requests(trace(files, ("", 0)))) is None
