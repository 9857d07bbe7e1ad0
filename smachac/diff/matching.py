"""The states of one machine and those of another that correspond to them.

In a pair of containers, children with one name correspond. Of the others, those with equal
neighbours and equal facts do, then those of one type with equal neighbours, then those with equal
facts: they were renamed. What is left over in the whole machine corresponds by name and facts, then
by name and type: it was moved. All is found by look-up, in linear time, and the same in both
directions.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Mapping

from smachac.diff.states import State, StateName, States, value_text
from smachac.records import dataclass, field

Key = Callable[["_Side", str], Hashable]
"""What a state has in common with one that corresponds to it; None: it corresponds to none."""


@dataclass(slots=True)
class _Side:
    """One of the two machines. `pairs` are the numbers of the pairs that were found, by path."""

    states: States
    pairs: dict[str, int] = field(default_factory=dict)
    contents: dict[str, int] = field(default_factory=dict)
    entered: dict[str, list[tuple[str, str]]] = field(default_factory=dict)

    def unpaired(self, paths: Iterable[str]) -> list[str]:
        return [path for path in paths if path not in self.pairs]


def corresponding(before: States, after: States) -> dict[str, str]:
    """The paths of the states of `after` by those of the states of `before` that correspond."""
    numbers: dict[Hashable, int] = {}
    left, right = _side(before, numbers), _side(after, numbers)
    found: dict[str, str] = {}
    todo: list[tuple[str, str]] = []

    def pair(one: str, other: str) -> None:
        left.pairs[one] = right.pairs[other] = len(found)
        found[one] = other
        todo.append((one, other))

    pair(next(iter(before)), next(iter(after)))
    _match_children(left, right, todo, pair)
    for key in (_name_and_content, _name_and_type):
        ones, others = left.unpaired(before), right.unpaired(after)
        for one, other in _by_key(left, right, ones, others, key):
            if one not in left.pairs and other not in right.pairs:
                pair(one, other)
                _match_children(left, right, todo, pair)
    return found


def _side(states: States, numbers: dict[Hashable, int]) -> _Side:
    """A machine with the numbers of the contents of its states: equal contents, equal numbers."""
    side = _Side(states)
    for path in reversed(states):
        state = states[path]
        facts = frozenset(
            (fact, value_text(value))
            for fact, value in state.facts.items()
            if fact[0] != "transition"
        )
        inner = tuple((states[child].name, side.contents[child]) for child in state.children)
        side.contents[path] = numbers.setdefault((facts, inner), len(numbers))
        for fact, value in state.facts.items():
            if fact[0] == "transition":
                for part in value:
                    if isinstance(part, StateName):
                        side.entered.setdefault(part.path, []).append((path, fact[1]))
    return side


def _match_children(
    left: _Side,
    right: _Side,
    todo: list[tuple[str, str]],
    pair: Callable[[str, str], None],
) -> None:
    """Find the pairs among the children of pairs of containers, and among theirs."""
    while todo:
        one, other = todo.pop()
        for key in (_name, _neighbours_and_content, _neighbours_and_type, _content):
            ones = left.unpaired(left.states[one].children)
            others = right.unpaired(right.states[other].children)
            if ones and others:
                for item in _by_key(left, right, ones, others, key):
                    pair(*item)


def _by_key(
    left: _Side, right: _Side, ones: list[str], others: list[str], key: Key
) -> list[tuple[str, str]]:
    """The pairs of states with the same key that no other state has."""
    first, second = _unique(left, ones, key), _unique(right, others, key)
    return [(path, second[name]) for name, path in first.items() if name in second]


def _unique(side: _Side, paths: Iterable[str], key: Key) -> dict[Hashable, str]:
    found: dict[Hashable, list[str]] = {}
    for path in paths:
        found.setdefault(key(side, path), []).append(path)
    return {name: paths[0] for name, paths in found.items() if name is not None and len(paths) == 1}


def _name(side: _Side, path: str) -> Hashable:
    return side.states[path].name


def _neighbours(side: _Side, path: str) -> Hashable:
    """The edges of a state: the outcomes with the pairs, or outcomes, that they lead to or from."""
    found = [("from", side.pairs.get(source), name) for source, name in side.entered.get(path, ())]
    leads: list[tuple[str, Hashable, str]] = []
    for (kind, name), value in side.states[path].facts.items():
        if kind == "transition":
            ends = [side.pairs.get(part.path) if isinstance(part, StateName) else part
                    for part in value]  # fmt: skip
            leads.append(("to", tuple(ends), name))
    return frozenset([*found, *leads])


def _neighbours_and_content(side: _Side, path: str) -> Hashable:
    return _neighbours(side, path), side.contents[path]


def _neighbours_and_type(side: _Side, path: str) -> Hashable:
    return _neighbours(side, path), side.states[path].type


def _content(side: _Side, path: str) -> Hashable:
    """The facts of a state that has values of its own; None for a state without values."""
    return side.contents[path] if _has_values(side.states[path]) else None


def _has_values(state: State) -> bool:
    return bool(state.children) or any(kind == "variable" for kind, _ in state.facts)


def _name_and_content(side: _Side, path: str) -> Hashable:
    return side.states[path].name, side.contents[path]


def _name_and_type(side: _Side, path: str) -> Hashable:
    return side.states[path].name, side.states[path].type


def renamed_words(pairs: Mapping[str, str]) -> dict[str, str]:
    """The new names of states by their old ones, where only one state had the old name."""
    found: dict[str, set[str]] = {}
    for one, other in pairs.items():
        found.setdefault(one.rpartition("/")[2], set()).add(other.rpartition("/")[2])
    return {one: min(names) for one, names in found.items() if len(names) == 1}
