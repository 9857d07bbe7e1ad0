"""Path generation: paths that cover every transition, then simple paths, then random ones."""

from __future__ import annotations

import random
from collections import Counter, deque
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from smachac.ir.nodes import Machine
from smachac.verify.coverage import CoverageItem
from smachac.verify.guidance import Goals
from smachac.verify.paths import START, Choice, Path, PathRun, PathRunner, Strategy

USUAL = 200
"""Default number of paths; more are generated if transition coverage needs them."""

BUDGET = 500_000
"""Default limit on the states entered on all paths together. Each path also costs a tenth of the
number of states of the machine."""

LONGEST_RANDOM = 1_000
"""Choices of a random path before it goes to the end."""

MOST_USUAL = 3
"""Visits on one path in which a leaf ends with its default outcome while untried outcomes
remain."""

MOST_STOPPED = 50
"""The most leaves at which paths with requests to stop begin them."""

MOST_VAIN = 50
"""Random paths in a row that are duplicates, after which the generation ends."""

MOST_ENDLESS = 3
"""Endless runs, after which no more live paths are generated."""


class _BranchPoint(NamedTuple):
    """A choice of an earlier path, and an option that was not taken there."""

    choices: list[Choice]
    at: int
    option: str

    def prefix(self) -> list[str | None]:
        """The choices that lead to the branch point and take its option."""
        return [*(choice.taken for choice in self.choices[: self.at]), self.option]


