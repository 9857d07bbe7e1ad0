"""Paths: runs of the interpreter in which a strategy chooses each outcome.

Hierarchy, concurrences and iterators need no rules of their own here, and the choices of a run are
its scenario. In a concurrence that ends with its first branch (`join: any`) the strategy also
chooses that branch: leaves of the other branches wait until they are preempted.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from typing import Literal, NamedTuple

from smachac.interpreter.behaviours import builtin_behaviour, is_made_of_functions
from smachac.interpreter.evaluator import can_evaluate
from smachac.interpreter.interpreter import run
from smachac.interpreter.result import Event
from smachac.interpreter.scenario import Scenario, ScenarioStep, perform_step
from smachac.interpreter.userdata import Userdata
from smachac.ir import nodes
from smachac.ir.expressions import parse_expression
from smachac.ir.leaf import default_outcome
from smachac.ir.nodes import Concurrence, Expression, Leaf, Machine, Node, StateMachine
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import containers, expressions, outcome_names, walk
from smachac.records import dataclass, field
from smachac.verify.coverage import Coverage
from smachac.verify.guidance import Goals, Planner, possible_leaf_outcomes
from smachac.verify.sample_values import SampleValues, sample_inputs
from smachac.verify.shared_keys import contended_keys

FAILURE = "a failure of the scenario"
"""The message of an error that a path raises in a leaf."""

CUT = "the scenario ends here"
"""The message of the error that ends a path without an end."""

FAILS = ""
"""The option of a leaf to raise an exception, if a container around it catches exceptions."""

FAILS_FIRST = "fails: "
"""Prefix of a branch name: the option of a concurrence that this branch fails first."""

START = -1
"""The number of a request to stop before the start."""

Kind = Literal["covering", "stopped", "simple", "random"]


class Choice(NamedTuple):
    """An outcome chosen for the leaf `place`, or the branch of the concurrence `place` that ends
    first."""

    place: str
    options: tuple[str, ...]
    taken: str | None


Strategy = Callable[[str, tuple[str, ...], int], "str | None"]
"""Chooses one of the options of a place; it also receives the number of choices so far. None ends
the path."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Path:
    """One path through a machine, as a scenario.

    `live`: states made of functions are not in the scenario and run their own code. `ends`: the
    path ends with an outcome, not with an error. `visits` counts visits of leaves. `stopped`: a
    request to stop comes before the start.
    """

    kind: Kind
    scenario: Scenario
    live: bool
    ends: bool
    visits: int
    stopped: bool = False


@dataclass(slots=True)
class PathRun:
    """The state of one run while a path is recorded. `raced`: a concurrence with `join: rule` has
    stopped branches; how far they are depends on the scheduling of threads."""

    strategy: Strategy
    live: frozenset[str]
    stops: set[int]
    choices: list[Choice] = field(default_factory=list)
    steps: dict[str, list[ScenarioStep]] = field(default_factory=dict)
    first: dict[str, str] = field(default_factory=dict)
    failing: dict[str, str] = field(default_factory=dict)
    visits: int = 0
    ended: dict[str, set[str]] = field(default_factory=dict)
    stopped: set[str] = field(default_factory=set)
    raced: bool = False


