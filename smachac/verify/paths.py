"""One path through a machine: a run of the interpreter in which each outcome is chosen as it comes.

So hierarchy, concurrences and iterators need no rules of their own here, and what was chosen is
the scenario. In a concurrence that ends with its first branch (`join: any`) that branch is chosen
as well: in the others each leaf waits until it is asked to stop.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run
from smachac.interpreter.result import Event
from smachac.interpreter.scenario import Scenario, Step, follow
from smachac.interpreter.userdata import Userdata
from smachac.ir.expressions import parse_expression
from smachac.ir.leaf import default_outcome
from smachac.ir.nodes import Concurrence, Leaf, Machine
from smachac.ir.traversal import PREEMPTED, containers, expressions, outcome_names, walk
from smachac.verify.coverage import Taken
from smachac.verify.guidance import Steering, Wanted, leaf_outcomes
from smachac.verify.sample_values import Constants, given
from smachac.verify.shared_keys import contended

LIVE_TYPES = ("CallbacksState", "ConditionalOutcomeState")
"""State types whose own code is run on some paths: all of it is portable."""

FAILURE = "a failure of the scenario"
"""The error with which a leaf fails that is to."""

CUT = "the scenario ends here"
"""The error with which a path ends that would have no end."""

FAILS = ""
"""The option of a leaf to raise an exception, where something around it catches that."""

FAILS_FIRST = "fails: "
"""Before the name of a branch: the option of a concurrence that this one fails first."""

Kind = Literal["covering", "simple", "random"]


class Choice(NamedTuple):
    """An outcome chosen for the leaf `place`, or for the concurrence the branch to end first."""

    place: str
    options: tuple[str, ...]
    taken: str | None


Guide = Callable[[str, tuple[str, ...], int], "str | None"]
"""Chooses: from the place, its options and the number of choices so far. None: end here."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Path:
    """A way through a machine. `live`: states of LIVE_TYPES are not in the scenario and do what
    they do. `ends`: it comes to an end by itself, not by an error. `visits` counts leaves."""

    kind: Kind
    scenario: Scenario
    live: bool
    ends: bool
    visits: int


@dataclass(slots=True)
class Attempt:
    """One run while it is made."""

    guide: Guide
    live: frozenset[str]
    stop: int = -1
    choices: list[Choice] = field(default_factory=list)
    steps: dict[str, list[Step]] = field(default_factory=dict)
    first: dict[str, str] = field(default_factory=dict)
    failing: dict[str, str] = field(default_factory=dict)
    visits: int = 0
    ended: dict[str, set[str]] = field(default_factory=dict)


