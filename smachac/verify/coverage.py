"""Transition coverage: the transitions, rules and loops of a machine, and those that runs have
covered."""

from __future__ import annotations

from collections.abc import Container as Holder
from collections.abc import Iterable, Iterator, Mapping
from typing import Literal, NamedTuple

from smachac.diagnostics.source import Span
from smachac.interpreter.result import Event
from smachac.ir import nodes
from smachac.ir.concurrence_rules import matching_rule
from smachac.ir.nodes import Concurrence, Container, Leaf, Machine
from smachac.ir.traversal import containers, leads_to_child, outcome_names
from smachac.ir.written import Written
from smachac.records import dataclass
from smachac.runtime.tracing.writer import shown_path
from smachac.verify.guidance import Planner, item_count, possible_leaf_outcomes


class CoverageItem(NamedTuple):
    """One item to cover: an outcome of the state at `path` leads to `target`.

    For a concurrence the item is a rule, by number, or its default (-1), and `path` is the
    concurrence. An outcome of an iterator's child continues (`loop`), ends it (`break`), or follows
    the last item (`exhausted`).
    """

    kind: Literal["transition", "rule", "loop", "break", "exhausted"]
    path: str
    outcome: str
    target: str
    rule: int = 0

    def renamed(self, paths: Mapping[str, str]) -> CoverageItem:
        """This item with other paths, `paths` by the path of a state."""
        target = shown_path(self.target, paths)
        return self._replace(path=shown_path(self.path, paths), target=target)


def coverage_items(machine: Machine) -> dict[CoverageItem, Span]:
    """Every coverage item of a machine, in the order of the script, with its span."""
    return {
        item: span
        for path, node in containers(machine.root)
        for item, span in _container_items(path, node)
    }


def _container_items(path: str, node: Container) -> Iterator[tuple[CoverageItem, Span]]:
    if isinstance(node, Concurrence):
        for number, rule in enumerate(node.rules):
            yield (
                CoverageItem("rule", path, rule.outcome, _exit(path, rule.outcome), number),
                rule.span,
            )
        if node.default_outcome:
            target = _exit(path, node.default_outcome)
            yield CoverageItem("rule", path, node.default_outcome, target, -1), node.default_span
        return
    names = frozenset(child.name for child in node.children)
    for child in node.children:
        here = f"{path}/{child.name}"
        own = possible_leaf_outcomes(child) if isinstance(child, Leaf) else outcome_names(child)
        if isinstance(node, nodes.Iterator):
            for outcome in own:
                for kind in ("loop", "exhausted") if outcome in node.loop_outcomes else ("break",):
                    yield _iterator_item(path, node, here, outcome, kind), child.span
            continue
        for edge in child.transitions:
            if edge.outcome in own:
                inside = leads_to_child(edge, names)
                target = f"{path}/{edge.target}" if inside else _exit(path, edge.target)
                yield CoverageItem("transition", here, edge.outcome, target), edge.span


def _iterator_item(
    path: str,
    node: nodes.Iterator,
    here: str,
    outcome: str,
    kind: Literal["loop", "break", "exhausted"],
) -> CoverageItem:
    if kind == "loop":
        return CoverageItem(kind, here, outcome, here)
    ending = node.exhausted_outcome if kind == "exhausted" else outcome
    return CoverageItem(kind, here, outcome, _exit(path, dict(node.final_map).get(ending, ending)))


def _exit(path: str, outcome: str) -> str:
    """The target of a transition out of a container, as traces write it."""
    return f"{path}:{outcome}"


