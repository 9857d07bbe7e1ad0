"""Properties of a machine: whether they hold on all its paths.

The product of the machine's configurations (execution.py) and the property's automaton
(property_automaton.py) is searched breadth-first, so a counterexample is a shortest one.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from typing import Literal, NamedTuple, TypeAlias

from smachac.analysis.execution import (
    STOP,
    Config,
    Event,
    Execution,
    ExecutionStep,
    TooLargeError,
    leaves,
)
from smachac.analysis.property_automaton import BAD, LEAF, PREMISE, Automaton, automaton, parts
from smachac.analysis.property_events import NamedStates, NameFault
from smachac.analysis.resource_claims import Held
from smachac.diagnostics.diagnostic import PathStep, ended, entered
from smachac.ir.nodes import Iterator, Leaf, StateMachine
from smachac.ir.properties import After, AlwaysEnds, Exceptions, Property

MOST_PAIRS, PAIRS_BY_STATE = 50_000, 30
"""Limit on the pairs of a configuration and a state of the automaton that are examined, about two
seconds of CPU time, and so many more for each state of the machine. Each property that is not
decided halves it for the others."""

STEPS_OF_A_PAIR = 3
"""The limit on the steps that are examined, for each pair of the limit above: a configuration of
many branches has many steps."""

MOST_IN_ALL = 5_000_000
"""Limit on the pairs that are examined for all properties of a machine."""

Verdict = Literal["holds", "fails", "vacuous", "undecided", "unclear"]
"""`vacuous`: it holds because what it is about cannot happen. `undecided`: there are too many
configurations. `unclear`: its names have faults."""


class Visit(NamedTuple):
    """One visit of a leaf in a counterexample, by path: its outcome, None for an exception.
    `stop`: a request to stop arrives as it begins."""

    path: str
    outcome: str | None
    stop: bool


class Counterexample(NamedTuple):
    """The visits of leaves up to the violation.

    `node` and `outcome` are the event that violates the property: the state at a path is entered
    (None) or ends; `node` is empty where it is the end of the run. `again` is the number of the
    visit from which the visits are repeated for ever, -1 if they are not. `last` is what the path
    leads to: a state, by path, or the outcome of the machine.
    """

    visits: tuple[Visit, ...]
    node: str = ""
    outcome: str | None = None
    again: int = -1
    last: str = ""


def witness(example: Counterexample) -> tuple[PathStep, ...]:
    """A counterexample as a witness path: the leaves that are visited and their outcomes."""
    steps: list[PathStep] = []
    for visit in example.visits:
        steps.append(entered(visit.path.rpartition("/")[2], visit.path))
        outcome = visit.outcome if visit.outcome is not None else "exception"
        steps.append(ended(f"stop request, {outcome}" if visit.stop else outcome))
    if example.last:
        steps.append(entered(example.last.rpartition("/")[2], example.last))
    return tuple(steps)


class Judgement(NamedTuple):
    """A property with its verdict. `states` are the paths of the states that it names."""

    property: Property
    verdict: Verdict
    counterexample: Counterexample | None = None
    faults: tuple[NameFault, ...] = ()
    states: tuple[str, ...] = ()


def judge(properties: Sequence[Property], root: StateMachine, claims: Held) -> list[Judgement]:
    """The verdicts on the properties of a machine. None are given where the machine is incomplete.

    The steps of a machine are computed once for properties over the same kind of paths.
    """
    if not properties:
        return []
    plain = Execution(root)
    if not plain.is_complete:
        return []
    names = NamedStates(plain.paths, plain.nodes, claims)
    executions: dict[tuple[Exceptions, bool, bool], Execution] = {("caught", True, False): plain}
    found: list[Judgement] = []
    limit, left = MOST_PAIRS + PAIRS_BY_STATE * len(plain.nodes), MOST_IN_ALL
    iterates = any(isinstance(node, Iterator) for node in plain.nodes)
    for property_ in properties:
        few = iterates and isinstance(property_.form, AlwaysEnds)
        key = (property_.exceptions, property_.stops, few)
        if key not in executions:
            executions[key] = Execution(
                root, exceptions=property_.exceptions, stops=property_.stops, few_items=few
            )
        judgement, used = _judged(property_, executions[key], names, min(limit, left))
        found.append(judgement)
        left -= used
        if judgement.verdict == "undecided":
            limit //= 2
    return found


def _judged(
    given: Property, execution: Execution, names: NamedStates, limit: int
) -> tuple[Judgement, int]:
    """The verdict on a property, and the number of pairs that were examined."""
    watched: dict[Event, int] = {}
    faults: list[NameFault] = []
    for part in parts(given.form):
        for atom in part.atoms:
            events = names.resolve(atom)
            if isinstance(events, NameFault):
                faults.append(events)
                continue
            for event in events:
                watched[event] = watched.get(event, 0) | part.bits
    states = tuple(
        execution.paths[number] for number in dict.fromkeys(number for number, _ in watched)
    )
    if faults:
        return Judgement(given, "unclear", None, tuple(faults), states), 0
    if isinstance(given.form, After) and given.form.within:
        for number, node in enumerate(execution.nodes):
            if isinstance(node, Leaf):
                watched[number, None] = watched.get((number, None), 0) | LEAF
    verdict: Verdict = "holds"
    try:
        if isinstance(given.form, AlwaysEnds):
            counterexample, used = _endless(execution, limit)
        else:
            search = _Search(execution, automaton(given.form), watched)
            counterexample, used = search.run(limit), len(search.before)
            if _has_premise(given) and not search.seen & PREMISE:
                verdict = "vacuous"
    except TooLargeError:
        return Judgement(given, "undecided", None, (), states), limit
    verdict = "fails" if counterexample is not None else verdict
    return Judgement(given, verdict, counterexample, (), states), used


def _has_premise(given: Property) -> bool:
    return any(part.atoms and part.bits == PREMISE for part in parts(given.form))


END: Event = (0, "")
"""In place of an event: the run ends although an answer is missing."""

Pair: TypeAlias = "tuple[Config, int]"
"""A configuration and a state of the automaton."""


class _Search:
    """A breadth-first search of the product; `seen` are the bits of all events met.

    By hand: a property over 10,000 states takes 0.35 s of CPU time; a graph of networkx would
    first hold all of the product, of which the search needs only the part before a violation.
    """

    def __init__(
        self, execution: Execution, table: Automaton, watched: Mapping[Event, int]
    ) -> None:
        self.execution = execution
        self.automaton = table
        self.watched = watched
        self.seen = 0
        self.before: dict[Pair, tuple[Pair | None, ExecutionStep]] = {}

    def run(self, limit: int) -> Counterexample | None:
        """A shortest violation; None if there is none. Raises TooLargeError."""
        todo: deque[Pair] = deque()
        steps: dict[Config, list[ExecutionStep]] = {}
        examined = 0
        for step in self.execution.start(self.watched):
            if (bad := self._follow(None, 0, step, todo)) is not None:
                return self._counterexample(None, step, bad)
        while todo:
            pair = todo.popleft()
            config, state = pair
            following = steps.get(config)
            if following is None:
                following = steps[config] = self.execution.steps(config, self.watched)
            for step in following:
                if (bad := self._follow(pair, state, step, todo)) is not None:
                    return self._counterexample(pair, step, bad)
            examined += len(following)
            if len(self.before) > limit or examined > STEPS_OF_A_PAIR * limit:
                raise TooLargeError
        return None

    def _follow(
        self, pair: Pair | None, state: int, step: ExecutionStep, todo: deque[Pair]
    ) -> Event | None:
        """Take a step; the event that violates the property, None if none does."""
        for event in step.events:
            bits = self.watched[event]
            self.seen |= bits
            state = self.automaton.table[state][bits]
            if state == BAD:
                return event
        if state in self.automaton.open_ends and step.config.outcome is not None:
            return END
        after = (step.config, state)
        if after not in self.before:
            self.before[after] = (pair, step)
            todo.append(after)
        return None

    def _counterexample(self, pair: Pair | None, last: ExecutionStep, bad: Event) -> Counterexample:
        steps = [last]
        while pair is not None:
            pair, step = self.before[pair]
            steps.append(step)
        visits = _visits(self.execution, steps[::-1])
        node = "" if bad == END else self.execution.paths[bad[0]]
        then = node if bad[1] is None else self._last(last)
        return Counterexample(visits, node, bad[1], last=then)

    def _last(self, step: ExecutionStep) -> str:
        """The state or the outcome that a step leads to."""
        if step.config.outcome is not None:
            return step.config.outcome[0] or "the run ends"
        return self.execution.paths[next(leaves(step.config.control))]


def _visits(execution: Execution, steps: Iterable[ExecutionStep]) -> tuple[Visit, ...]:
    found: list[Visit] = []
    stop = False
    for step in steps:
        if step.leaf >= 0:
            found.append(Visit(execution.paths[step.leaf], step.outcome, stop))
        stop = step.leaf == STOP
    return tuple(found)


def _endless(execution: Execution, limit: int) -> tuple[Counterexample | None, int]:
    """The shortest way to a loop that can go on for ever without further requests to stop, or to a
    state that never ends; and the number of configurations. Raises TooLargeError."""
    numbers: dict[Config, int] = {}
    before: list[Arrival] = []
    ahead: list[list[Arrival]] = []

    def reach(here: int, step: ExecutionStep) -> int:
        """The number of the configuration after a step, which is added if it is new."""
        number = numbers.setdefault(step.config, len(before))
        if number == len(before):
            before.append((here, step))
        return number

    for step in execution.start(()):
        reach(-1, step)
    for here, (_, last) in enumerate(before):  # which grows
        following = execution.steps(last.config, ())
        if last.config.outcome is None and all(step.leaf == STOP for step in following):
            return Counterexample(_visits(execution, _steps_to(here, before))), len(before)
        reached = [(reach(here, step), step) for step in following]
        ahead.append([pair for pair in reached if pair[1].leaf != STOP])
        if len(before) > limit:
            raise TooLargeError
    first = _first_in_loop(ahead)
    if first is None:
        return None, len(before)
    there = _visits(execution, _steps_to(first, before))
    around = _visits(execution, _circle(first, ahead))
    visits = (*there, *around)
    return Counterexample(visits, again=len(there), last=around[0].path), len(before)


Arrival: TypeAlias = "tuple[int, ExecutionStep]"
"""A step with the number of another configuration: in a list of what comes before, of the one from
which it leads, -1 for none; in a list of what follows, of the one to which it leads."""


def _first_in_loop(ahead: Sequence[Sequence[Arrival]]) -> int | None:
    """The first configuration to which steps lead back. `ahead`: the steps from each."""
    if _is_acyclic(ahead):
        return None
    import networkx as nx

    graph = nx.DiGraph()
    graph.add_edges_from(
        (here, there) for here, sequence in enumerate(ahead) for there, _ in sequence
    )
    loops = (
        min(region)
        for region in nx.strongly_connected_components(graph)
        if len(region) > 1 or any(graph.has_edge(item, item) for item in region)
    )
    return min(loops, default=None)


def _is_acyclic(ahead: Sequence[Sequence[Arrival]]) -> bool:
    """Whether no steps lead back: all configurations can be sorted topologically.

    By hand: for 20,000 configurations it takes 15 ms of CPU time; a graph of networkx takes 120 ms,
    and its import as long again.
    """
    waiting = [0] * len(ahead)
    for following in ahead:
        for there, _ in following:
            waiting[there] += 1
    done = [number for number, count in enumerate(waiting) if not count]
    for here in done:  # which grows
        for there, _ in ahead[here]:
            waiting[there] -= 1
            if not waiting[there]:
                done.append(there)
    return len(done) == len(ahead)


def _steps_to(number: int, before: Sequence[Arrival]) -> list[ExecutionStep]:
    """The steps from the start to a configuration. `before`: the last step to each."""
    steps: list[ExecutionStep] = []
    while number >= 0:
        number, step = before[number]
        steps.append(step)
    return steps[::-1]


def _circle(start: int, ahead: Sequence[Sequence[Arrival]]) -> list[ExecutionStep]:
    """The steps of a shortest circle from a configuration back to it."""
    before: dict[int, Arrival] = {}
    todo = deque([start])
    while start not in before:
        here = todo.popleft()
        for following, step in ahead[here]:
            if following not in before:
                before[following] = here, step
                todo.append(following)
    steps: list[ExecutionStep] = []
    here = start
    while not steps or here != start:
        here, step = before[here]
        steps.append(step)
    return steps[::-1]