class PathGenerator:
    """Generates the paths of one machine, one after the other.

    `most` limits their number. Without it there are at least USUAL paths, and as many as transition
    coverage needs within BUDGET. `left_out` describes, after the generation, what was not explored.
    `runner` holds the results of all paths.
    """

    def __init__(self, machine: Machine, *, most: int | None = None, seed: int = 0) -> None:
        self.runner = PathRunner(machine)
        self.left_out: list[str] = []
        self._most = most
        self._random = random.Random(seed)
        self._recorded: set[tuple[str, str]] = set()
        self._branch_points: deque[_BranchPoint] = deque()
        self._leaves = frozenset(self.runner.leaves)
        possible = self.runner.planner.possible
        self._outcomes = sum(len(possible[path]) for path in self._leaves)

    def paths(self) -> Iterator[Path]:
        """All paths; may be called once."""
        yield from self._covering_paths()
        yield from self._stopped_paths()
        most = self._most if self._most is not None else max(USUAL, self.runner.made)
        yield from self._simple_paths(most - max((most - self.runner.made) // 4, 0))
        yield from self._random_paths(most)
        if self.runner.endless:
            self.left_out.append(f"{self.runner.endless} paths without an end")

    # Every transition

    def _within(self) -> bool:
        """Whether the budget allows another path."""
        return self.runner.spent < BUDGET if self._most is None else self.runner.made < self._most

    def _covering_paths(self) -> Iterator[Path]:
        """Paths until every item is covered that can be found; each tries something new."""
        attempted: set[CoverageItem] = set()
        start = True
        while self._within():
            branch_point = self._next_branch_point()
            if start or branch_point is not None:
                prefix = branch_point.prefix() if branch_point is not None else []
                strategy: Strategy | None = self._prefix_strategy(
                    prefix, self._exploring_strategy()
                )
                start = False
            else:
                strategy = self._next_goal(attempted)
            if strategy is None:
                return
            path_run, path = self.runner.make("covering", strategy)
            self._record_branch_points(path_run)
            if path is not None:
                yield path
        if self._branch_points:
            self.left_out.append("outcomes of states that no path reached")

    def _next_branch_point(self) -> _BranchPoint | None:
        """The next branch point whose option is untried."""
        while self._branch_points:
            branch_point = self._branch_points.popleft()
            if (
                branch_point.choices[branch_point.at].place,
                branch_point.option,
            ) not in self.runner.tried:
                return branch_point
        return None

    def _record_branch_points(self, path_run: PathRun) -> None:
        """Add a branch point for each untried option along a path."""
        for at, choice in enumerate(path_run.choices):
            for option in choice.options:
                new = (choice.place, option)
                if new not in self.runner.tried and new not in self._recorded:
                    self._branch_points.append(_BranchPoint(path_run.choices, at, option))
                    self._recorded.add(new)

    def _prefix_strategy(self, prefix: Sequence[str | None], then: Strategy) -> Strategy:
        """Follow a prefix of choices, then another strategy."""

        def strategy(place: str, options: tuple[str, ...], at: int) -> str | None:
            if at < len(prefix) and (prefix[at] is None or prefix[at] in options):
                return prefix[at]
            return then(place, options, at)

        return strategy

    def _exploring_strategy(self) -> Strategy:
        """Prefer untried outcomes; then, a few times, the default outcomes; then go to the end."""
        usual: Counter[str] = Counter()

        def strategy(place: str, options: tuple[str, ...], at: int) -> str | None:
            for option in (
                self.runner.planner.longest_first(place) if place in self._leaves else options
            ):
                if (place, option) not in self.runner.tried:
                    return option
            usual[place] += 1
            if usual[place] <= MOST_USUAL and len(self.runner.tried) < self._outcomes:
                return options[0]
            return self.runner.towards_end(place, options)

        return strategy

    def _next_goal(self, attempted: set[CoverageItem]) -> Strategy | None:
        """A strategy for the next item that is not covered and was not attempted."""
        for item in self.runner.coverage.missing():
            entry = self.runner.entries.get(item.path)
            goals = self._goals(item) if entry is not None and item not in attempted else None
            if entry is not None and goals is not None:
                attempted.add(item)
                choices, count = entry
                prefix = [choice.taken for choice in choices[:count]]
                return self._prefix_strategy(prefix, self._goal_strategy(item, goals))
        return None

    def _goals(self, item: CoverageItem) -> Goals | None:
        """The outcomes that containers need for an item to be covered."""
        if item.kind == "rule":
            found = self.runner.planner.combination(item.path, item.rule)
            return None if found is None else {item.path: found}
        if item.outcome not in self.runner.planner.possible[item.path]:
            return None
        if item.kind == "transition":
            return {item.path: item.outcome}
        around, _, name = item.path.rpartition("/")
        return {around: {name: item.outcome}}

    def _goal_strategy(self, item: CoverageItem, goals: Goals) -> Strategy:
        """Go to an item; after that, go to the end."""
        target = self.runner.planner.outcomes_towards(goals)

        def strategy(place: str, options: tuple[str, ...], at: int) -> str | None:
            if item in self.runner.coverage.covered:
                return self.runner.towards_end(place, options)
            return self.runner.towards(target, goals, place, options)

        return strategy

    # A request to stop at every position

    def _stopped_paths(self) -> Iterator[Path]:
        """Paths with a request to stop before the start, or as each leaf is first entered; then the
        same with a second request at the next choice."""
        places: list[tuple[list[str | None], int]] = [([], START)]
        for leaf in self.runner.leaves[:MOST_STOPPED]:
            if leaf in self.runner.entries:
                choices, count = self.runner.entries[leaf]
                places.append(([choice.taken for choice in choices[:count]], count))
        most = None if self._most is None else (self.runner.made + self._most) // 2
        for further in ((), (1,), (2,)):
            for prefix, at in places:
                if not self._within() or self.runner.made == most:
                    return
                strategy = self._prefix_strategy(prefix, self._to_end)
                stops = (at, *(at + number for number in further))
                _, path = self.runner.make("stopped", strategy, stops=stops)
                if path is not None:
                    yield path

    def _to_end(self, place: str, options: tuple[str, ...], at: int) -> str | None:
        return self.runner.towards_end(place, options)

    # Simple paths, and any

    def _simple_paths(self, most: int) -> Iterator[Path]:
        """Simple paths: no leaf repeats an outcome, unless it is needed to reach the end."""
        prefix: list[str | None] | None = []
        while prefix is not None:
            if self.runner.made >= most or not self._within():
                self.left_out.append("more simple paths: there are too many of them")
                return
            untried: list[list[str | None]] = []
            path_run, path = self.runner.make("simple", self._without_repeats(prefix, untried))
            if path is not None:
                yield path
            taken = [choice.taken for choice in path_run.choices[: len(untried)]]
            prefix = None
            for at in reversed(range(len(untried))):
                if untried[at]:
                    prefix = [*taken[:at], untried[at][0]]
                    break

    def _without_repeats(
        self, prefix: Sequence[str | None], untried: list[list[str | None]]
    ) -> Strategy:
        """The strategy of simple paths. It stores the remaining options of each choice in
        `untried`."""
        used: dict[str, set[str | None]] = {}

        def strategy(place: str, options: tuple[str, ...], at: int) -> str | None:
            to_end = self.runner.towards_end(place, options)
            had = used.setdefault(place, set())
            fresh = [option for option in options if option not in had and option != to_end]
            ordered: list[str | None] = (
                [to_end, *fresh] if to_end is not None or not fresh else [*fresh]
            )
            taken = prefix[at] if at < len(prefix) and prefix[at] in ordered else ordered[0]
            untried.append(ordered[ordered.index(taken) + 1 :])
            had.add(taken)
            return taken

        return strategy

    def _random_paths(self, most: int) -> Iterator[Path]:
        """Random paths. On some a leaf fails, on some the machine is preempted, on some live states
        run their own code."""
        vain = tries = 0
        size = 1
        while self.runner.made < most and vain < MOST_VAIN and self._within():
            tries, vain = tries + 1, vain + 1
            length = self._random.randrange(1, min(2 * len(self._leaves) + 10, LONGEST_RANDOM))
            surprise = self._random.randrange(size)
            strategy = self._random_strategy(length, surprise if tries % 4 == 2 else -1)
            live = bool(self.runner.live) and tries % 2 == 1 and self.runner.endless < MOST_ENDLESS
            stops = self._random_stops(size) if tries % 4 == 0 else []
            path_run, path = self.runner.make("random", strategy, live=live, stops=stops)
            if tries % 2 == 1:
                size = max(len(path_run.choices), 1)
            if path is not None:
                vain = 0
                yield path

    def _random_stops(self, size: int) -> list[int]:
        """One to three moments for requests to stop, START among them."""
        return [self._random.randrange(START, size) for _ in range(self._random.randint(1, 3))]

    def _random_strategy(self, length: int, fails: int) -> Strategy:
        """`length` outcomes, each the default or a random one; then go to the end."""
        often = self._random.random()

        def strategy(place: str, options: tuple[str, ...], at: int) -> str | None:
            if 0 <= fails <= at:
                return None
            if at >= length:
                return self.runner.towards_end(place, options)
            return self._random.choice(options) if self._random.random() < often else options[0]

        return strategy
