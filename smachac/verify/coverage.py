"""Which ways through a machine runs have taken, and which they have not."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Literal, NamedTuple

from smachac.diagnostics.source import Span
from smachac.interpreter.result import Event
from smachac.ir import nodes
from smachac.ir.nodes import Concurrence, Container, Leaf, Machine
from smachac.ir.traversal import containers, leads_to_child, outcome_names
from smachac.verify.guidance import Steering, count_of_items, leaf_outcomes, winner


class Way(NamedTuple):
    """One way on: an outcome of the state at `path` leads to `target`.

    For a concurrence it is one of its rules, by number, or -1 for its default, `path` is its own.
    An outcome of an iterator's child goes on (`loop`), ends it (`break`), or was the last
    (`exhausted`).
    """

    kind: Literal["transition", "rule", "loop", "break", "exhausted"]
    path: str
    outcome: str
    target: str
    rule: int = 0


def ways(machine: Machine) -> dict[Way, Span]:
    """Every way of a machine, in the order of the script, with its place."""
    return {way: span for path, node in containers(machine.root) for way, span in _ways(path, node)}


def _ways(path: str, node: Container) -> Iterator[tuple[Way, Span]]:
    if isinstance(node, Concurrence):
        for number, rule in enumerate(node.rules):
            yield Way("rule", path, rule.outcome, _out(path, rule.outcome), number), rule.span
        if node.default_outcome:
            target = _out(path, node.default_outcome)
            yield Way("rule", path, node.default_outcome, target, -1), node.default_span
        return
    names = frozenset(child.name for child in node.children)
    for child in node.children:
        here = f"{path}/{child.name}"
        own = leaf_outcomes(child) if isinstance(child, Leaf) else outcome_names(child)
        if isinstance(node, nodes.Iterator):
            for outcome in own:
                for kind in ("loop", "exhausted") if outcome in node.loop_outcomes else ("break",):
                    yield _iterator_way(path, node, here, outcome, kind), child.span
            continue
        for edge in child.transitions:
            if edge.outcome in own:
                inside = leads_to_child(edge, names)
                target = f"{path}/{edge.target}" if inside else _out(path, edge.target)
                yield Way("transition", here, edge.outcome, target), edge.span


def _iterator_way(
    path: str,
    node: nodes.Iterator,
    here: str,
    outcome: str,
    kind: Literal["loop", "break", "exhausted"],
) -> Way:
    if kind == "loop":
        return Way(kind, here, outcome, here)
    ending = node.exhausted_outcome if kind == "exhausted" else outcome
    return Way(kind, here, outcome, _out(path, dict(node.final_map).get(ending, ending)))


def _out(path: str, outcome: str) -> str:
    """How traces write that a container is left."""
    return f"{path}:{outcome}"


class Taken:
    """Hears the events of runs and knows the ways that they take."""

    def __init__(self, machine: Machine) -> None:
        self.known = ways(machine)
        self.taken: set[Way] = set()
        self.new = False
        self._containers = dict(containers(machine.root))
        self._ended: dict[str, dict[str, str]] = {}

    def hear(self, event: Event) -> None:
        """Note what an event of a run of the interpreter says. `new` becomes true when a way is
        taken for the first time."""
        what, path = event["event"], event["path"]
        if what not in ("enter", "exit", "transition"):
            return
        around = path.rpartition("/")[0]
        if what == "transition":
            node = self._containers[around]
            if isinstance(node, nodes.Iterator):
                self._take(self._of_iterator(node, path, event["outcome"], event["to"]))
            else:
                self._take(Way("transition", path, event["outcome"], event["to"]))
        elif what == "enter":
            if isinstance(self._containers.get(path), Concurrence):
                self._ended[path] = {}
        else:
            node = self._containers[around]
            if isinstance(node, Concurrence):
                self._ended[around][path.rpartition("/")[2]] = event["outcome"]
            own = self._containers.get(path)
            if isinstance(own, Concurrence):
                number = winner(own, self._ended[path])
                self._take(
                    Way("rule", path, event["outcome"], _out(path, event["outcome"]), number)
                )

    def _of_iterator(self, node: nodes.Iterator, path: str, outcome: str, to: str) -> Way:
        if to == path:
            return Way("loop", path, outcome, to)
        return Way("exhausted" if outcome in node.loop_outcomes else "break", path, outcome, to)

    def _take(self, way: Way) -> None:
        if way in self.known and way not in self.taken:
            self.taken.add(way)
            self.new = True

    def missing(self) -> list[Way]:
        """The ways that no run has taken, in the order of the script."""
        return [way for way in self.known if way not in self.taken]


class Reason(NamedTuple):
    """Why a way was not taken; `never`: because no run can take it."""

    words: str
    never: bool = True


UNKNOWN = Reason("no path has come to it", never=False)


def reasons(machine: Machine, missing: Iterable[Way], steering: Steering) -> dict[Way, Reason]:
    """Why ways were not taken, as far as the graph tells."""
    tree = dict(containers(machine.root))
    return {way: _reason(way, tree, steering) for way in missing}


def _reason(way: Way, tree: Mapping[str, Container], steering: Steering) -> Reason:
    node, around = tree.get(way.path), tree.get(way.path.rpartition("/")[0])
    if way.path not in steering.entered:
        return Reason("the state is never entered")
    if way.kind == "rule":
        never = steering.never(way.path, way.rule)
        return Reason("no outcomes of the branches lead to it") if never else UNKNOWN
    if way.outcome not in steering.possible[way.path]:
        return Reason("the state never ends so")
    if way.kind == "loop" and isinstance(around, nodes.Iterator) and count_of_items(around) == 1:
        return Reason("there is but one item")
    if node is not None and way.outcome == node.catches:
        return Reason(
            "exceptions deep in a concurrence or of an iterator itself are not played", False
        )
    return UNKNOWN
