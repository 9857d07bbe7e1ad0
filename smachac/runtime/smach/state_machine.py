"""StateMachine: a container that runs one state at a time and follows transitions."""

from __future__ import annotations

import traceback
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, TypeVar

from smachac.runtime.smach import settings
from smachac.runtime.smach.container import Container, needs_request, open_container
from smachac.runtime.smach.exceptions import (
    InvalidStateError,
    InvalidTransitionError,
    InvalidUserCodeError,
)
from smachac.runtime.smach.failures import child_error, without_runtime
from smachac.runtime.smach.log import quiet
from smachac.runtime.smach.state import State
from smachac.runtime.smach.transitions import Transitions
from smachac.runtime.smach.user_data import UserData

S = TypeVar("S", bound=State)


class _Step:
    """A step of a running machine: a child with its userdata, or an end (`state` is None).

    Attributes:
        label: the child's label, or the outcome with which the machine ends.
        view: the userdata of the child.
        next: outcome -> the next step, for the outcomes seen so far.
    """

    __slots__ = ("constants", "label", "next", "state", "view")

    def __init__(self, label: str) -> None:
        self.label = label
        self.state: State | None = None
        self.view: Any = None
        self.constants: Mapping[str, Any] | None = None
        self.next: dict[Any, _Step] = {}


