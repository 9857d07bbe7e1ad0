"""The transition table of a state machine: its children and the targets of their outcomes."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from typing import Any

from smachac.runtime.smach.exceptions import InvalidStateError, InvalidTransitionError
from smachac.runtime.smach.state import State


class Transitions:
    """Children by label with their transitions, in the order in which they were added.

    Attributes:
        initial: the label that runs first; None: no state was added.
        states: label -> child.
        targets: label -> outcome -> label of another child or outcome of the machine;
            None or '': the machine ends with the same outcome.
        remappings: label -> the child's userdata key -> the machine's.
        constants: label -> the machine's userdata key -> value to write before each entry.
    """

    def __init__(self) -> None:
        self.initial: str | None = None
        self.states: dict[str, State] = {}
        self.targets: dict[str, dict[str, str | None]] = {}
        self.remappings: dict[str, Mapping[str, str]] = {}
        self.constants: dict[str, Mapping[str, Any]] = {}
        self._connected: tuple[str, tuple[str, ...]] | None = None

    def add(
        self,
        label: str,
        state: State,
        transitions: Mapping[str, str | None] | None,
        remapping: Mapping[str, str] | None,
        constants: Mapping[str, Any] | None,
    ) -> None:
        """Add a child with checked transitions. Raises InvalidStateError: the label is taken."""
        registered = state.get_registered_outcomes()
        explicit = dict(transitions or {})
        if label in self.states:
            raise InvalidStateError(f"label '{label}' is taken")
        implicit = dict.fromkeys(o for o in registered if o not in explicit)
        self.states[label] = state
        self.targets[label] = {**explicit, **implicit}
        self.remappings[label] = {} if remapping is None else remapping
        if constants:
            self.constants[label] = dict(constants)
        if self._connected is not None:
            (source, connectors), self._connected = self._connected, None
            self.targets[source].update(dict.fromkeys(connectors, label))

    def connect(self, label: str, outcomes: Iterable[str]) -> None:
        """Set the child that is added next as the target of these outcomes of a child.

        Raises InvalidStateError for an outcome that the child lacks.
        """
        connectors = tuple(outcomes)
        for outcome in connectors:
            if outcome not in self.states[label].get_registered_outcomes():
                raise InvalidStateError(f"connector '{outcome}' is no outcome of '{label}'")
        self._connected = (label, connectors)

    def faults(self, outcomes: Collection[str]) -> list[str]:
        """The errors, as text, that keep a machine with these outcomes from running."""
        faults = []
        if self.initial is None:
            faults.append("there is no initial state")
        elif self.initial not in self.states:
            faults.append(f"the initial state '{self.initial}' was not added")
        for outcome, label, target in self.edges():
            implicit = target in (None, "")
            end = outcome if implicit else target
            if end not in outcomes and (implicit or end not in self.states):
                faults.append(f"'{label}':'{outcome}'-->'{end}' leads to no state or outcome")
        return faults

    def edges(self) -> list[tuple[str, str, str | None]]:
        """(outcome, label, target) for every outcome of every child."""
        return [
            (outcome, label, target)
            for label, targets in self.targets.items()
            for outcome, target in targets.items()
        ]

    def target(self, label: str, outcome: Any) -> str | None:
        """The target of an outcome that a child returned; None: the machine ends with it.

        Raises InvalidTransitionError if it is no outcome of the child, or was registered too late.
        """
        registered = self.states[label].get_registered_outcomes()
        if outcome not in registered:
            words = f"state '{label}' returned '{outcome}'; its outcomes: {registered}"
            raise InvalidTransitionError(words, blames=words)
        targets = self.targets[label]
        if outcome not in targets:
            raise InvalidTransitionError(
                f"outcome '{outcome}' was registered after '{label}' was added: no transition"
            )
        target = targets[outcome]
        return None if target == "" else target
