"""Scenarios that lead a machine along its paths: to every transition, then on all simple paths,
each loop once, then anywhere."""

from __future__ import annotations

import random
from collections import Counter, deque
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from smachac.ir.nodes import Machine
from smachac.verify.coverage import Way
from smachac.verify.guidance import Wanted
from smachac.verify.paths import Attempt, Choice, Guide, Path, Walks

USUAL = 200
"""Paths that are made where nobody says how many, if fewer cover every transition."""

BUDGET = 500_000
"""States to enter on all paths together, where nobody says how many paths; a path costs a tenth of
the machine's states besides."""

LONGEST_RANDOM = 1_000
"""Choices of a random path before it heads for the end."""

MOST_USUAL = 3
"""Times that a leaf ends as usual on one path while there may be something new further on."""

MOST_VAIN = 50
"""Random paths in a row that were known already, before the search for others ends."""

MOST_ENDLESS = 3
"""Runs without an end, after which states no longer do what they do by themselves."""


class _Turning(NamedTuple):
    """Where a path may turn off another one: at that choice, with another option."""

    choices: list[Choice]
    at: int
    option: str

    def prefix(self) -> list[str | None]:
        return [*(choice.taken for choice in self.choices[: self.at]), self.option]


class Scenarios:
    """The paths of one machine, made one after the other; what is known when they are through.

    `most` bounds their number: without it there are as many as cover every transition, within
    BUDGET, and USUAL at least. `left_out` says, when all
    is done, what was not gone through. `walks` has what is known of all of them.
    """

    def __init__(self, machine: Machine, *, most: int | None = None, seed: int = 0) -> None:
        self.walks = Walks(machine)
        self.left_out: list[str] = []
        self._most = most
        self._random = random.Random(seed)
        self._noted: set[tuple[str, str]] = set()
        self._turnings: deque[_Turning] = deque()
        self._leaves = frozenset(self.walks.leaves)
        possible = self.walks.steering.possible
        self._outcomes = sum(len(possible[path]) for path in self._leaves)

    def paths(self) -> Iterator[Path]:
        """All of them. To be gone through once."""
        yield from self._covering()
        most = self._most if self._most is not None else max(USUAL, self.walks.made)
        yield from self._simple(most - max((most - self.walks.made) // 4, 0))
        yield from self._anywhere(most)
        if self.walks.endless:
            self.left_out.append(f"{self.walks.endless} paths that found no end")

    # Every transition

    def _within(self) -> bool:
        return self.walks.spent < BUDGET if self._most is None else self.walks.made < self._most

    def _covering(self) -> Iterator[Path]:
        """Paths until every way is taken that can be found, each with something new."""
        aimed: set[Way] = set()
        start = True
        while self._within():
            turning = self._next_turning()
            if start or turning is not None:
                prefix = turning.prefix() if turning is not None else []
                guide: Guide | None = self._following(prefix, self._exploring())
                start = False
            else:
                guide = self._next_goal(aimed)
            if guide is None:
                return
            attempt, path = self.walks.make("covering", guide)
            self._note_turnings(attempt)
            if path is not None:
                yield path
        if self._turnings:
            self.left_out.append("outcomes of states that no path has come to")

    def _next_turning(self) -> _Turning | None:
        """One to an outcome that its leaf has not had yet."""
        while self._turnings:
            turning = self._turnings.popleft()
            if (turning.choices[turning.at].place, turning.option) not in self.walks.tried:
                return turning
        return None

    def _note_turnings(self, attempt: Attempt) -> None:
        """Keep where a path has passed something new by."""
        for at, choice in enumerate(attempt.choices):
            for option in choice.options:
                new = (choice.place, option)
                if new not in self.walks.tried and new not in self._noted:
                    self._turnings.append(_Turning(attempt.choices, at, option))
                    self._noted.add(new)

    def _following(self, prefix: Sequence[str | None], then: Guide) -> Guide:
        def guide(place: str, options: tuple[str, ...], at: int) -> str | None:
            if at < len(prefix) and (prefix[at] is None or prefix[at] in options):
                return prefix[at]
            return then(place, options, at)

        return guide

    def _exploring(self) -> Guide:
        """Outcomes that leaves have not had yet; then the usual ones, which lead on to others, some
        times; then home."""
        usual: Counter[str] = Counter()

        def guide(place: str, options: tuple[str, ...], at: int) -> str | None:
            for option in self.walks.steering.scenic(place) if place in self._leaves else options:
                if (place, option) not in self.walks.tried:
                    return option
            usual[place] += 1
            if usual[place] <= MOST_USUAL and len(self.walks.tried) < self._outcomes:
                return options[0]
            return self.walks.home(place, options)

        return guide

    def _next_goal(self, aimed: set[Way]) -> Guide | None:
        for way in self.walks.taken.missing():
            entry = self.walks.entries.get(way.path)
            wanted = self._wanted(way) if entry is not None and way not in aimed else None
            if entry is not None and wanted is not None:
                aimed.add(way)
                choices, count = entry
                prefix = [choice.taken for choice in choices[:count]]
                return self._following(prefix, self._towards(way, wanted))
        return None

    def _wanted(self, way: Way) -> Wanted | None:
        """What containers have to do for a way to be taken."""
        if way.kind == "rule":
            found = self.walks.steering.combination(way.path, way.rule)
            return None if found is None else {way.path: found}
        if way.outcome not in self.walks.steering.possible[way.path]:
            return None
        if way.kind == "transition":
            return {way.path: way.outcome}
        around, _, name = way.path.rpartition("/")
        return {around: {name: way.outcome}}

    def _towards(self, way: Way, wanted: Wanted) -> Guide:
        aim = self.walks.steering.aim(wanted)

        def guide(place: str, options: tuple[str, ...], at: int) -> str | None:
            if way in self.walks.taken.taken:
                return self.walks.home(place, options)
            return self.walks.aimed(aim, wanted, place, options)

        return guide

    # Simple paths, and any

    def _simple(self, most: int) -> Iterator[Path]:
        """Paths on which no leaf has an outcome twice, but where the way to the end wants it."""
        prefix: list[str | None] | None = []
        while prefix is not None:
            if self.walks.made >= most or not self._within():
                self.left_out.append("more simple paths: there are too many to go through all")
                return
            open_: list[list[str | None]] = []
            attempt, path = self.walks.make("simple", self._once(prefix, open_))
            if path is not None:
                yield path
            taken = [choice.taken for choice in attempt.choices[: len(open_)]]
            prefix = None
            for at in reversed(range(len(open_))):
                if open_[at]:
                    prefix = [*taken[:at], open_[at][0]]
                    break

    def _once(self, prefix: Sequence[str | None], open_: list[list[str | None]]) -> Guide:
        """Notes in `open_` what could be chosen after what is."""
        used: dict[str, set[str | None]] = {}

        def guide(place: str, options: tuple[str, ...], at: int) -> str | None:
            home = self.walks.home(place, options)
            had = used.setdefault(place, set())
            fresh = [each for each in options if each not in had and each != home]
            ways: list[str | None] = [home, *fresh] if home is not None or not fresh else [*fresh]
            taken = prefix[at] if at < len(prefix) and prefix[at] in ways else ways[0]
            open_.append(ways[ways.index(taken) + 1 :])
            had.add(taken)
            return taken

        return guide

    def _anywhere(self, most: int) -> Iterator[Path]:
        """Random paths. On some a leaf fails, on some the machine is asked to stop, on some live
        states do what they do."""
        vain = tries = 0
        size = 1
        while self.walks.made < most and vain < MOST_VAIN and self._within():
            tries, vain = tries + 1, vain + 1
            length = self._random.randrange(1, min(2 * len(self._leaves) + 10, LONGEST_RANDOM))
            surprise = self._random.randrange(size)
            guide = self._drawing(length, surprise if tries % 4 == 2 else -1)
            live = bool(self.walks.live) and tries % 2 == 1 and self.walks.endless < MOST_ENDLESS
            stop = surprise if tries % 4 == 0 else -1
            attempt, path = self.walks.make("random", guide, live=live, stop=stop)
            if tries % 2 == 1:
                size = max(len(attempt.choices), 1)
            if path is not None:
                vain = 0
                yield path

    def _drawing(self, length: int, fails: int) -> Guide:
        """So many outcomes that are the usual one or any, more or less often; then home."""
        often = self._random.random()

        def guide(place: str, options: tuple[str, ...], at: int) -> str | None:
            if 0 <= fails <= at:
                return None
            if at >= length:
                return self.walks.home(place, options)
            return self._random.choice(options) if self._random.random() < often else options[0]

        return guide
