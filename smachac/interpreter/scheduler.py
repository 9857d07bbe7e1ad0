"""Whose turn it is among the branches of concurrences."""

from __future__ import annotations

import random
from collections.abc import Sequence

from smachac.interpreter.result import Choice


class ScheduleError(ValueError):
    """A schedule gives the turn to a branch that cannot go on."""


class Schedule:
    """Settles turns by a seed or by a list of branches, and notes what it settled.

    An entry of the list is the path of a branch or the end of it: `sm/BOTH/LEFT`, `LEFT`.
    """

    def __init__(self, seed: int, turns: Sequence[str] | None) -> None:
        self._random = random.Random(seed)
        self._turns = turns
        self.choices: list[Choice] = []

    def choose(self, ready: Sequence[str]) -> str:
        """The branch that goes on, of several paths. Raises ScheduleError."""
        if self._turns is None:
            taken = ready[self._random.randrange(len(ready))]
        elif len(self.choices) < len(self._turns):
            taken = self._named(self._turns[len(self.choices)], ready)
        else:
            taken = ready[0]
        self.choices.append(Choice(taken=taken, ready=tuple(ready)))
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
