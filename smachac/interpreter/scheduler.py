"""Scheduling: the order in which branches of concurrences take turns."""

from __future__ import annotations

import random
from collections.abc import Sequence

from smachac.interpreter.result import SchedulingChoice


class ScheduleError(ValueError):
    """A schedule names a branch that cannot continue."""


class Scheduler:
    """Chooses turns by a seed or by a schedule, and records the choices.

    An entry of a schedule is the path of a branch or the end of it: `sm/BOTH/LEFT`, `LEFT`.
    """

    def __init__(self, seed: int, turns: Sequence[str] | None) -> None:
        self._random = random.Random(seed)
        self._turns = turns
        self.choices: list[SchedulingChoice] = []

    def choose(self, ready: Sequence[str]) -> str:
        """The branch that continues, among several paths. Raises ScheduleError."""
        if self._turns is None:
            taken = ready[self._random.randrange(len(ready))]
        elif len(self.choices) < len(self._turns):
            taken = self._named(self._turns[len(self.choices)], ready)
        else:
            taken = ready[0]
        self.choices.append(SchedulingChoice(taken=taken, ready=tuple(ready)))
        return taken

    def _named(self, turn: str, ready: Sequence[str]) -> str:
        if turn in ready:
            return turn
        for path in ready:
            if path.endswith(f"/{turn}"):
                return path
        names = ", ".join(f"`{path.rpartition('/')[2]}`" for path in ready)
        number = len(self.choices) + 1
        raise ScheduleError(f"turn {number} is `{turn}`, but {names} can go on")