class StateMachine(Container):
    """A container whose children run one after the other; outcomes select the next child.

    An outcome's target is a label of the machine or one of its own outcomes;
    without a target the machine ends with the child's outcome.
    """

    def __init__(
        self,
        outcomes: Iterable[str],
        input_keys: list[str] | None = None,
        output_keys: list[str] | None = None,
    ) -> None:
        super().__init__(outcomes, input_keys, output_keys)
        self._table = Transitions()
        self._consistent = False
        self._steps: dict[str, _Step] = {}
        self._store = self.userdata
        self._current: _Step | None = None
        self._active: State | None = None
        self._preempted: State | None = None
        self._last_end: tuple[str, str] | None = None

    # Construction

    @staticmethod
    def add(
        label: str,
        state: S,
        transitions: Mapping[str, str | None] | None = None,
        remapping: Mapping[str, str] | None = None,
        constants: Mapping[str, Any] | None = None,
    ) -> S:
        """Add a state to the innermost open machine, and return it.

        Args:
            transitions: outcome -> label or outcome of the machine; None or absent: the machine
                ends with the same outcome. Labels may be added later.
            remapping: the state's userdata key -> the machine's.
            constants: the machine's userdata key -> value, written before each entry.

        Raises:
            InvalidTransitionError: a transition from an outcome that the state lacks.
            InvalidStateError: no machine is open, or the label is taken.
        """
        open_container(StateMachine)._add(label, state, transitions, remapping, constants)
        return state

    @staticmethod
    def add_auto(
        label: str,
        state: S,
        connector_outcomes: Iterable[str],
        transitions: Mapping[str, str | None] | None = None,
        remapping: Mapping[str, str] | None = None,
        constants: Mapping[str, Any] | None = None,
    ) -> S:
        """Add a state as `add` does; its connector outcomes lead to the state added next.

        Raises InvalidStateError also for a connector that the state lacks.
        """
        machine = open_container(StateMachine)
        machine._add(label, state, transitions, remapping, constants)
        machine._table.connect(label, connector_outcomes)
        return state

    def _add(
        self,
        label: str,
        state: State,
        transitions: Mapping[str, str | None] | None,
        remapping: Mapping[str, str] | None,
        constants: Mapping[str, Any] | None,
    ) -> None:
        settings.logdebug(f"adding state '{label}'")
        if self._table.initial is None:
            self._table.initial = label
        self.check_state_spec(label, state, transitions or {})
        self._table.add(label, state, transitions, remapping, constants)
        self._changed()

    def _changed(self) -> None:
        """Discard the checked consistency and the cached targets."""
        self._consistent = False
        for step in self._steps.values():
            step.next.clear()

    def register_outcomes(self, new_outcomes: Iterable[str]) -> None:
        """Add outcomes."""
        super().register_outcomes(new_outcomes)
        self._changed()

    def set_initial_state(
        self, initial_states: Sequence[str], userdata: UserData | None = None
    ) -> None:
        """Set the initial state of all later runs, and merge `userdata` into the machine's."""
        if len(initial_states) > 1:
            settings.logwarn(
                f"a state machine has one initial state; ignored: {initial_states[1:]}"
            )
        if initial_states:
            self._table.initial = initial_states[0]
            self._changed()
        if userdata is not None:
            self.userdata.update(userdata)

    def check_consistency(self) -> None:
        """Raise InvalidTransitionError, with all faults, unless every target is known."""
        faults = self._table.faults(self._outcomes)
        if faults:
            raise InvalidTransitionError("; ".join(faults))

    def check_state_spec(
        self, label: str, state: State, transitions: Mapping[str, str | None]
    ) -> None:
        """Raise InvalidTransitionError for a transition from an outcome that the state lacks."""
        registered = state.get_registered_outcomes()
        unknown = [outcome for outcome in transitions if outcome not in registered]
        if unknown:
            raise InvalidTransitionError(
                f"state '{label}' has transitions for {unknown}; its outcomes: {registered}"
            )

    # Introspection

    @property
    def _states(self) -> dict[str, State]:
        """The children by label, under the name that extensions of SMACH read."""
        return self._table.states

    @property
    def _transitions(self) -> dict[str, dict[str, str | None]]:
        """The targets by label and outcome, under the name that extensions of SMACH read."""
        return self._table.targets

    @property
    def _initial_state_label(self) -> str | None:
        """The initial label, under the name that extensions of SMACH read."""
        return self._table.initial

    @property
    def _current_label(self) -> str | None:
        """The label that runs now, or None, under the name that extensions of SMACH read."""
        return None if self._current is None else self._current.label

    @property
    def _current_state(self) -> State | None:
        """The child that runs now, or None, under the name that extensions of SMACH read."""
        return None if self._current is None else self._current.state

    def get_children(self) -> dict[str, State]:
        """The contained states by label."""
        return self._table.states

    def get_initial_states(self) -> list[str]:
        """The label that runs first."""
        return [str(None) if self._table.initial is None else self._table.initial]

    def get_active_states(self) -> list[str]:
        """The label that runs now, or ran last before an error; ['None'] when there is none."""
        return [str(None) if self._current is None else self._current.label]

    def get_child_outcomes(self) -> dict[str, str | None]:
        """The label that ended last, and its outcome. Only for callbacks."""
        return {} if self._last_end is None else dict([self._last_end])

    def get_internal_edges(self) -> list[tuple[str, str, str | None]]:
        """(outcome, label, target) in the order of adding; target None: ends the machine."""
        return self._table.edges()

    # Execution

    def execute(self, parent_ud: Any = None) -> str | None:
        """Run from the initial state to an outcome.

        None if the machine is inconsistent, which is logged, or after a shutdown.

        Raises:
            InvalidUserCodeError: a child raised.
            InvalidTransitionError: a child returned what is not one of its outcomes.
            InvalidStateError: the machine runs already.
        """
        if not self._consistent:
            try:
                self.check_consistency()
            except (InvalidStateError, InvalidTransitionError) as error:
                settings.logerr(f"the state machine is inconsistent and does not run: {error}")
                return None
            self._consistent = True
        self._claim()
        try:
            return self._run(parent_ud)
        except InvalidUserCodeError as error:
            own = without_runtime(error.__traceback__)
            raise error.with_traceback(own)  # noqa: B904 (the same error)
        finally:
            self._active = None
            self._running.release()

    def _run(self, parent_ud: Any) -> str | None:
        if self._store is not self.userdata:
            self._store, self._steps = self.userdata, {}
        self._preempted = None
        assert self._table.initial is not None  # of a consistent machine
        step = self._current = self._step(self._table.initial)
        self.copy_input_keys(parent_ud)
        if settings.loginfo is not quiet:
            keys = self.userdata.keys()
            settings.loginfo(f"state machine starting in '{step.label}' with userdata {keys}")
        if self._start_cbs:
            self._last_end = None
            self.call_start_cbs()
        outcome = self._walk(step)
        self.copy_output_keys(parent_ud)
        return outcome

    def _walk(self, step: _Step) -> str | None:
        """Run child after child; the outcome reached, None after a shutdown."""
        while not settings.is_shutdown():
            state: Any = step.state
            self._active = state
            if self._preempt_requested:
                self._preempt_next(state)
            if step.constants is not None:
                for key, value in step.constants.items():
                    self.userdata[key] = value
            try:
                outcome = state.execute(step.view)
            except BaseException as error:
                failed = child_error(InvalidUserCodeError, step.label, state, error)
                if failed is error:
                    raise
                raise failed from failed.__cause__
            self._active = None
            try:
                following = step.next[outcome]
            except (KeyError, TypeError):
                following = step.next[outcome] = self._follow(step.label, outcome)
            if following.state is None:
                self._end(step.label, outcome, following.label)
                return following.label
            if settings.loginfo is not quiet:
                settings.loginfo(f"transition '{step.label}':'{outcome}'-->'{following.label}'")
            self._current = following
            if self._transition_cbs:
                self._last_end = step.label, outcome
                self.call_transition_cbs()
            step = following
        return None

    def _step(self, label: str) -> _Step:
        """The step of a child, made at its first visit; an end if there is no such child."""
        step = self._steps.get(label)
        if step is not None:
            return step
        step = _Step(label)
        state = self._table.states.get(label)
        if state is not None:
            step.state = state
            step.view = self._view(state, self._table.remappings[label])
            step.constants = self._table.constants.get(label)
            self._steps[label] = step
        return step

    def _follow(self, label: str, outcome: Any) -> _Step:
        """The next step for an outcome not seen before. Raises InvalidTransitionError."""
        target = self._table.target(label, outcome)
        return _Step(outcome) if target is None else self._step(target)

    def _end(self, label: str, ended: str, outcome: str) -> None:
        """Settle the preempt request and run the termination callbacks."""
        self._current = None
        if self._preempt_requested:
            with self._preempting:
                if self._preempted is not None and not self._preempted.preempt_requested():
                    self.service_preempt()
        if settings.loginfo is not quiet:
            settings.loginfo(f"state machine ending at '{label}' with outcome '{outcome}'")
        if self._termination_cbs:
            self._last_end = label, ended
            self.call_termination_cbs([label], outcome)

    # Preemption

    def request_preempt(self) -> None:
        """Request that the machine ends early; the running child, or else the next one, gets it."""
        with self._preempting:
            super().request_preempt()
            if self._active is not None:
                if not (settings.compat and self._preempted is self._active):
                    self._pass_on(self._active, again=False)
            elif self._preempted is not None and not self._preempted.preempt_requested():
                self._preempted = None  # that child answered an earlier request, not this one

    def _preempt_next(self, state: State) -> None:
        """Pass an unanswered request on to the child that starts now."""
        with self._preempting:
            previous, self._preempted = self._preempted, None
            if previous is not None:
                if not previous.preempt_requested():
                    self.service_preempt()
                    return
                previous.recall_preempt()
            self._pass_on(state)

    def _pass_on(self, state: State, again: bool = True) -> None:
        """Preempt a child; one with a request gets another one only if `again`."""
        self._preempted = state
        try:
            if again or needs_request(state):
                state.request_preempt()
        except Exception:
            settings.logerr(f"request_preempt failed:\n{traceback.format_exc()}")
