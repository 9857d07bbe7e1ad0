"""The runs of a sweep: what all of them have in common, and the result of each as plain data."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

from smachac.diagnostics.diagnostic import has_errors
from smachac.diagnostics.source import Source
from smachac.driver import analyse_script, compile_script
from smachac.frontend.files import module_folders
from smachac.frontend.text.yaml_tree import parse
from smachac.interpreter.interpreter import MAX_STEPS
from smachac.interpreter.scenario import Scenario
from smachac.ir.nodes import Checked, Leaf
from smachac.ir.written import written
from smachac.records import dataclass, field
from smachac.robots.faults import Fault
from smachac.runtime.tracing.writer import with_shown_paths
from smachac.sweep.play import FailedError, play
from smachac.sweep.variation import Single, Variation, edited, poses
from smachac.targets.python import TARGET
from smachac.targets.python.runner import PythonProgram, Simulation, execute, failure_text
from smachac.verify.coverage import Coverage, CoverageItem
from smachac.verify.trace_statistics import StateStatistics, TraceStatistics

MOST_STEPS = 100
"""The most last ends of states that the result of a run keeps."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Task:
    """What all runs of a sweep have in common. `scenario` is played, up to `max_steps` states;
    without one the generated program runs, with `faults`. `scripts` and `templates` are more
    folders."""

    source: Source
    scripts: tuple[Path, ...] = ()
    templates: tuple[Path, ...] = ()
    scenario: Scenario | None = None
    faults: tuple[Fault, ...] = ()
    variations: tuple[Variation, ...] = ()
    max_steps: int = MAX_STEPS

    def values(self, seed: int) -> dict[str, Single]:
        """The varied values of the run with a seed."""
        return {variation.name: variation.drawn(seed) for variation in self.variations}


@dataclass(slots=True, kw_only=True)
class Run:
    """The result of one run. Paths are full ones.

    `outcome` is None if the run failed; `error` then has the reason. `seconds` is its duration,
    in simulated time if a world was open; `wall` the time that it took. `steps` are the last ends
    of states as they were written, path and outcome, which is empty for an exception; `faults` the
    faults that happened; `world` a digest of the simulated world at the end of the machine.
    """

    seed: int
    values: Mapping[str, Single] = field(default_factory=dict)
    outcome: str | None = None
    error: str = ""
    seconds: float = 0.0
    wall: float = 0.0
    steps: list[tuple[str, str]] = field(default_factory=list)
    states: dict[str, StateStatistics] = field(default_factory=dict)
    covered: list[CoverageItem] = field(default_factory=list)
    faults: list[str] = field(default_factory=list)
    world: str = ""


class Program(NamedTuple):
    """A compiled script with the values of one run. `texts` are the program by file name; none if
    a scenario is played."""

    machine: Checked
    texts: Mapping[str, str]


class Runner:
    """Runs of one task in this process, one after the other. The compiled script is kept until
    other values are needed."""

    def __init__(self, task: Task) -> None:
        self._task = task
        self._tree = parse(task.source, [])
        self._text = ""
        self._program: Program | None = None
        self._folders = [
            Path(os.path.realpath(folder)) for folder in module_folders(Path(task.source.name))
        ]

    def prepare(self) -> None:
        """Compile the script as it is, so that this is no part of the first run."""
        with suppress(FailedError):
            self._compiled({})

    def run(self, seed: int, observe: Callable[[dict[str, Any]], None] | None = None) -> Run:
        """The run with a seed. `observe` receives the events of its trace."""
        values = self._task.values(seed)
        result = Run(seed=seed, values=values)
        began = time.perf_counter()
        try:
            program = self._compiled(values)
            recorder = _Recorder(program.machine, result, observe)
            try:
                result.outcome = self._outcome(program, seed, poses(values), recorder)
            finally:
                result.covered = recorder.covered()
            if result.outcome is None:
                result.error = "the machine ended without an outcome"
        except FailedError as error:
            result.error = str(error)
        except (Exception, SystemExit) as error:
            result.error = failure_text(error)
        result.wall = time.perf_counter() - began
        return result

    def _compiled(self, values: Mapping[str, Single]) -> Program:
        """The program with these values. Raises FailedError if the script has errors with them."""
        source = edited(self._task.source, self._tree, values)
        if self._program is not None and self._text == source.text:
            return self._program
        task = self._task
        analysis = analyse_script(source, task.scripts, task.templates)
        compiled = compile_script(analysis, TARGET) if task.scenario is None else None
        report = compiled.report if compiled is not None else analysis.report
        if analysis.checked is None or has_errors(report):
            first = next(item for item in report if has_errors([item]))
            raise FailedError(f"with these values the script has an error: {first.message}")
        files = compiled.files if compiled is not None else {}
        self._program, self._text = Program(analysis.checked, files), source.text
        return self._program

    def _outcome(
        self,
        program: Program,
        seed: int,
        placed: Mapping[str, Mapping[str, float]],
        recorder: _Recorder,
    ) -> str | None:
        scenario, most = self._task.scenario, self._task.max_steps
        if scenario is not None:
            return play(program.machine, scenario, seed, None, recorder, max_steps=most)
        ((name, text),) = program.texts.items()
        try:
            return execute(
                PythonProgram(name=name, text=text, machine=program.machine, folders=self._folders),
                recorder,
                seed=seed,
                simulation=Simulation(faults=self._task.faults, poses=placed),
            ).outcome
        finally:
            if (simulation := sys.modules.get("smachac.sim")) is not None:
                simulation.close()  # of a program that failed, or left its world open


class _Recorder:
    """Notes the events of one run in its result."""

    def __init__(
        self,
        machine: Checked,
        result: Run,
        observe: Callable[[dict[str, Any]], None] | None,
    ) -> None:
        view = written(machine)
        self._full = {part.shown: part.full for part in view.parts.values()}
        self._ending = {
            state.outer_full
            for state in view.states.values()
            if isinstance(state.node, Leaf) or state.badges
        }
        self._root = machine.root.name
        self._statistics = TraceStatistics()
        self._coverage = Coverage(machine)
        self._result = result
        self._observe = observe
        result.states = self._statistics.states

    def __call__(self, event: dict[str, Any]) -> None:
        if self._observe is not None:
            self._observe(event)
        found = with_shown_paths(event, self._full)
        kind, result = found["event"], self._result
        result.seconds = max(result.seconds, float(found.get("t", 0.0)))
        self._statistics.record(found)
        if kind == "fault":
            result.faults.append(found["fault"])
            return
        self._coverage.record(found)
        if (kind == "exit" and found["path"] in self._ending) or kind == "error":
            result.steps.append((found["path"], found.get("outcome", "")))
            del result.steps[:-MOST_STEPS]
        elif kind == "finish":
            result.world = _world_digest()

    def covered(self) -> list[CoverageItem]:
        """What the run has covered, in the order of the script."""
        return [item for item in self._coverage.items if item in self._coverage.covered]


def _world_digest() -> str:
    """The digest of the simulated world; empty if none is open."""
    simulation = sys.modules.get("smachac.sim")
    world = simulation.open_world() if simulation is not None else None
    return "" if world is None else world.hash()


def merge_states(total: TraceStatistics, states: Mapping[str, StateStatistics]) -> None:
    """Add the statistics of one run to those of several."""
    for path, state in states.items():
        into = total.states.setdefault(path, StateStatistics())
        into.outcomes.update(state.outcomes)
        into.seconds += state.seconds
        into.longest = max(into.longest, state.longest)
        into.unfinished += state.unfinished
