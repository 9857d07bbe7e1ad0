"""Sequence: a state machine whose states run in the order in which they were added."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TypeVar

from smachac.runtime.smach import settings
from smachac.runtime.smach.container import open_container
from smachac.runtime.smach.state import State
from smachac.runtime.smach.state_machine import StateMachine

S = TypeVar("S", bound=State)


class Sequence(StateMachine):
    """A state machine with one outcome, the connector, that leads to the state added next.

    The connector of the last state ends the sequence with the outcome of that name.
    """

    def __init__(
        self,
        outcomes: Iterable[str],
        connector_outcome: str,
        input_keys: list[str] | None = None,
        output_keys: list[str] | None = None,
    ) -> None:
        super().__init__(outcomes, input_keys, output_keys)
        self._connector = connector_outcome
        self._last: str | None = None

    @staticmethod
    def add(  # type: ignore[override]  # pyright: ignore[reportIncompatibleMethodOverride]
        label: str,
        state: S,
        transitions: Mapping[str, str | None] | None = None,
        remapping: Mapping[str, str] | None = None,
    ) -> S:
        """Add a state to the innermost open sequence, and return it.

        The state added before leads to it, unless it has another target for the connector.
        Arguments and errors as for `StateMachine.add`, without `constants`.
        """
        sequence = open_container(Sequence)
        sequence._link(label)
        sequence._add(label, state, transitions, remapping, None)
        sequence._last = label
        return state

    def _link(self, label: str) -> None:
        """Connect the state added last to `label`, unless its connector outcome has a target."""
        if self._last is None:
            return
        targets = self._table.targets[self._last]
        if self._connector not in targets:
            settings.logerr(f"'{self._last}' lacks the connector outcome '{self._connector}'")
        if targets.get(self._connector) is None:
            targets[self._connector] = label
            self._changed()