class Walks:
    """Makes the paths of one machine, as guides choose, and knows what all of them have had.

    `taken` knows the ways taken, `tried` the outcomes chosen by leaf, `entries` how each state was
    first come to. `made` counts paths, `spent` the states entered (and a tenth of the machine for
    each run), `endless` the runs given up. `live` are the leaves that may do what their own code
    says.
    """

    def __init__(self, machine: Machine) -> None:
        self.machine = machine
        self.taken = Taken(machine)
        self.steering = Steering(machine)
        self.made = self.spent = self.endless = 0
        self.tried: set[tuple[str, str]] = set()
        self.entries: dict[str, tuple[list[Choice], int]] = {}
        self._known: set[int] = set()
        self._aim = self.steering.aim()
        self._tree = dict(walk(machine.root))
        self._beside = _concurrences_around(machine)
        self._caught = _caught(machine)
        self._constants = Constants(machine)
        self._given = given(machine)
        self.leaves = [path for path, node in self._tree.items() if isinstance(node, Leaf)]
        self.live = frozenset(filter(self._is_live, self.leaves))
        if contended(machine):
            self.live = frozenset()
        self._limit = 20 * len(self.leaves) + 10_000

    def _is_live(self, path: str) -> bool:
        node = self._tree[path]
        portable = all(parse_expression(each.text) is not None for each in expressions(node))
        return node.type in LIVE_TYPES and portable and not self._beside[path]

    def make(
        self, kind: Kind, guide: Guide, *, live: bool = False, stop: int = -1
    ) -> tuple[Attempt, Path | None]:
        """Run the machine as a guide says; no path where that is known already or has no end.

        At the choice of that number the machine is asked to stop, unless in a concurrence: which
        branches hear of it in time is for threads to decide.
        """
        attempt = Attempt(guide, self.live if live else frozenset(), stop)
        others = builtin_behaviour()

        def behave(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
            attempt.visits += 1
            if path in attempt.live:
                return others(path, leaf, visit, userdata)
            return self._step(attempt, path, leaf, userdata)

        result = run(
            self.machine,
            behave,
            lambda event: self._hear(attempt, event),
            schedule=(),
            max_steps=3 * self._limit,
            userdata=self._given,
        )
        self.spent += result.steps + len(self._tree) // 10
        if result.error is not None and result.error.kind == "no-end":
            self.endless += 1
            return attempt, None
        mark = hash((live, stop, tuple((choice.place, choice.taken) for choice in attempt.choices)))
        if mark in self._known:
            return attempt, None
        self._known.add(mark)
        self.made += 1
        steps = {path: tuple(row) for path, row in attempt.steps.items()}
        return attempt, Path(
            kind=kind,
            scenario=Scenario(steps=steps),
            live=live,
            ends=result.error is None,
            visits=attempt.visits,
        )

    def _step(self, attempt: Attempt, path: str, leaf: Leaf, userdata: Userdata) -> str:
        stop = len(attempt.choices) == attempt.stop and not self._beside[path]
        if stop:
            attempt.stop = -1
            userdata.stop_machine()
        wait = self._waits(attempt, path, userdata.preempted)
        row = attempt.steps.setdefault(path, [])
        if PREEMPTED in outcome_names(leaf) and (wait or userdata.preempted):
            # Who does not hear of the request ends otherwise.
            row.append(Step(outcome=default_outcome(leaf), wait=wait, stop=stop))
        elif path in attempt.failing.values():
            row.append(Step(error=FAILURE, wait=wait, stop=stop))
        else:
            options = leaf_outcomes(leaf) or (default_outcome(leaf),)
            options += (FAILS,) * (path in self._caught and not leaf.catches)
            outcome = self._choose(attempt, path, options)
            if outcome is None and self._beside[path]:
                outcome = self._aim(path) or default_outcome(leaf)
            if outcome is None:
                row.append(Step(error=CUT, stop=stop))
            elif outcome in (FAILS, leaf.catches):
                row.append(Step(error=FAILURE, wait=wait, stop=stop))
            else:
                writes = self._constants.written(path, leaf, outcome, len(row))
                row.append(Step(outcome=outcome, writes=writes, wait=wait, stop=stop))
        return follow(row[-1], leaf, userdata)

    def _choose(self, attempt: Attempt, place: str, options: tuple[str, ...]) -> str | None:
        usual = self._usual(place, options)
        options = tuple(dict.fromkeys((usual, *options)))
        taken = None
        if len(attempt.choices) < self._limit:
            taken = attempt.guide(place, options, len(attempt.choices))
        attempt.choices.append(Choice(place, options, taken))
        if taken is not None:
            self.tried.add((place, taken))
        return taken

    def _usual(self, place: str, options: tuple[str, ...]) -> str:
        node = self._tree[place]
        usual = default_outcome(node) if isinstance(node, Leaf) else options[0]
        return usual if usual in options else options[0]

    def _waits(self, attempt: Attempt, path: str, asked: bool) -> bool:
        """Whether a leaf is in a branch that another one is to end before, and which was not asked
        to stop in an earlier leaf. Here it may have been `asked` already; elsewhere it is sooner or
        later."""
        return any(
            (first := attempt.first.get(around)) is not None
            and branch != first
            and (asked or first not in attempt.ended[around])
            for around, branch in self._beside[path]
        )

    def _hear(self, attempt: Attempt, event: Event) -> None:
        self.taken.hear(event)
        path = event["path"]
        if event["event"] == "enter":
            if path not in self.entries:
                self.entries[path] = (attempt.choices, len(attempt.choices))
            node = self._tree[path]
            if isinstance(node, Concurrence):
                self._start(attempt, path, node)
        elif event["event"] in ("exit", "error"):
            around, _, name = path.rpartition("/")
            if around in attempt.ended:
                attempt.ended[around].add(name)

    def _start(self, attempt: Attempt, path: str, node: Concurrence) -> None:
        """A concurrence starts: which branch ends or fails first, where that is to be settled."""
        attempt.ended[path] = set()
        attempt.first.pop(path, None)
        attempt.failing.pop(path, None)
        options = [child.name for child in node.children] if node.join == "any" else [""]
        if node.catches or path in self._caught:
            able = (child for child in node.children if isinstance(child, Leaf))
            options += [f"{FAILS_FIRST}{child.name}" for child in able if not child.catches]
        if options == [""]:
            return
        taken = self._choose(attempt, path, tuple(options)) or options[0]
        name = taken.removeprefix(FAILS_FIRST)
        if name:
            attempt.first[path] = name
        if name != taken:
            attempt.failing[path] = f"{path}/{name}"

    def home(self, place: str, options: Sequence[str]) -> str | None:
        """The choice by which the machine ends soonest; None where it cannot end."""
        return self.aimed(self._aim, {}, place, options)

    def aimed(
        self, aim: Callable[[str], str | None], wanted: Wanted, place: str, options: Sequence[str]
    ) -> str | None:
        """The outcome of a leaf, or the branch to end first (empty: all end), by which what is
        aimed at is had."""
        if isinstance(self._tree[place], Leaf):
            return aim(place)
        goal = wanted.get(place, aim(place))
        ends = self.steering.combination(place, goal) if isinstance(goal, str) else goal
        names = (name for name in options if not name.startswith(FAILS_FIRST))
        first = (name for name in names if (ends or {}).get(name) != PREEMPTED)
        return next(first, options[0])


def _concurrences_around(machine: Machine) -> dict[str, tuple[tuple[str, str], ...]]:
    """For each state the concurrences around it, and in which branch of each it is."""
    found: dict[str, tuple[tuple[str, str], ...]] = {machine.root.name: ()}
    for path, node in containers(machine.root):
        for child in node.children:
            own = ((path, child.name),) if isinstance(node, Concurrence) else ()
            found[f"{path}/{child.name}"] = (*found[path], *own)
    return found


def _caught(machine: Machine) -> set[str]:
    """The states whose exceptions a container around them catches, with no concurrence in between:
    how far its other branches come when one fails is for threads to decide, unless these wait."""
    found: set[str] = set()
    for path, node in containers(machine.root):
        if (node.catches or path in found) and not isinstance(node, Concurrence):
            found.update(f"{path}/{child.name}" for child in node.children)
    return found
