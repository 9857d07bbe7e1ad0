"""One run of a scenario on the interpreter, for the commands `run` and `sweep`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from smachac.interpreter.interpreter import MAX_STEPS
from smachac.interpreter.result import Behaviour
from smachac.interpreter.scenario import Scenario
from smachac.ir.nodes import Machine
from smachac.runtime.tracing.gate import Gate

Event = dict[str, Any]


FILL_HELP = "write it with `set` in an earlier step, or `fill: true` in the scenario"
"""What to do about a key that no state has written."""

SHOWN_STATES = 6
"""The most states of a cycle that a message names."""


class FailedError(Exception):
    """A run ended without an outcome; the message gives the reason. `cycle`: the states that it
    repeated at its end, by full path."""

    def __init__(self, message: str, cycle: Sequence[str] = ()) -> None:
        super().__init__(message)
        self.cycle = cycle


def play(
    machine: Machine,
    scenario: Scenario,
    seed: int,
    schedule: Sequence[str] | None,
    observe: Callable[[Event], None],
    gate: Gate | None = None,
    *,
    max_steps: int = MAX_STEPS,
) -> str:
    """Play a scenario on the interpreter; the outcome. Raises FailedError.

    `gate` lets a debugger stop the run between two states. `max_steps` is the most states that it
    enters.
    """
    from smachac.interpreter.interpreter import run
    from smachac.interpreter.scheduler import ScheduleError
    from smachac.ir.script_paths import script_paths
    from smachac.runtime.tracing.writer import shown_path

    behaviour = played_behaviour(machine, scenario, seed)
    paths = script_paths(machine.root)
    full = {shown: path for path, shown in paths.items()}
    turns = None if schedule is None else [full.get(turn, turn) for turn in schedule]
    try:
        result = run(
            machine,
            behaviour,
            _shown(observe, paths),
            seed=seed,
            schedule=turns,
            max_steps=max_steps,
            gate=gate,
        )
    except ScheduleError as error:
        raise FailedError(f"--schedule: {error}") from None
    if result.error is not None:
        failure = result.error
        words = f"{shown_path(failure.path, paths)}: {failure.message}"
        if failure.cycle:
            round_ = [shown_path(path, paths) for path in failure.cycle]
            more = ["..."] if len(round_) > SHOWN_STATES else []
            words += f": it repeats {', '.join([*round_[:SHOWN_STATES], *more])}"
        span = failure.span
        place = f"\n  --> {span}" if span.source.text else ""
        is_filled = failure.kind != "missing-key" or scenario.fill
        help_ = "" if is_filled else f"\nhelp: {FILL_HELP}"
        raise FailedError(f"{words}{place}{help_}", failure.cycle)
    assert result.outcome is not None
    return result.outcome


def played_behaviour(machine: Machine, scenario: Scenario, seed: int) -> Behaviour:
    """The behaviour of the leaves of a machine that plays a scenario."""
    from smachac.interpreter.behaviours import builtin_behaviour
    from smachac.interpreter.scenario import scenario_behaviour
    from smachac.verify.sample_values import SampleValues

    fill = SampleValues(machine).outputs if scenario.fill else None
    return scenario_behaviour(scenario, machine, builtin_behaviour(seed), seed, fill)


def _shown(observe: Callable[[Event], None], paths: Mapping[str, str]) -> Callable[[Event], None]:
    """An observer of events with full paths."""
    from smachac.runtime.tracing.writer import with_shown_paths

    return lambda event: observe(with_shown_paths(event, paths))
