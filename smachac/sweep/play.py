"""One run of a scenario on the interpreter, for the commands `run` and `sweep`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from smachac.interpreter.scenario import Scenario
from smachac.ir.nodes import Machine
from smachac.runtime.tracing.gate import Gate

Event = dict[str, Any]


class FailedError(Exception):
    """A run ended without an outcome; the message gives the reason."""


def play(
    machine: Machine,
    scenario: Scenario,
    seed: int,
    schedule: Sequence[str] | None,
    observe: Callable[[Event], None],
    gate: Gate | None = None,
) -> str:
    """Play a scenario on the interpreter; the outcome. Raises FailedError.

    `gate` lets a debugger stop the run between two states.
    """
    from smachac.interpreter.behaviours import builtin_behaviour
    from smachac.interpreter.interpreter import run
    from smachac.interpreter.scenario import scenario_behaviour
    from smachac.interpreter.scheduler import ScheduleError
    from smachac.ir.script_paths import script_paths
    from smachac.runtime.tracing.writer import shown_path

    behaviour = scenario_behaviour(scenario, machine, builtin_behaviour(seed), seed)
    paths = script_paths(machine.root)
    full = {shown: path for path, shown in paths.items()}
    turns = None if schedule is None else [full.get(turn, turn) for turn in schedule]
    try:
        result = run(
            machine, behaviour, _shown(observe, paths), seed=seed, schedule=turns, gate=gate
        )
    except ScheduleError as error:
        raise FailedError(f"--schedule: {error}") from None
    if result.error is not None:
        failure = result.error
        words = f"{shown_path(failure.path, paths)}: {failure.message}"
        span = failure.span
        raise FailedError(f"{words}\n  --> {span}" if span.source.text else words)
    assert result.outcome is not None
    return result.outcome


def _shown(observe: Callable[[Event], None], paths: Mapping[str, str]) -> Callable[[Event], None]:
    """An observer of events with full paths."""
    from smachac.runtime.tracing.writer import with_shown_paths

    return lambda event: observe(with_shown_paths(event, paths))
