"""Simulation: a run whose steps are chosen one by one, and which stands where a choice is missing.

The run is played again from its start for each further choice. So there is no second semantics, and
a step back is a run with one choice less.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from contextlib import suppress
from typing import NamedTuple

from smachac.interpreter.behaviours import builtin_behaviour, preemptible
from smachac.interpreter.counterexample import turn_name
from smachac.interpreter.interpreter import Interpreter
from smachac.interpreter.result import Event, InterpreterResult, SchedulingChoice
from smachac.interpreter.scenario import Scenario, ScenarioStep, play_step
from smachac.interpreter.scheduler import Scheduler
from smachac.interpreter.userdata import Userdata
from smachac.ir.nodes import Leaf, Machine
from smachac.ir.traversal import outcome_names, walk
from smachac.records import dataclass


class Choice(NamedTuple):
    """The step of the next visit of the leaf at a full path."""

    path: str
    step: ScenarioStep


@dataclass(frozen=True, slots=True, kw_only=True)
class Position:
    """A run after some choices.

    `waiting` are the full paths of the leaves that have started and whose step is missing, in the
    order of their starts; those in `stopped` have a request to stop. `performed` is the number of
    choices that could be performed: the next one is for a leaf that does not wait. `visits` are the
    numbers of their visits, from 1. `schedule` has the branches that went on at each choice
    between several ones, `time` is virtual, in s. `result` is None while leaves wait.
    """

    waiting: tuple[str, ...]
    stopped: frozenset[str]
    performed: int
    visits: tuple[int, ...]
    events: tuple[Event, ...]
    schedule: tuple[str, ...]
    time: float
    result: InterpreterResult | None


class _Missing(BaseException):
    """The step of a leaf is missing. No Exception, so that the machine does not catch it."""


@dataclass(slots=True)
class _Run:
    """A run that follows choices. `automatic` are the leaves that need none; `waiting` those that
    have started, without a step yet."""

    choices: Sequence[Choice]
    automatic: Collection[str]
    visits: list[int]
    waiting: dict[str, None]
    events: list[Event]

    @property
    def next(self) -> str:
        """The leaf of the next choice; empty if there is none."""
        done = len(self.visits)
        return self.choices[done].path if done < len(self.choices) else ""


class _Chosen(Scheduler):
    """Continues the branches without a leaf that waits for a choice, then that of the next choice.
    So time passes only if no leaf waits for a choice."""

    def __init__(self, run: _Run) -> None:
        super().__init__(0, ())
        self._run = run

    def choose(self, ready: Sequence[str]) -> str:
        taken = self._taken(ready)
        if taken is None:
            raise _Missing
        self.choices.append(SchedulingChoice(taken=taken, ready=tuple(ready)))
        return taken

    def _taken(self, ready: Sequence[str]) -> str | None:
        run = self._run
        manual = [path for path in run.waiting if path not in run.automatic]
        automatic = [path for path in run.waiting if path in run.automatic]
        for branch in ready:
            if not _inside(branch, manual) or _inside(branch, automatic):
                return branch
        return next((branch for branch in ready if _inside(branch, [run.next])), None)


def _inside(branch: str, paths: Collection[str]) -> bool:
    """Whether one of the paths is that of a branch, or of a state in it."""
    return any(f"{path}/".startswith(f"{branch}/") for path in paths)


def simulate(
    machine: Machine, choices: Sequence[Choice], automatic: Collection[str] = ()
) -> Position:
    """The position of a machine after some choices. `automatic` are the full paths of leaves that
    need no choice, such as the timers of time limits."""
    others = preemptible(builtin_behaviour())
    run = _Run(choices, automatic, [], {}, [])

    def behave(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
        if path in automatic:
            run.waiting.pop(path, None)
            return others(path, leaf, visit, userdata)
        if run.next != path or not is_possible(run.choices[len(run.visits)].step, leaf):
            raise _Missing
        step = run.choices[len(run.visits)].step
        run.waiting.pop(path, None)
        run.visits.append(visit)
        return play_step(step, others, path, leaf, visit, userdata)

    def on_event(event: Event) -> None:
        run.events.append(event)
        if event["event"] == "enter" and event["path"] in leaf_paths:
            run.waiting[event["path"]] = None

    leaf_paths = {path for path, node in walk(machine.root) if isinstance(node, Leaf)}
    interpreter = Interpreter(machine, behave, on_event)
    interpreter.schedule = _Chosen(run)
    result = None
    with suppress(_Missing):
        result = interpreter.execute()
    waiting = () if result is not None else tuple(run.waiting)
    return Position(
        waiting=waiting,
        stopped=frozenset(path for path in waiting if path in interpreter.preemption.requested),
        performed=len(run.visits),
        visits=tuple(run.visits),
        events=tuple(run.events),
        schedule=tuple(map(turn_name, interpreter.schedule.choices)),
        time=interpreter.clock,
        result=result,
    )


def is_possible(step: ScenarioStep, leaf: Leaf) -> bool:
    """Whether a leaf has the outcome and the output keys of a step."""
    if leaf.open:
        return True
    written = {key for key, _ in step.writes}
    ends = step.outcome is None or step.outcome in outcome_names(leaf)
    return ends and written <= {key.name for key in leaf.outputs}


def chosen_scenario(choices: Sequence[Choice]) -> Scenario:
    """The scenario of some choices. A step that repeats the one before at the end of a list is left
    out, and so is a leaf that only runs its own code."""
    steps: dict[str, list[ScenarioStep]] = {}
    for choice in choices:
        steps.setdefault(choice.path, []).append(choice.step)
    for row in steps.values():
        while len(row) > 1 and row[-1] == row[-2]:
            row.pop()
    own = [ScenarioStep(run=True)]
    return Scenario(steps={path: tuple(row) for path, row in steps.items() if row != own})
