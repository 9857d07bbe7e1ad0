"""Markov prediction: how a machine ends, how long it takes, and which failures cost most, computed
from the measured probabilities of its states.

Each container is an absorbing chain of its children; its outcomes are then those of one state in
the container around it. The next state depends on the last outcome alone: what a state with
conditions on counters or other keys does is predicted by its mean. Branches of a concurrence are
independent. Where the graph is not enough (`join: any`, an iterator over computed items) the
measured outcomes of the container itself are used.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from itertools import product
from math import prod

from smachac.analysis.absorbing_chain import absorption
from smachac.diagnostics.source import assert_never
from smachac.ir import nodes
from smachac.ir.concurrence_rules import outcome_of
from smachac.ir.nodes import Concurrence, Container, Leaf, Machine, Node, StateMachine
from smachac.ir.outcome_names import PREEMPTED, fails
from smachac.ir.traversal import leads_to_child, walk
from smachac.records import dataclass, field

Probabilities = Mapping[str, float]
"""The probability of each outcome of one state."""

MOST_COMBINATIONS = 20_000
"""Limit on the combinations of the outcomes of branches that are added up."""


@dataclass(frozen=True, slots=True)
class Measured:
    """What was measured of one state: its visits that ended, the frequencies of its outcomes, and
    its mean duration (s)."""

    visits: int
    outcomes: Probabilities
    seconds: float = 0.0


@dataclass(frozen=True, slots=True)
class Prediction:
    """One visit of a state: the probability of each outcome, the expected duration (s), and the
    expected visits of the states below it, by full path."""

    outcomes: Probabilities
    seconds: float
    visits: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Sensitivity:
    """The failure `outcome` of the leaf at `path`: `gain` is the probability of success that the
    machine would gain if the state had its other outcomes instead, in their proportions."""

    path: str
    outcome: str
    probability: float
    gain: float


class NoMeasurementError(Exception):
    """A state can be reached, but nothing was measured of it; `path` is that state."""

    def __init__(self, path: str) -> None:
        super().__init__(f"`{path}` can be reached, but nothing was measured of it")
        self.path = path


class MarkovModel:
    """A machine and what was measured of its states, by full path.

    `as_measured` are the containers whose measured outcomes are used. Raises NoMeasurementError and
    EndlessChainError.
    """

    def __init__(self, machine: Machine, measured: Mapping[str, Measured]) -> None:
        self.root = machine.root
        self.measured = measured
        self.as_measured: list[str] = []
        self._nodes = dict(walk(machine.root))
        self._known: dict[str, Prediction] = {}
        for path, node in reversed(self._nodes.items()):  # children before their containers
            if path in measured:
                self._known[path] = self._predicted(path, node)
        if self.root.name not in self._known:
            raise NoMeasurementError(self.root.name)

    @property
    def prediction(self) -> Prediction:
        """The prediction of the whole machine."""
        return self._known[self.root.name]

    def sensitivities(self, successes: Collection[str]) -> list[Sensitivity]:
        """The failures of leaves that cost a success, the one with the largest gain first.

        Leaves below a container of `as_measured` are left out.
        """
        base = _share(self.prediction, successes)
        hidden = tuple(f"{path}/" for path in self.as_measured)
        found = []
        for path, node in self._nodes.items():
            if not isinstance(node, Leaf) or path not in self.measured or path.startswith(hidden):
                continue
            for outcome, probability in self.measured[path].outcomes.items():
                if fails(node, outcome) and 0 < probability < 1:
                    gain = _share(self._without(path, outcome), successes) - base
                    found.append(Sensitivity(path, outcome, probability, gain))
        return sorted(found, key=lambda sensitivity: -sensitivity.gain)

    def _without(self, path: str, outcome: str) -> Prediction:
        """The prediction of the machine if a leaf never has an outcome: only the containers around
        the leaf are computed again."""
        before = dict(self._known)
        others = {name: p for name, p in self._known[path].outcomes.items() if name != outcome}
        total = sum(others.values())
        shares = {name: p / total for name, p in others.items()}
        self._known[path] = Prediction(shares, self._known[path].seconds)
        while "/" in path:
            path = path.rpartition("/")[0]
            self._known[path] = self._predicted(path, self._nodes[path])
        changed, self._known = self.prediction, before
        return changed

    def _predicted(self, path: str, node: Node) -> Prediction:
        match node:
            case Leaf():
                own = self.measured[path]
                return Prediction(own.outcomes, own.seconds)
            case StateMachine() | nodes.Sequence():
                return self._of_machine(path, node)
            case nodes.Iterator():
                return self._of_iterator(path, node)
            case Concurrence():
                return self._of_concurrence(path, node)
        return assert_never(node)

    def _of_machine(self, path: str, node: StateMachine | nodes.Sequence) -> Prediction:
        """An absorbing chain whose states are the children; its ends are outcomes."""
        names = frozenset(child.name for child in node.children)
        rows: dict[tuple[str, str], dict[tuple[str, str], float]] = {}
        for child in node.children:
            if f"{path}/{child.name}" not in self._known:
                continue
            row = rows.setdefault(("state", child.name), {})
            targets = {
                edge.outcome: ("state" if leads_to_child(edge, names) else "end", edge.target)
                for edge in child.transitions
            }
            for outcome, probability in self._known[f"{path}/{child.name}"].outcomes.items():
                target = targets.get(outcome, ("end", outcome))
                row[target] = row.get(target, 0.0) + probability
        for row in rows.values():
            for kind, name in row:
                if kind == "state" and (kind, name) not in rows:
                    raise NoMeasurementError(f"{path}/{name}")
        start = ("state", node.initial or node.children[0].name)
        if start not in rows:
            raise NoMeasurementError(f"{path}/{start[1]}")
        visits, ends = absorption(rows, start)
        weights = {f"{path}/{name}": number for (_, name), number in visits.items()}
        return self._weighted({name: p for (_, name), p in ends.items()}, weights)

    def _weighted(
        self, outcomes: Probabilities, weights: Mapping[str, float], seconds: float | None = None
    ) -> Prediction:
        """A container whose children are visited so many times. Without `seconds` they run one
        after the other."""
        visits = dict(weights)
        for path, weight in weights.items():
            for below, number in self._known[path].visits.items():
                visits[below] = visits.get(below, 0.0) + weight * number
        if seconds is None:
            seconds = sum(weight * self._known[path].seconds for path, weight in weights.items())
        return Prediction(outcomes, seconds, visits)

    def _of_iterator(self, path: str, node: nodes.Iterator) -> Prediction:
        """A geometric series that ends with the last item."""
        here = f"{path}/{node.children[0].name}" if node.children else ""
        items = node.items.data if node.items is not None else None
        if here not in self._known or not isinstance(items, tuple) or self._stopped(path):
            return self._as_measured(path, node)
        child = self._known[here].outcomes
        loop = sum(p for outcome, p in child.items() if outcome in node.loop_outcomes)
        count = len(items)
        rounds = float(count) if loop >= 1 else (1 - loop**count) / (1 - loop)
        final = dict(node.final_map)
        ends = {final.get(node.exhausted_outcome, node.exhausted_outcome): loop**count}
        for outcome, probability in child.items():
            if outcome not in node.loop_outcomes:
                name = final.get(outcome, outcome)
                ends[name] = ends.get(name, 0.0) + rounds * probability
        return self._weighted({name: p for name, p in ends.items() if p}, {here: rounds})

    def _of_concurrence(self, path: str, node: Concurrence) -> Prediction:
        """All combinations of the outcomes of branches that do not depend on each other.

        A time limit has the outcomes of its state; where it stops the state, it ends with its
        default outcome, `timeout`.
        """
        here = [f"{path}/{child.name}" for child in node.children]
        own = self.measured[path]
        if any(text not in self._known for text in here) or self._stopped(path):
            return self._as_measured(path, node)
        if node.sugar:
            outcomes = dict(self._known[here[0]].outcomes)
            if PREEMPTED in outcomes:
                late = outcomes.pop(PREEMPTED)
                outcomes[node.default_outcome] = outcomes.get(node.default_outcome, 0.0) + late
            return self._weighted(outcomes, dict.fromkeys(here, 1.0), own.seconds)
        branches = [self._known[text].outcomes for text in here]
        if node.join == "any" or prod(map(len, branches)) > MOST_COMBINATIONS:
            return self._as_measured(path, node)
        names = [child.name for child in node.children]
        ends: dict[str, float] = {}
        for combination in product(*(branch.items() for branch in branches)):
            ended = dict(zip(names, (outcome for outcome, _ in combination), strict=True))
            name = outcome_of(node, ended)
            ends[name] = ends.get(name, 0.0) + prod(p for _, p in combination)
        return self._weighted(ends, dict.fromkeys(here, 1.0), own.seconds)

    def _stopped(self, path: str) -> bool:
        """Whether runs of a container were stopped from outside."""
        return PREEMPTED in self.measured[path].outcomes

    def _as_measured(self, path: str, node: Container) -> Prediction:
        """A container with the outcomes and the visits of children that were measured."""
        if path not in self.as_measured:
            self.as_measured.append(path)
        own = self.measured[path]
        weights = {
            here: self.measured[here].visits / own.visits
            for here in (f"{path}/{child.name}" for child in node.children)
            if here in self._known
        }
        return self._weighted(own.outcomes, weights, own.seconds)


def _share(prediction: Prediction, outcomes: Collection[str]) -> float:
    return sum(p for name, p in prediction.outcomes.items() if name in outcomes)