class PathRunner:
    """Records the paths of one machine, as strategies choose them, and the coverage of all of them.

    `coverage` holds the covered items, `tried` the outcomes chosen by leaf, `entries` the choices
    before the first entry of each state. `made` counts paths, `spent` the states entered (plus a
    tenth of the machine for each run), `endless` the runs given up. `live` holds the leaves that
    may run their own code.
    """

    def __init__(self, machine: Machine) -> None:
        self.machine = machine
        self.coverage = Coverage(machine)
        self.planner = Planner(machine)
        self.made = self.spent = self.endless = 0
        self.tried: set[tuple[str, str]] = set()
        self.entries: dict[str, tuple[list[Choice], int]] = {}
        self._seen: set[int] = set()
        self._outcome_to_end = self.planner.outcomes_towards()
        self._tree = dict(walk(machine.root))
        self._enclosing = _concurrences_around(machine)
        self._caught = _caught(machine)
        self._waiting = {
            path: all(_starts_with_wait(child) for child in node.children)
            for path, node in containers(machine.root)
            if isinstance(node, Concurrence)
        }
        self._sample_values = SampleValues(machine)
        self._inputs = sample_inputs(machine)
        self.leaves = [path for path, node in self._tree.items() if isinstance(node, Leaf)]
        self.live = frozenset(filter(self._is_live, self.leaves))
        if contended_keys(machine):
            self.live = frozenset()
        self._limit = 20 * len(self.leaves) + 10_000

    def _is_live(self, path: str) -> bool:
        node = self._tree[path]
        made = isinstance(node, Leaf) and is_made_of_functions(node)
        return made and all(map(_is_evaluated, expressions(node))) and not self._enclosing[path]

    def make(
        self, kind: Kind, strategy: Strategy, *, live: bool = False, stops: Collection[int] = ()
    ) -> tuple[PathRun, Path | None]:
        """Run the machine with a strategy. The path is None if it is a duplicate, has no end, or
        depends on the scheduling of threads.

        At the choices with the numbers `stops` the machine is preempted, at START before it starts.
        Inside a concurrence this is left out unless all other branches wait for a request: else it
        depends on the scheduling of threads how far they are.
        """
        path_run = PathRun(strategy, self.live if live else frozenset(), set(stops))
        others = builtin_behaviour()

        def behave(path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
            path_run.visits += 1
            if path in path_run.live:
                return others(path, leaf, visit, userdata)
            return self._step(path_run, path, leaf, userdata)

        result = run(
            self.machine,
            behave,
            lambda event: self._record(path_run, event),
            schedule=(),
            max_steps=3 * self._limit,
            userdata=self._inputs,
            preempt_at=[0] if START in stops else (),
        )
        self.spent += result.steps + len(self._tree) // 10
        if result.error is not None and result.error.kind == "no-end":
            self.endless += 1
            return path_run, None
        if path_run.raced:
            return path_run, None
        mark = hash(
            (live, *stops, tuple((choice.place, choice.taken) for choice in path_run.choices))
        )
        if mark in self._seen:
            return path_run, None
        self._seen.add(mark)
        self.made += 1
        steps = {path: tuple(row) for path, row in path_run.steps.items()}
        return path_run, Path(
            kind=kind,
            scenario=Scenario(steps=steps),
            live=live,
            ends=result.error is None,
            visits=path_run.visits,
            stopped=START in stops,
        )

    def _step(self, path_run: PathRun, path: str, leaf: Leaf, userdata: Userdata) -> str:
        """Choose the step of a leaf, record it and perform it."""
        number = len(path_run.choices)
        stop = number in path_run.stops and self._others_wait(path_run, path)
        if stop:
            path_run.stops.discard(number)
            userdata.stop_machine()
        wait = self._waits(path_run, path, userdata.preempted)
        row = path_run.steps.setdefault(path, [])
        if PREEMPTED in outcome_names(leaf) and (wait or userdata.preempted):
            # A leaf that the request does not reach ends with its default outcome.
            row.append(ScenarioStep(outcome=default_outcome(leaf), wait=wait, stop=stop))
        elif path in path_run.failing.values():
            row.append(ScenarioStep(error=FAILURE, wait=wait, stop=stop))
        else:
            options = possible_leaf_outcomes(leaf) or (default_outcome(leaf),)
            options += (FAILS,) * (path in self._caught and not leaf.catches)
            outcome = self._choose(path_run, path, options)
            if outcome is None and self._enclosing[path]:
                outcome = self._outcome_to_end(path) or default_outcome(leaf)
            if outcome is None:
                row.append(ScenarioStep(error=CUT, stop=stop))
            elif outcome in (FAILS, leaf.catches):
                row.append(ScenarioStep(error=FAILURE, wait=wait, stop=stop))
            else:
                writes = self._sample_values.outputs(path, leaf, outcome, len(row))
                row.append(ScenarioStep(outcome=outcome, writes=writes, wait=wait, stop=stop))
        return perform_step(row[-1], leaf, userdata)

    def _choose(self, path_run: PathRun, place: str, options: tuple[str, ...]) -> str | None:
        usual = self._usual(place, options)
        options = tuple(dict.fromkeys((usual, *options)))
        taken = None
        if len(path_run.choices) < self._limit:
            taken = path_run.strategy(place, options, len(path_run.choices))
        path_run.choices.append(Choice(place, options, taken))
        if taken is not None:
            self.tried.add((place, taken))
        return taken

    def _usual(self, place: str, options: tuple[str, ...]) -> str:
        node = self._tree[place]
        usual = default_outcome(node) if isinstance(node, Leaf) else options[0]
        return usual if usual in options else options[0]

    def _waits(self, path_run: PathRun, path: str, requested: bool) -> bool:
        """Whether a leaf waits to be preempted: another branch was chosen to end first, and no
        earlier leaf of this branch has waited. `requested`: the leaf has a request already;
        otherwise it comes later."""
        return any(
            (first := path_run.first.get(around)) is not None
            and branch != first
            and (
                requested
                or (first not in path_run.ended[around] and around not in path_run.stopped)
            )
            for around, branch in self._enclosing[path]
        )

    def _others_wait(self, path_run: PathRun, path: str) -> bool:
        """Whether all other branches of the concurrences around a leaf wait for a request."""
        return all(
            path_run.first.get(around) == branch
            and around not in path_run.stopped
            and not path_run.ended[around]
            and self._waiting[around]
            for around, branch in self._enclosing[path]
        )

    def _record(self, path_run: PathRun, event: Event) -> None:
        """Update coverage and entries with an event."""
        path = event["path"]
        if event["event"] == "preempt":
            around = path.rpartition("/")[0]
            node = self._tree.get(around)
            by_rule = isinstance(node, Concurrence) and node.join == "rule"
            path_run.raced |= by_rule and around not in path_run.stopped
            path_run.stopped.add(path)
        if not path_run.raced:
            self.coverage.record(event)
        if event["event"] in ("exit", "error"):
            path_run.stopped.discard(path)
        if event["event"] == "enter":
            if path not in self.entries:
                self.entries[path] = (path_run.choices, len(path_run.choices))
            node = self._tree[path]
            if isinstance(node, Concurrence):
                self._start(path_run, path, node)
        elif event["event"] in ("exit", "error"):
            around, _, name = path.rpartition("/")
            if around in path_run.ended:
                path_run.ended[around].add(name)

    def _start(self, path_run: PathRun, path: str, node: Concurrence) -> None:
        """At the entry of a concurrence: choose the branch that ends or fails first, if there is a
        choice."""
        path_run.ended[path] = set()
        path_run.first.pop(path, None)
        path_run.failing.pop(path, None)
        options = [child.name for child in node.children] if node.join == "any" else [""]
        alone = all(isinstance(child, Leaf) for child in node.children)
        if node.join == "all" and alone and len(path_run.choices) in path_run.stops:
            first = node.children[0].name
            path_run.first[path] = first
            if self._waiting[path] and self._others_wait(path_run, f"{path}/{first}"):
                return  # the first branch, which chooses next, requests a stop
            del path_run.first[path]
        if node.catches or path in self._caught:
            able = (child for child in node.children if isinstance(child, Leaf))
            options += [f"{FAILS_FIRST}{child.name}" for child in able if not child.catches]
        if options == [""]:
            return
        taken = self._choose(path_run, path, tuple(options)) or options[0]
        name = taken.removeprefix(FAILS_FIRST)
        if name:
            path_run.first[path] = name
        if name != taken:
            path_run.failing[path] = f"{path}/{name}"

    def towards_end(self, place: str, options: Sequence[str]) -> str | None:
        """The choice on the shortest way to the end of the machine; None if it cannot end."""
        return self.towards(self._outcome_to_end, {}, place, options)

    def towards(
        self,
        best_outcome: Callable[[str], str | None],
        goals: Goals,
        place: str,
        options: Sequence[str],
    ) -> str | None:
        """The choice towards some goals: the outcome of a leaf, or the branch of a concurrence that
        ends first (empty: all end)."""
        if isinstance(self._tree[place], Leaf):
            return best_outcome(place)
        goal = goals.get(place, best_outcome(place))
        ends = self.planner.combination(place, goal) if isinstance(goal, str) else goal
        names = (name for name in options if not name.startswith(FAILS_FIRST))
        first = (name for name in names if (ends or {}).get(name) != PREEMPTED)
        return next(first, options[0])


def _is_evaluated(expression: Expression) -> bool:
    """Whether the interpreter evaluates a function of the script."""
    expr = parse_expression(expression.text)
    return expr is not None and can_evaluate(expr, ("ud", "userdata"))


def _starts_with_wait(node: Node) -> bool:
    """Whether the leaves that a state starts with can all wait for a request."""
    match node:
        case Leaf():
            return PREEMPTED in outcome_names(node)
        case StateMachine() | nodes.Sequence():
            first = [child for child in node.children if child.name == node.initial]
            return all(map(_starts_with_wait, first or node.children[:1]))
    return all(map(_starts_with_wait, node.children))


def _concurrences_around(machine: Machine) -> dict[str, tuple[tuple[str, str], ...]]:
    """For each state the concurrences around it, with the branch that it belongs to."""
    found: dict[str, tuple[tuple[str, str], ...]] = {machine.root.name: ()}
    for path, node in containers(machine.root):
        for child in node.children:
            own = ((path, child.name),) if isinstance(node, Concurrence) else ()
            found[f"{path}/{child.name}"] = (*found[path], *own)
    return found


def _caught(machine: Machine) -> set[str]:
    """The states whose exceptions are caught by a container around them, without a concurrence in
    between.

    When a branch fails it depends on the scheduling of threads how far the other branches come,
    unless they wait.
    """
    found: set[str] = set()
    for path, node in containers(machine.root):
        if (node.catches or path in found) and not isinstance(node, Concurrence):
            found.update(f"{path}/{child.name}" for child in node.children)
    return found