class Coverage:
    """The coverage items of a machine, and those that recorded runs have covered."""

    def __init__(self, machine: Machine) -> None:
        self.items = coverage_items(machine)
        self.covered: set[CoverageItem] = set()
        self._containers = dict(containers(machine.root))
        self._ended: dict[str, dict[str, str]] = {}

    def record(self, event: Event) -> None:
        """Update the coverage with one event of a run of the interpreter."""
        what, path = event["event"], event["path"]
        if what not in ("enter", "exit", "transition"):
            return
        around = path.rpartition("/")[0]
        if what == "transition":
            node = self._containers[around]
            if isinstance(node, nodes.Iterator):
                self._cover(self._of_iterator(node, path, event["outcome"], event["to"]))
            else:
                self._cover(CoverageItem("transition", path, event["outcome"], event["to"]))
        elif what == "enter":
            if isinstance(self._containers.get(path), Concurrence):
                self._ended[path] = {}
        else:
            node = self._containers[around]
            if isinstance(node, Concurrence):
                self._ended[around][path.rpartition("/")[2]] = event["outcome"]
            own = self._containers.get(path)
            if isinstance(own, Concurrence):
                number = matching_rule(own, self._ended[path])
                self._cover(
                    CoverageItem(
                        "rule", path, event["outcome"], _exit(path, event["outcome"]), number
                    )
                )

    def _of_iterator(self, node: nodes.Iterator, path: str, outcome: str, to: str) -> CoverageItem:
        if to == path:
            return CoverageItem("loop", path, outcome, to)
        return CoverageItem(
            "exhausted" if outcome in node.loop_outcomes else "break", path, outcome, to
        )

    def _cover(self, item: CoverageItem) -> None:
        if item in self.items:
            self.covered.add(item)

    def missing(self) -> list[CoverageItem]:
        """The items that no run has covered, in the order of the script."""
        return [item for item in self.items if item not in self.covered]


@dataclass(frozen=True, slots=True, kw_only=True)
class ScriptCoverage:
    """The items of a machine as it was written, with their spans, and those that runs covered. For
    a state with tries or items, one item is that the next one begins after an outcome."""

    items: Mapping[CoverageItem, Span]
    covered: frozenset[CoverageItem]

    def missing(self) -> list[CoverageItem]:
        """The items that no run has covered, in the order of the script."""
        return [item for item in self.items if item not in self.covered]


def script_coverage(
    items: Mapping[CoverageItem, Span], covered: Holder[CoverageItem], view: Written
) -> ScriptCoverage:
    """The coverage of the states of a view, from that of the graph."""
    found = {item: item_in_script(item, view) for item in items}
    return ScriptCoverage(
        items={mine: items[item] for item, mine in found.items() if mine is not None},
        covered=frozenset(
            mine for item, mine in found.items() if mine is not None and item in covered
        ),
    )


def item_in_script(item: CoverageItem, view: Written) -> CoverageItem | None:
    """An item of the graph as one of the states of a view; None if it is inside one state."""
    part = view.parts[item.path]
    if item.kind == "rule":
        is_written = part.role == "state"
    else:
        is_written = view.is_whole(item.path) or (item.kind == "loop" and part.begins is not None)
    if not is_written:
        return None
    target = view.traced_state(item.target)
    return item._replace(path=view.traced_state(item.path), target=target)


class Reason(NamedTuple):
    """Why an item is not covered. `never`: no run can cover it."""

    text: str
    never: bool = True


UNKNOWN = Reason("no path reached it", never=False)
"""The reason of an item that may be coverable."""


def reasons(
    machine: Machine, missing: Iterable[CoverageItem], planner: Planner
) -> dict[CoverageItem, Reason]:
    """Why items are not covered, as far as the graph shows it."""
    tree = dict(containers(machine.root))
    return {item: _reason(item, tree, planner) for item in missing}


def _reason(item: CoverageItem, tree: Mapping[str, Container], planner: Planner) -> Reason:
    node, around = tree.get(item.path), tree.get(item.path.rpartition("/")[0])
    if item.path not in planner.entered:
        return Reason("the state is never entered")
    if item.kind == "rule":
        never = planner.cannot_end(item.path, item.rule)
        return Reason("no outcomes of the branches lead to it") if never else UNKNOWN
    if item.outcome not in planner.possible[item.path]:
        return Reason("the state never has this outcome")
    if item.kind == "loop" and isinstance(around, nodes.Iterator) and item_count(around) == 1:
        return Reason("there is only one item")
    if node is not None and item.outcome == node.catches:
        return Reason(
            "exceptions inside a concurrence, or of an iterator itself, are not tested", False
        )
    return UNKNOWN
