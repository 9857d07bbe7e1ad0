"""Python files in memory as a repository, and what the evaluator makes of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from smachac.diagnostics.source import Source
from smachac.pysource.machines.evaluator import Evaluator
from smachac.pysource.machines.heap import Added, Children
from smachac.pysource.machines.project import Repository
from smachac.pysource.machines.roots import Roots, machines_of
from smachac.pysource.machines.values import (
    Const,
    DictValue,
    Instance,
    OneOf,
    Unknown,
    UseFault,
    Value,
    alternatives,
    sequence,
)

MAIN = "machine.py"


class ReadState(NamedTuple):
    """A state that the evaluator has seen added: the values that are possible, None for any."""

    label: str | None
    possible: bool
    outcomes: frozenset[str] | None
    transitions: Mapping[str, frozenset[str] | None] | None


class ReadMachine(NamedTuple):
    """A container as the evaluator has seen it; `complete`: there are no other states."""

    name: str
    states: tuple[ReadState, ...]
    complete: bool

    @property
    def exact(self) -> dict[str, dict[str, str]]:
        """The transitions by state, of a container of which all is known."""
        assert self.complete
        found = {}
        for state in self.states:
            assert not state.possible, state
            assert state.label is not None, state
            assert state.transitions is not None, state
            found[state.label] = {key: _only(value) for key, value in state.transitions.items()}
        return found


def _only(values: frozenset[str] | None) -> str:
    assert values is not None
    (value,) = values
    return value


def read_machines(main: str, files: Mapping[str, str] | None = None) -> list[ReadMachine]:
    """The root containers of a file, in order."""
    return evaluated(main, files)[0]


def evaluated(
    main: str, files: Mapping[str, str] | None = None
) -> tuple[list[ReadMachine], list[UseFault]]:
    """The root containers of a file, and the wrong uses in it."""
    texts = {**(files or {}), MAIN: main}
    repository = Repository(texts, lambda file: Source(file, texts[file]))
    evaluator = Evaluator(repository)

    def read(roots: Roots) -> list[ReadMachine]:
        return [_machine(container, roots) for container in roots.containers]

    found = machines_of(repository, evaluator, MAIN, read)
    return [machine for some in found for machine in some], evaluator.faults


def _machine(made: Instance, roots: Roots) -> ReadMachine:
    children = made.slots["$children"]
    assert isinstance(children, Children)
    name = made.slots.get("$name")
    text = str(name.value) if isinstance(name, Const) else "?"
    states = tuple(_state(added) for added in children.added)
    return ReadMachine(text, states, children.complete and roots.complete)


def _state(added: Added) -> ReadState:
    label = str(added.label.value) if isinstance(added.label, Const) else None
    outcomes = None
    if isinstance(added.state, Instance):
        items = sequence(added.state.slots.get("$outcomes"))
        known = items is not None and all(isinstance(item, Const) for item in items)
        outcomes = frozenset(_texts(*(items or ())) or ()) if known else None
    transitions = None
    if isinstance(added.transitions, DictValue):
        pairs = added.transitions.items
        if not isinstance(pairs, Unknown | OneOf):
            transitions = {str(key): _texts(pair[1]) for key, pair in pairs.items()}
    return ReadState(label, added.possible, outcomes, transitions)


def _texts(*values: Value) -> frozenset[str] | None:
    parts = [part for value in values for part in alternatives(value)]
    known = [str(part.value) for part in parts if isinstance(part, Const)]
    return frozenset(known) if len(known) == len(parts) else None
