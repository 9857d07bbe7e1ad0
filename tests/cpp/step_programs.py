"""Paths of many machines in one program of stepped C++, and what the interpreter does on them."""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from smachac.diagnostics.diagnostic import has_errors
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run
from smachac.interpreter.scenario import Scenario, ScenarioStep, scenario_behaviour
from smachac.interpreter.userdata import Userdata
from smachac.ir.nodes import Concurrence, Leaf, Machine
from smachac.ir.traversal import outcome_names, walk
from smachac.ir.types import Bounds
from smachac.targets.cpp.plan import plan
from smachac.verify.generate import PathGenerator
from smachac.verify.paths import Path
from smachac.verify.players.cpp import DONE, _event
from smachac.verify.players.cpp_step_program import StepProgram, program_text
from smachac.verify.python_values import with_samples
from smachac.verify.test_case import TestCase, compare_traces, expected_trace, test_cases

MOST = 40
"""The most paths of one machine."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Played:
    """A machine, its program, and the paths that the program plays."""

    machine: Machine
    program: StepProgram
    paths: Sequence[Path]
    cases: Sequence[TestCase]


def played(
    machine: Machine, name: str, bounds: Bounds, paths: Sequence[Path] | None = None
) -> Played | None:
    """A machine with given paths, or those of `verify`; None where it cannot be stepped."""
    machine, samples = with_samples(machine)
    planned = plan(machine, bounds)
    if planned.report or has_errors(StepProgram(planned, ()).refused()):
        return None
    live: frozenset[str] = frozenset()
    if paths is None:
        generator = PathGenerator(machine, most=MOST)
        paths = [*generator.paths()]
        live = generator.runner.live
    cases = test_cases(machine, paths, live, samples)
    program = StepProgram(planned, cases, name)
    return Played(machine=machine, program=program, paths=paths, cases=cases)


VISITS = 20
"""The steps of each leaf of a random path, and the most visits of leaves."""


def random_path(machine: Machine, seed: int) -> Path | None:
    """A path on which leaves end with random outcomes and write random values, by the first letter
    of the names of keys; None if it has too many visits, or ends with an outcome that leads
    nowhere: a stepped machine reports the error without the exit before it. Without concurrences it
    also has errors and requests to stop: with them the order of branches would matter."""
    drawn = random.Random(seed)
    apart = not any(isinstance(node, Concurrence) for _, node in walk(machine.root))
    steps = {
        path: tuple(_random_step(leaf, drawn, apart=apart) for _ in range(VISITS))
        for path, leaf in walk(machine.root)
        if isinstance(leaf, Leaf)
    }
    visited = Counter[str]()

    def behave(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
        visited[path] += 1
        return scripted(path, leaf, visit, userdata)

    scripted = scenario_behaviour(Scenario(steps=steps), machine, builtin_behaviour())
    result = run(machine, behave, schedule=(), max_steps=4 * VISITS)
    visits = visited.total()
    left_out = ("no-end", "no-transition")
    if visits > VISITS or (result.error is not None and result.error.kind in left_out):
        return None
    scenario = Scenario(steps={path: steps[path][: visited[path]] for path in visited})
    return Path(kind="random", scenario=scenario, live=False, ends=True, visits=visits)


def _random_step(leaf: Leaf, drawn: random.Random, *, apart: bool) -> ScenarioStep:
    values = {"i": drawn.randrange(-9, 9), "l": [1, drawn.randrange(9)], "s": drawn.choice("abc")}
    return ScenarioStep(
        outcome=drawn.choice(outcome_names(leaf)),
        writes=tuple((key.name, values[key.name[0]]) for key in leaf.outputs),
        error="broken" if apart and drawn.random() < 0.02 else "",
        stop=apart and drawn.random() < 0.1,
    )


def text(machines: Sequence[Played], output: str) -> str:
    """The program of machines."""
    return program_text([machine.program for machine in machines], output)


def disagreements(machines: Sequence[Played], printed: str) -> Iterator[str]:
    """The machines whose traces are not those of the interpreter."""
    traces = [
        [event for line in part.splitlines() if (event := _event(line)) is not None]
        for part in printed.split(f"{DONE}\n")[:-1]
    ]
    assert len(traces) == sum(len(machine.paths) for machine in machines)
    found = iter(traces)
    for machine in machines:
        for path, case in zip(machine.paths, machine.cases, strict=True):
            expected = expected_trace(machine.machine, path.scenario, case)
            difference = compare_traces(expected, next(found))
            if difference is not None:
                yield f"{machine.program.name}: {difference}"
