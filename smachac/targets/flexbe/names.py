"""The names that FlexBE refuses, and those that it gets in their place."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from smachac.diagnostics.diagnostic import Diagnostic
from smachac.ir.nodes import Container, Leaf, Machine, Node
from smachac.ir.traversal import containers, outcome_names, walk
from smachac.records import dataclass
from smachac.targets.errors import unsupported_by_target
from smachac.targets.python.items import refused_items

RENAMED = {"preempted": "preempted_", "None": "None_"}
"""Outcomes with a meaning of their own: `preempted` ends a behavior, `None` is read as no outcome.
`smachac_flexbe.py` has the same table."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Names:
    """The label of each state in FlexBE, and its path there; both by the path in the script."""

    labels: Mapping[str, str]
    paths: Mapping[str, str]

    def changed(self) -> Iterator[tuple[str, str]]:
        """The paths in FlexBE of states with another name in the script, and that name."""
        for path, label in self.labels.items():
            name = path.rpartition("/")[2]
            if label != name:
                yield self.paths[path], name


def outcome(name: str) -> str:
    """The name of an outcome of a state."""
    return RENAMED.get(name, name)


def own_outcomes(node: Node, *, is_root: bool = False) -> tuple[str, ...]:
    """The outcomes of a state, also that of an exception; those of the machine keep their names."""
    found = dict.fromkeys(outcome_names(node))
    if node.catches:
        found[node.catches] = None
    for edge in node.transitions:
        found[edge.outcome] = None
    return tuple(name if is_root else outcome(name) for name in found)


def names_of(machine: Machine) -> Names:
    """The labels: FlexBE refuses that of an outcome of its container, so ` (state)` follows it."""
    root = machine.root.name
    labels: dict[str, str] = {}
    paths = {root: ""}
    for path, node in containers(machine.root):
        outcomes = frozenset(own_outcomes(node, is_root=path == root))
        taken = {*outcomes, *(child.name for child in node.children)}
        for child in node.children:
            where, label = f"{path}/{child.name}", child.name
            if label in outcomes:
                while label in taken:
                    label += " (state)"
                taken.add(label)
            labels[where] = label
            paths[where] = f"{paths[path]}/{label}"
    return Names(labels=labels, paths=paths)


def refused(machine: Machine) -> Iterator[Diagnostic]:
    """What FlexBE cannot express: containers without states, two outcomes, items of an Iterator."""
    for path, node in walk(machine.root):
        if not isinstance(node, Leaf) and not node.children:
            message = f"`{node.name}` has no states"
            yield unsupported_by_target(node.span, "FlexBE", message, names=(path,))
        if path != machine.root.name:
            yield from _refused_outcomes(path, node)
    yield from refused_items(machine, "FlexBE")


def _refused_outcomes(path: str, node: Node | Container) -> Iterator[Diagnostic]:
    meant = {to: name for name, to in RENAMED.items()}
    for name in outcome_names(node):
        if name in meant:
            message = f"an outcome `{name}`, which stands for `{meant[name]}`"
            yield unsupported_by_target(
                node.span, "FlexBE", message, "give it another name", (path, name)
            )
