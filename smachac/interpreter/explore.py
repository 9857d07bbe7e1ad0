"""Every order in which the branches of concurrences can take turns."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

from smachac.interpreter.interpreter import MOST_STEPS, run
from smachac.interpreter.result import Behaviour, Choice, Result
from smachac.ir.nodes import Machine


def explore(
    machine: Machine,
    behaviour: Callable[[], Behaviour],
    *,
    max_steps: int = MOST_STEPS,
    userdata: Mapping[str, object] | None = None,
) -> Iterator[Result]:
    """Every way in which the branches of a machine's concurrences can take turns, one run each.

    There may be very many: take as many as you want. `behaviour` makes what the leaves do, afresh
    for each run; it must do the same each time.
    """
    turns: list[str] | None = []
    while turns is not None:
        result = run(machine, behaviour(), schedule=turns, max_steps=max_steps, userdata=userdata)
        yield result
        turns = _next_turns(result.choices)


def _next_turns(choices: Sequence[Choice]) -> list[str] | None:
    """The turns that begin the next order: the last choice that has another one takes it."""
    for at in reversed(range(len(choices))):
        choice = choices[at]
        following = choice.ready.index(choice.taken) + 1
        if following < len(choice.ready):
            return [*(one.taken for one in choices[:at]), choice.ready[following]]
    return None
