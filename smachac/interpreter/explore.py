"""Schedule exploration: one run for each order in which concurrent branches can take turns."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

from smachac.interpreter.interpreter import MAX_STEPS, run
from smachac.interpreter.result import Behaviour, InterpreterResult, SchedulingChoice
from smachac.ir.nodes import Machine


def explore(
    machine: Machine,
    behaviour: Callable[[], Behaviour],
    *,
    max_steps: int = MAX_STEPS,
    userdata: Mapping[str, object] | None = None,
) -> Iterator[InterpreterResult]:
    """Every schedule of a machine's concurrent branches, one run each.

    There can be very many schedules, so the results come from an iterator. `behaviour` creates the
    behaviour of the leaves for each run; it has to be deterministic.
    """
    turns: list[str] | None = []
    while turns is not None:
        result = run(machine, behaviour(), schedule=turns, max_steps=max_steps, userdata=userdata)
        yield result
        turns = _next_turns(result.choices)


def _next_turns(choices: Sequence[SchedulingChoice]) -> list[str] | None:
    """The prefix of the next schedule: the last choice with an untried alternative takes it."""
    for at in reversed(range(len(choices))):
        choice = choices[at]
        following = choice.ready.index(choice.taken) + 1
        if following < len(choice.ready):
            return [*(one.taken for one in choices[:at]), choice.ready[following]]
    return None
