"""Concurrence: a container that runs all its children at the same time, one thread each."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, TypeVar

from smachac.runtime.smach import settings
from smachac.runtime.smach.container import Container, needs_request, open_container, withdraw
from smachac.runtime.smach.exceptions import (
    InvalidStateError,
    InvalidTransitionError,
    InvalidUserCodeError,
)
from smachac.runtime.smach.failures import callback_error, child_error
from smachac.runtime.smach.log import quiet
from smachac.runtime.smach.state import State
from smachac.runtime.smach.threads import Branches
from smachac.runtime.smach.user_data import UserData

S = TypeVar("S", bound=State)
OutcomeMap = Mapping[str, Mapping[str, str]]
"""Outcome of the concurrence -> its rule: child label -> the outcome of that child."""


class Concurrence(Container):
    """A container whose children start together; it ends when all have ended.

    Its outcome is the last key of `outcome_map` whose rule holds, or `default_outcome` if none
    holds; a string returned by `outcome_cb` overrides both. When `child_termination_cb` returns a
    true value, the children that still run are preempted.
    """

    def __init__(
        self,
        outcomes: Iterable[str],
        default_outcome: str,
        input_keys: list[str] | None = None,
        output_keys: list[str] | None = None,
        outcome_map: OutcomeMap | None = None,
        outcome_cb: Callable[[dict[str, str | None]], str | None] | None = None,
        child_termination_cb: Callable[[dict[str, str | None]], object] | None = None,
    ) -> None:
        super().__init__(outcomes, input_keys, output_keys)
        self._default = default_outcome
        self._outcome_map = {name: dict(rule) for name, rule in (outcome_map or {}).items()}
        self._outcome_cb = outcome_cb
        self._child_termination_cb = child_termination_cb
        self._states: dict[str, State] = {}
        self._remappings: dict[str, Mapping[str, str]] = {}
        self._branches: Branches | None = None
        self._left_flagged = False  # whether a failed run left requests in the children
        self._check_policy()

    def _check_policy(self) -> None:
        """Raise InvalidStateError for an undeclared outcome, or a callback that is no function."""
        if not isinstance(self._default, str) or self._default not in self._outcomes:
            raise InvalidStateError(f"default outcome '{self._default}' is not registered")
        for name in self._outcome_map:
            if name not in self._outcomes:
                raise InvalidStateError(f"outcome '{name}' in the outcome map is not registered")
        for callback in (self._outcome_cb, self._child_termination_cb):
            if callback is not None and not callable(callback):
                raise InvalidStateError(f"the callback {callback!r} cannot be called")

    # Construction

    @staticmethod
    def add(label: str, state: S, remapping: Mapping[str, str] | None = None) -> S:
        """Add a child to the innermost open concurrence, in place of one of the same label."""
        concurrence = open_container(Concurrence)
        settings.logdebug(f"adding state '{label}'")
        concurrence._states[label] = state
        concurrence._remappings[label] = {} if remapping is None else remapping
        return state

    def check_consistency(self) -> None:
        """Raise InvalidTransitionError for an outcome in the map that its child does not have.

        Raises KeyError for a label in the map that is no child.
        """
        faults = []
        for name, rule in self._outcome_map.items():
            for label, outcome in rule.items():
                if outcome not in self._states[label].get_registered_outcomes():
                    faults.append(f"'{name}' requires '{label}':'{outcome}'")
        if faults:
            raise InvalidTransitionError(
                f"outcomes that the children do not have: {'; '.join(faults)}"
            )

    def set_initial_state(self, initial_states: Sequence[str], userdata: UserData | None) -> None:
        """Merge `userdata`; all children start in any case. KeyError for an unknown label."""
        for label in initial_states:
            if label not in self._states:
                raise KeyError(label)
        if userdata is not None:
            self.userdata.update(userdata)

    # Introspection

    @property
    def _child_outcomes(self) -> dict[str, str | None]:
        """Label -> outcome in this run, under the name that extensions of SMACH read."""
        running = self._branches is not None and self._running.locked()
        return self._branches.outcomes if running and self._branches else {}

    def get_children(self) -> dict[str, State]:
        """The contained states by label."""
        return self._states

    def get_initial_states(self) -> list[str]:
        """All labels."""
        return list(self._states)

    def get_active_states(self) -> list[str]:
        """The labels that still run; after an error, the failed ones are included."""
        return [] if self._branches is None else list(self._branches.active)

    def get_child_outcomes(self) -> dict[str, str | None]:
        """The labels that have ended in this run, with their outcomes."""
        return dict(self._child_outcomes)

    def get_internal_edges(self) -> list[tuple[str, str, str | None]]:
        """(child outcome, label, outcome of the concurrence) for every entry of the map."""
        return [
            (outcome, label, name)
            for name, rule in self._outcome_map.items()
            for label, outcome in rule.items()
        ]

    # Execution

    def execute(self, parent_ud: Any = None) -> str | None:
        """Run all children to their ends; the outcome of the concurrence.

        Raises:
            InvalidStateError: there are no children, a child raised or returned no outcome, or
                the concurrence runs already. The cause is chained.
            InvalidUserCodeError: `outcome_cb` raised.
        """
        if not self._states:
            raise InvalidStateError("a concurrence without children cannot run")
        self._claim()
        try:
            branches = self._branches = Branches(self._states, self._run_child)
            self._recall_leftovers()
            self.copy_input_keys(parent_ud)
            if settings.loginfo is not quiet:
                settings.loginfo(f"concurrence starting with userdata {self.userdata.keys()}")
            self.call_start_cbs()
            self._run_branches(branches)
            outcome = self._outcome(branches.outcomes)
            self._settle_preempts(branches)
            self.call_termination_cbs(list(self._states), outcome)
            self.copy_output_keys(parent_ud)
            return outcome
        finally:
            self._running.release()

    def _run_branches(self, branches: Branches) -> None:
        """Run the children and pass preempt requests on to them. Raises the error of a branch."""
        try:
            branches.start()
            if self._preempt_requested:
                branches.request()
            if branches.take_request() and not settings.compat:
                self._preempt(branches)
            branches.release()
            while branches.wait():
                self._preempt(branches)
        except BaseException:
            if branches.abort():
                self._left_flagged = True
                self._preempt(branches)
            raise
        finally:
            branches.join()
        if branches.failure is None:
            return
        self._left_flagged = True
        label, error = branches.failure
        failed = child_error(InvalidStateError, label, self._states[label], error)
        if failed is error:
            raise error
        raise failed from failed.__cause__

    def _run_child(self, branches: Branches, label: str) -> None:
        """Run one child; the function of its thread."""
        state = self._states[label]
        self.call_transition_cbs()
        outcome = state.execute(self._view(state, self._remappings[label]))
        if outcome is None and not settings.is_shutdown():
            words = f"state '{label}' ended without an outcome"
            raise InvalidStateError(words, blames=words)
        with branches.ending:
            branches.outcomes[label] = outcome
            del branches.active[label]
            if settings.loginfo is not quiet:
                settings.loginfo(f"branch '{label}' ended with outcome '{outcome}'")
            if self._child_termination_cb is not None and self._ends_all(branches):
                branches.stop()
        self.call_transition_cbs()

    def _ends_all(self, branches: Branches) -> bool:
        """Whether the termination callback requests that the other children are preempted."""
        assert self._child_termination_cb is not None
        try:
            return bool(self._child_termination_cb(branches.outcomes))
        except Exception as error:
            raise callback_error(InvalidUserCodeError, "child_termination_cb", error) from error

    def _outcome(self, outcomes: dict[str, str | None]) -> str | None:
        """The outcome for these outcomes of the children. Raises KeyError for an unknown label."""
        result = self._default
        for name, rule in self._outcome_map.items():
            if all(outcomes[label] == outcome for label, outcome in rule.items()):
                result = name
        if self._outcome_cb is not None:
            try:
                chosen = self._outcome_cb(dict(outcomes))
            except Exception as error:
                raise callback_error(InvalidUserCodeError, "outcome_cb", error) from error
            if chosen and isinstance(chosen, str):
                result = chosen
        if settings.loginfo is not quiet:
            settings.loginfo(f"concurrence ending with outcome '{result}' from {outcomes}")
        return result

    # Preemption

    def request_preempt(self) -> None:
        """Request that the running children end early; if none runs, those of the next run."""
        super().request_preempt()
        branches = self._branches
        if branches is None:
            return
        if settings.compat or not branches.take_over():
            branches.request()
        else:
            self._preempt(branches)

    def _preempt(self, branches: Branches) -> None:
        """Request that the running children end; an error of one of them is logged."""
        for label in list(branches.active):
            state = self._states[label]
            try:
                if needs_request(state):
                    state.request_preempt()
            except Exception:
                settings.logerr(f"request_preempt failed:\n{traceback.format_exc()}")

    def _settle_preempts(self, branches: Branches) -> None:
        """Recall the requests that children did not answer; mark the concurrence's as answered."""
        if settings.compat and not self._preempt_requested:
            return
        flagged = [state for state in self._states.values() if state.preempt_requested()]
        for state in flagged:
            withdraw(state)
        if self._preempt_requested and branches.answered() and not flagged:
            self.service_preempt()

    def _recall_leftovers(self) -> None:
        """Recall the requests that children got in an earlier run that failed."""
        if self._left_flagged:
            self._left_flagged = False
            if settings.compat:
                return
            for state in self._states.values():
                withdraw(state)
