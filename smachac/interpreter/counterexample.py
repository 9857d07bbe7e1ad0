"""Counterexamples as scenarios: visits of leaves in one order, for `smachac run --mock`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Protocol

from smachac.interpreter.interpreter import Interpreter
from smachac.interpreter.result import Event, SchedulingChoice
from smachac.interpreter.scenario import (
    Scenario,
    ScenarioStep,
    perform_step,
    scenario_line,
    scenario_text,
)
from smachac.interpreter.scheduler import Scheduler
from smachac.interpreter.userdata import Userdata
from smachac.ir.leaf import default_outcome
from smachac.ir.nodes import Leaf, Machine

FAILURE = "a failure of the counterexample"
"""The message of the exceptions that a scenario raises."""

MOST_ROUNDS = 3
"""The rounds of an endless loop that a scenario contains."""


class Visited(Protocol):
    """A visit of a leaf (analysis/properties.py, Visit)."""

    @property
    def path(self) -> str: ...
    @property
    def outcome(self) -> str | None: ...
    @property
    def stop(self) -> bool: ...


class Replay(NamedTuple):
    """A scenario with the schedule that makes branches take turns in the order of the visits, and
    the trace of the run. `followed`: all visits took place in this order."""

    scenario: Scenario
    schedule: tuple[str, ...]
    events: tuple[Event, ...]
    followed: bool

    @property
    def text(self) -> str:
        """The scenario as a file for `smachac run --mock`."""
        return scenario_text(self.scenario.steps)

    @property
    def flow(self) -> str:
        """The scenario on one line."""
        return scenario_line(self.scenario.steps)


class _Guided(Scheduler):
    """Chooses the branch of the next visit."""

    def __init__(self, visits: Sequence[Visited], done: list[int]) -> None:
        super().__init__(0, ())
        self._visits = visits
        self._done = done

    def choose(self, ready: Sequence[str]) -> str:
        if len(self._done) == len(self._visits):
            return ready[0]  # as after the end of a schedule
        path = self._visits[len(self._done)].path
        taken = next((text for text in ready if f"{path}/".startswith(f"{text}/")), ready[0])
        self.choices.append(SchedulingChoice(taken=taken, ready=tuple(ready)))
        return taken


def replay(machine: Machine, visits: Sequence[Visited], again: int = -1) -> Replay:
    """The scenario of some visits, and its run in the interpreter. `again`: the visits from this
    number on are repeated for ever; the scenario contains some rounds of them."""
    rounds = list(visits)
    if again >= 0:
        rounds += list(visits[again:]) * (MOST_ROUNDS - 1)
    steps: dict[str, list[ScenarioStep]] = {}
    for round_ in rounds:
        failed = round_.outcome is None
        step = ScenarioStep(
            outcome=round_.outcome, error=FAILURE if failed else "", stop=round_.stop
        )
        steps.setdefault(round_.path, []).append(step)
    done: list[int] = []
    made: dict[str, int] = {}
    right: list[bool] = []

    def behave(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
        if len(done) < len(rounds):
            right.append(rounds[len(done)].path == path)
            done.append(len(done))
        made[path] = made.get(path, 0) + 1
        row = steps.get(path, [ScenarioStep(outcome=default_outcome(leaf))])
        step = row[min(made[path], len(row)) - 1]
        if step.stop:
            userdata.stop_machine()
        return perform_step(step, leaf, userdata)

    events: list[Event] = []
    interpreter = Interpreter(machine, behave, events.append, max_steps=20 * len(rounds) + 10_000)
    interpreter.schedule = _Guided(rounds, done)
    result = interpreter.execute()
    schedule = tuple(turn_name(choice) for choice in result.choices)
    scenario = Scenario(steps={path: tuple(row) for path, row in steps.items()})
    followed = all(right) and len(right) == len(rounds)
    return Replay(scenario, schedule, tuple(events), followed)


def turn_name(choice: SchedulingChoice) -> str:
    """The name of the branch that continues, or its path if another branch has that name."""
    name = choice.taken.rpartition("/")[2]
    same = [path for path in choice.ready if path.endswith(f"/{name}")]
    return name if len(same) == 1 else choice.taken
