"""The events that the atoms of a property name in a machine, and the faults of their names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal, NamedTuple

from smachac.analysis.resource_claims import Held, prefixes
from smachac.ir.nodes import Leaf, Node
from smachac.ir.properties import Atom
from smachac.ir.traversal import outcome_names

NameFaultKind = Literal["unknown", "ambiguous", "outcome"]


class NameFault(NamedTuple):
    """An atom whose name is of no state or of several, or whose outcome none of its states has.

    `known` are the names that it may be; for an ambiguous one, the paths.
    """

    kind: NameFaultKind
    atom: Atom
    known: tuple[str, ...]


class NamedStates:
    """The states of a machine by what atoms can name. `paths` and `nodes` are in the same order."""

    def __init__(self, paths: Sequence[str], states: Sequence[Node], claims: Held) -> None:
        self.paths = paths
        self.nodes = states
        self.numbers: dict[str, int] = {}
        self._ends: dict[str, list[int]] = {}
        self._inner: dict[str, list[int]] = {}
        self._tags: dict[str, list[int]] = {}
        self._types: dict[str, list[int]] = {}
        self._claims: dict[str, list[int]] = {}
        sugared = {path for path, node in zip(paths, states, strict=True) if _is_sugar(node)}
        for number, (path, node) in enumerate(zip(paths, states, strict=True)):
            self.numbers.setdefault(path, number)
            name = path.rpartition("/")[2]
            around = _sugar_around(path, sugared)
            if around is None:
                self._ends.setdefault(name, []).append(number)
            else:
                self._inner.setdefault(f"{around}/{name}", []).append(number)
            for tag in node.tags:
                self._tags.setdefault(tag, []).append(number)
            if path not in sugared:
                self._types.setdefault(node.type, []).append(number)
            for claim, origin in claims.get(path, {}).items():
                if origin is node:
                    for prefix in prefixes(claim):
                        self._claims.setdefault(prefix, []).append(number)

    def resolve(self, atom: Atom) -> list[tuple[int, str | None]] | NameFault:
        """The events of an atom, by number of the state, or what is wrong with its names."""
        tables = {"tag": self._tags, "type": self._types, "claim": self._claims}
        if atom.subject == "path":
            found = self._of_path(atom.name)
            if len(found) > 1:
                return NameFault("ambiguous", atom, tuple(self.paths[number] for number in found))
            known: Mapping[str, object] = self._ends
        else:
            known = tables[atom.subject]
            found = list(dict.fromkeys(tables[atom.subject].get(atom.name, ())))
        if not found:
            return NameFault("unknown", atom, tuple(known))
        if atom.outcome is None:
            return [(number, None) for number in found]
        having = [number for number in found if self._has(number, atom.outcome)]
        if not having:
            names = [name for number in found for name in outcome_names(self.nodes[number])]
            return NameFault("outcome", atom, tuple(dict.fromkeys(names)))
        return [(number, atom.outcome) for number in having]

    def _has(self, number: int, outcome: str) -> bool:
        node = self.nodes[number]
        return outcome in outcome_names(node) or (isinstance(node, Leaf) and node.open)

    def _of_path(self, name: str) -> list[int]:
        """The states whose path a name is, or is the end of. A state inside its own time limit,
        retry or loop is only found by its whole path, or by two names of its end, between which the
        containers made for it can be left out."""
        if name in self.numbers:
            return [self.numbers[name]]
        last = name.rpartition("/")[2]
        found = [
            number for number in self._ends.get(last, ()) if self.paths[number].endswith(f"/{name}")
        ]
        if found or "/" not in name:
            return found
        ending = f"/{name}"
        found = [number for number, path in enumerate(self.paths) if path.endswith(ending)]
        return found or [
            number
            for path, numbers in self._inner.items()
            if f"/{path}".endswith(ending)
            for number in numbers
        ]


def _sugar_around(path: str, sugared: set[str]) -> str | None:
    """The path of the container that was made for a state, and has its name; None if the state is
    in no such container."""
    outside, _, name = path.rpartition("/")
    while outside in sugared:
        if outside.rpartition("/")[2] == name:
            return outside
        outside = outside.rpartition("/")[0]
    return None


def _is_sugar(node: Node) -> bool:
    return not isinstance(node, Leaf) and node.sugar != ""
