"""Path planning: outcomes that lead a machine to its end, or a container to a given outcome."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from types import MappingProxyType

from smachac.analysis.outcome_rules import Combination, Domains, Rules, UndecidedError
from smachac.ir import nodes
from smachac.ir.graph import START, Edge, Vertex, edges, exit_vertex
from smachac.ir.nodes import Concurrence, Container, Leaf, Machine, Node
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import containers, outcome_names, walk

Goals = Mapping[str, "str | Mapping[str, str]"]
"""By path of a container: its required outcome, or the required outcomes of its children by
name."""


def possible_leaf_outcomes(leaf: Leaf) -> tuple[str, ...]:
    """The possible outcomes of a leaf; for an open leaf also those that have a transition."""
    declared = outcome_names(leaf)
    led = tuple(edge.outcome for edge in leaf.transitions) if leaf.open else ()
    return tuple(dict.fromkeys((*declared, *led)))


def item_count(node: nodes.Iterator) -> int | None:
    """The number of items of an iterator, if the script lists them."""
    data = node.items.data if node.items is not None else None
    return len(data) if isinstance(data, tuple) else None


class Planner:
    """Reachability and shortest paths of a machine, computed from its graph alone.

    `possible` holds the outcomes that each state can have, `entered` the states that can be
    entered. The computation is linear in the size of the machine, except for concurrences with many
    rules.
    """

    def __init__(self, machine: Machine) -> None:
        self.root = machine.root
        self.nodes: dict[str, Node] = dict(walk(machine.root))
        self.possible: dict[str, frozenset[str]] = {}
        self.entered: set[str] = {machine.root.name}
        self._edges: dict[str, list[Edge]] = {}
        self._distances: dict[tuple[str, str | None], dict[Vertex, int]] = {}
        self._sources: dict[str, dict[Vertex, list[Edge]]] = {}
        self._rules: dict[str, Rules] = {}
        self._combined: dict[tuple[str, str | int | None], Combination | None] = {}
        self._undecided: set[str] = set()
        self._scenic: dict[str, tuple[str, ...]] = {}
        self._compute_outcomes()

    def _compute_outcomes(self) -> None:
        """Compute `possible`, from inner containers to outer ones, then `entered`."""
        inside: dict[str, frozenset[str]] = {}
        for path, node in reversed(list(containers(self.root))):
            for child in node.children:
                if isinstance(child, Leaf):
                    self.possible[f"{path}/{child.name}"] = frozenset(possible_leaf_outcomes(child))
            found = self._edges[path] = [
                edge
                for edge in edges(node)
                if not isinstance(edge.source, str)
                or edge.outcome in self.possible[f"{path}/{edge.source}"]
            ]
            if isinstance(node, nodes.Iterator) and item_count(node) == 0:
                found[:] = [
                    edge for edge in found if edge.kind == "exhausted" and edge.source == START
                ]
            places = _reachable_places(found)
            inside[path] = frozenset(place for place in places if isinstance(place, str))
            ends = (place[1] for place in places if isinstance(place, tuple) and len(place) == 2)
            if isinstance(node, Concurrence):
                ends = (end for end in ends if not self.cannot_end(path, end))
            caught = frozenset([node.catches] if node.catches and self._raises(node) else [])
            self.possible[path] = frozenset(ends) | caught
        for path, _ in containers(self.root):
            if path in self.entered:
                self.entered.update(f"{path}/{name}" for name in inside[path])

    def ends(self) -> bool:
        """Whether the machine can end at all."""
        return bool(self.possible[self.root.name])

    def outcomes_towards(self, goals: Goals = MappingProxyType({})) -> Callable[[str], str | None]:
        """A function from the path of a leaf to the outcome on the shortest way to the end of the
        machine, None if there is none.

        Containers in `goals` end with the given outcomes on the way. The plan may fail if it
        depends on concurrent branches.
        """
        choices: dict[str, str | None] = {}

        def outcome(path: str) -> str | None:
            if path in choices and path not in goals:
                return choices[path]
            here = self.root.name
            goal = goals.get(here)
            for name in path[len(here) + 1 :].split("/"):
                child = f"{here}/{name}"
                if child not in choices:
                    choices[child] = self._best(here, goal, name)
                here, goal = child, goals.get(child, choices[child])
            return choices[path]

        return outcome

    def longest_first(self, path: str) -> tuple[str, ...]:
        """The outcomes of a leaf, those farthest from the end of its container first.

        Outcomes that end the machine at once are left out.
        """
        if path not in self._scenic:
            around, _, name = path.rpartition("/")
            ordered = self._ordered(path)
            if isinstance(self.nodes[around], nodes.StateMachine | nodes.Sequence):
                distances = self._distances_to_end(around, None)
                far = {
                    edge.outcome: distances[edge.target]
                    for edge in self._outgoing(around, name)
                    if edge.target in distances
                }
                ordered.sort(key=lambda outcome: -far.get(outcome, -1))
                if around == self.root.name:
                    ordered = [outcome for outcome in ordered if far.get(outcome) != 0]
            self._scenic[path] = tuple(ordered)
        return self._scenic[path]

    def _best(self, path: str, goal: str | Mapping[str, str] | None, name: str) -> str | None:
        """The best outcome of a child of a container for a goal of the container."""
        node, here = self.nodes[path], f"{path}/{name}"
        if goal is not None and not isinstance(goal, str):
            return goal.get(name, next(iter(self._ordered(here)), None))
        if isinstance(node, Concurrence):
            found = self.combination(path, goal) or {}
            return found.get(name, next(iter(self._ordered(here)), None))
        if isinstance(node, nodes.Iterator):
            return self._iterator_outcome(node, goal, here)
        distances = self._distances_to_end(path, goal)
        known = {
            edge.outcome: distances[edge.target]
            for edge in self._outgoing(path, name)
            if edge.target in distances
        }
        ordered = [outcome for outcome in self._ordered(here) if outcome in known]
        return min(ordered, key=known.__getitem__, default=None)

    def _ordered(self, path: str) -> list[str]:
        """The possible outcomes of a state, in the order of the script."""
        node = self.nodes[path]
        names = possible_leaf_outcomes(node) if isinstance(node, Leaf) else outcome_names(node)
        return [name for name in names if name in self.possible[path]]

    def _outgoing(self, path: str, name: str) -> list[Edge]:
        """The edges that leave a child of a container."""
        if path not in self._sources:
            found = self._sources[path] = {}
            for edge in self._edges[path]:
                found.setdefault(edge.source, []).append(edge)
        return self._sources[path].get(name, [])

    def _iterator_outcome(self, node: nodes.Iterator, goal: str | None, here: str) -> str | None:
        """Loop to the last item, unless the goal requires that the child ends the iteration."""
        renamed = dict(node.final_map)
        ordered = self._ordered(here)
        loops = [outcome for outcome in ordered if outcome in node.loop_outcomes]
        if goal is None or renamed.get(node.exhausted_outcome, node.exhausted_outcome) == goal:
            return next(iter([*loops, *ordered]), None)
        breaks = [name for name in ordered if name not in loops and renamed.get(name, name) == goal]
        return next(iter([*breaks, *ordered]), None)

    def combination(self, path: str, goal: str | int | None) -> Combination | None:
        """Outcomes of the children with which a concurrence reaches a goal: an outcome, or the rule
        of that number (-1: its default). None if there are none, or if the search was given up."""
        if (path, goal) not in self._combined:
            node = self.nodes[path]
            assert isinstance(node, Concurrence)
            try:
                self._combined[path, goal] = self._combination(path, node, goal)
            except UndecidedError:
                self._combined[path, goal] = None
                self._undecided.add(path)
        return self._combined[path, goal]

    def cannot_end(self, path: str, goal: str | int) -> bool:
        """Whether a concurrence can certainly not reach a goal (see `combination`)."""
        return self.combination(path, goal) is None and path not in self._undecided

    def _combination(
        self, path: str, node: Concurrence, goal: str | int | None
    ) -> Combination | None:
        rules = self._rules.get(path)
        if rules is None:
            conditions = ({one.child: one.outcome for one in rule.when} for rule in node.rules)
            rules = self._rules[path] = Rules(conditions)
        results = dict(enumerate(rule.outcome for rule in node.rules))
        for number, result in {**results, -1: node.default_outcome}.items():
            if goal is not None and goal != (number if isinstance(goal, int) else result):
                continue
            given = rules.conditions[number] if number >= 0 else {}
            avoided = rules.larger_than(len(given)) if number >= 0 else rules.all
            for domains in self._domains(path, node):
                found = rules.find(domains, given, avoided)
                if found is not None:
                    return found
        return None

    def _domains(self, path: str, node: Concurrence) -> Iterator[Domains]:
        """The possible outcomes of the children. With `join: any` one child ends first, and leaves
        that can be preempted end as `preempted`."""
        able = {child.name: self._ordered(f"{path}/{child.name}") for child in node.children}
        if node.join == "all":
            yield able
            return
        stopped = {
            child.name: [PREEMPTED]
            for child in node.children
            if isinstance(child, Leaf) and PREEMPTED in able[child.name]
        }
        for first in able:
            yield {**able, **stopped, first: able[first]}

    def _distances_to_end(self, path: str, goal: str | None) -> dict[Vertex, int]:
        """For each place of a container, the number of states on the shortest way to its end."""
        if (path, goal) not in self._distances:
            node = self.nodes[path]
            assert not isinstance(node, Leaf)
            ends = (goal,) if goal is not None else outcome_names(node)
            planned = [edge for edge in self._edges[path] if not self._caught(path, edge)]
            self._distances[path, goal] = _distances_to(planned, [exit_vertex(end) for end in ends])
        return self._distances[path, goal]

    def _raises(self, node: Container) -> bool:
        """Whether an exception can come from inside a container."""
        if any(not child.catches for child in node.children):
            return True
        return isinstance(node, nodes.Iterator) and item_count(node) is None

    def _caught(self, path: str, edge: Edge) -> bool:
        """Whether an edge needs an exception inside a container."""
        node = self.nodes.get(f"{path}/{edge.source}")
        return node is not None and not isinstance(node, Leaf) and edge.outcome == node.catches


def _reachable_places(found: list[Edge]) -> dict[Vertex, None]:
    """The places that can be reached from the start."""
    import networkx as nx

    graph = nx.DiGraph()
    graph.add_node(START)
    graph.add_edges_from((edge.source, edge.target) for edge in found)
    return dict.fromkeys(nx.dfs_preorder_nodes(graph, START))


def _distances_to(found: list[Edge], ends: list[Vertex]) -> dict[Vertex, int]:
    """For each place, the number of edges to the nearest of some ends."""
    import networkx as nx

    reverse = nx.DiGraph()
    source = ("source of the search",)  # one node before all ends: no name of a state is a tuple
    reverse.add_node(source)
    reverse.add_edges_from((edge.target, edge.source) for edge in found)
    reverse.add_edges_from((source, end) for end in ends)
    lengths = nx.single_source_shortest_path_length(reverse, source)
    return {place: length - 1 for place, length in lengths.items() if place != source}
