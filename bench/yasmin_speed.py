"""Transitions a second of a generated machine of six states on YASMIN, beside a hand-written one.

    python bench/yasmin_speed.py [TRANSITIONS]    # 60,000

Both run on the stand-in of the tests, in turn, and on YASMIN where it is installed: CPU time, the
least of five rounds. In each round of the six states a key is read three times and written once.
"""

from __future__ import annotations

import contextlib
import io
import logging
import sys
import time
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType
from typing import Any

import smachac.runtime.smach as smach
from smachac.diagnostics.source import Source
from smachac.driver import analyse, build
from smachac.frontend.files import disk_library
from smachac.frontend.loader import memory_library
from smachac.targets.yasmin import TARGET
from tests.yasmin import stand_in
from tests.yasmin.programs import loaded

LEFT = [0]
"""The number of calls of `Call` that are left."""

WORK: dict[str, tuple[list[str], list[str], list[str], Callable[[Any], str]]] = {
    "Call": (["succeeded", "aborted"], [], [], lambda keys: _counted()),
    "Drive": (
        ["succeeded", "aborted", "preempted"],
        ["place"],
        [],
        lambda keys: "succeeded" if keys["place"] else "aborted",
    ),
    "Look": (["found", "nothing"], [], ["box"], lambda keys: _found(keys)),
    "Grasp": (
        ["succeeded", "aborted"],
        ["pose"],
        [],
        lambda keys: "succeeded" if keys["pose"] else "aborted",
    ),
}
"""The states: outcomes, inputs, outputs, and what they do with keys."""

STATES: dict[str, tuple[str, dict[str, str]]] = {
    "CALL": ("Call", {"succeeded": "DRIVE", "aborted": "aborted"}),
    "DRIVE": ("Drive", {"succeeded": "LOOK", "aborted": "aborted", "preempted": "aborted"}),
    "LOOK": ("Look", {"found": "GRASP", "nothing": "CALL"}),
    "GRASP": ("Grasp", {"succeeded": "RETURN", "aborted": "LOOK"}),
    "RETURN": ("Drive", {"succeeded": "DROP", "aborted": "aborted", "preempted": "aborted"}),
    "DROP": ("Call", {"succeeded": "CALL", "aborted": "aborted"}),
}


def _counted() -> str:
    LEFT[0] -= 1
    return "succeeded" if LEFT[0] > 0 else "aborted"


def _found(keys: Any) -> str:
    keys["box"] = 1
    return "found"


def script() -> str:
    states = "".join(
        f"  - {name}: {{template: {kind}, transitions: {edges}"
        f"{', remapping: {pose: box}' if kind == 'Grasp' else ''}}}\n".replace("'", "")
        for name, (kind, edges) in STATES.items()
    )
    return f"name: six\noutcomes: [aborted]\nuserdata: {{place: shelf}}\nstates:\n{states}"


def files() -> dict[str, str]:
    """The generated files. The classes of the states are in the module `robot`."""
    templates, robot = {}, ModuleType("robot")
    sys.modules["robot"] = robot
    for name, (outcomes, inputs, outputs, work) in WORK.items():
        templates[f"templates/{name}.yml"] = (
            f"name: {name}\noutcomes: {{{', '.join(f'{one}: {{}}' for one in outcomes)}}}\n"
            f"input_keys: {inputs}\noutput_keys: {outputs}\ncode: {{python: 'robot:{name}'}}\n"
        )
        vars(robot)[name] = _smach_class(outcomes, inputs, outputs, work)
    library = memory_library(templates, disk_library(Path("main.yml"), []))
    checked = analyse(Source("main.yml", script()), library, []).checked
    assert checked is not None
    return build(checked, TARGET, library, [])


def _smach_class(
    outcomes: list[str], inputs: list[str], outputs: list[str], work: Callable[[Any], str]
) -> type:
    class State(smach.State):
        def __init__(self) -> None:
            smach.State.__init__(self, outcomes, inputs, outputs)

        def execute(self, userdata: Any) -> str:
            return work(userdata)

    return State


def hand_written(yasmin: Any) -> Callable[[], str]:
    """A run of the machine as a user of YASMIN writes it."""

    def state(outcomes: list[str], work: Callable[[Any], str]) -> Any:
        class State(yasmin.State):  # type: ignore[misc]
            def __init__(self) -> None:
                yasmin.State.__init__(self, outcomes)

            def execute(self, blackboard: Any) -> str:
                return work(blackboard)

        return State()

    machine = yasmin.StateMachine(["aborted"])
    for name, (kind, edges) in STATES.items():
        outcomes, _, _, work = WORK[kind]
        remapping = {"pose": "box"} if kind == "Grasp" else {}
        machine.add_state(name, state(outcomes, work), edges, remapping)
    blackboard = yasmin.Blackboard()
    blackboard["place"] = "shelf"
    return lambda: str(machine(blackboard))


def measure(name: str, yasmin: Any, count: int) -> None:
    least = [float("inf")] * 2
    with loaded(files(), yasmin) as module, contextlib.redirect_stdout(io.StringIO()):
        runs = (module.run().execute, hand_written(yasmin))
        for _ in range(5):
            for at, run in enumerate(runs):
                LEFT[0] = count // 3
                before = time.process_time()
                run()
                least[at] = min(least[at], time.process_time() - before)
    generated, written = (count / seconds for seconds in least)
    print(f"{name}: generated {generated:,.0f}/s, hand-written {written:,.0f}/s,"
          f" ratio {generated / written:.2f}")  # fmt: skip


if __name__ == "__main__":
    number = int(sys.argv[1]) if sys.argv[1:] else 60_000
    logging.disable(logging.CRITICAL)
    measure("stand-in", stand_in, number)
    if find_spec("yasmin") is not None:
        import yasmin

        yasmin.set_log_level(yasmin.LogLevel.ERROR)
        measure("YASMIN", yasmin, number)
