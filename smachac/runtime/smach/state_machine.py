"""StateMachine: one state at a time, and transitions between them."""

from __future__ import annotations

import traceback
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, TypeVar

from smachac.runtime import smach

from .container import Container, open_container
from .exceptions import InvalidStateError, InvalidTransitionError, InvalidUserCodeError
from .log import quiet
from .state import State
from .user_data import UserData

S = TypeVar("S", bound=State)


class _Step:
    """A place in a running machine: a child with what it sees, or an end (`state` is None).

    Attributes:
        label: the child's label, or the outcome with which the machine ends.
        next: where the outcomes seen so far lead.
    """

    __slots__ = ("constants", "label", "next", "state", "view")

    def __init__(self, label: str, state: State | None = None, view: Any = None) -> None:
        self.label = label
        self.state = state
        self.view = view
        self.constants: Mapping[str, Any] | None = None
        self.next: dict[Any, _Step] = {}


class StateMachine(Container):
    """A container whose children run one after the other, as their outcomes tell.

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
        self._states: dict[str, State] = {}
        self._transitions: dict[str, dict[str, str | None]] = {}
        self._remappings: dict[str, dict[str, str]] = {}
        self._constants: dict[str, Mapping[str, Any]] = {}
        self._initial: str | None = None
        self._pending: tuple[str, tuple[str, ...]] | None = None
        self._consistent = False
        self._steps: dict[str, _Step] = {}
        self._store = self.userdata
        self._current: _Step | None = None
        self._active: State | None = None
        self._preempted: State | None = None

    # Construction

    @staticmethod
    def add(
        label: str,
        state: S,
        transitions: Mapping[str, str | None] | None = None,
        remapping: dict[str, str] | None = None,
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
        remapping: dict[str, str] | None = None,
        constants: Mapping[str, Any] | None = None,
    ) -> S:
        """Add a state as `add` does; its connector outcomes lead to the state added next.

        Raises InvalidStateError also for a connector that the state lacks.
        """
        machine = open_container(StateMachine)
        machine._add(label, state, transitions, remapping, constants)
        connectors = tuple(connector_outcomes)
        registered = state.get_registered_outcomes()
        for outcome in connectors:
            if outcome not in registered:
                raise InvalidStateError(f"connector '{outcome}' is no outcome of '{label}'")
        machine._pending = (label, connectors)
        return state

    def _add(
        self,
        label: str,
        state: State,
        transitions: Mapping[str, str | None] | None,
        remapping: dict[str, str] | None,
        constants: Mapping[str, Any] | None,
    ) -> None:
        smach.logdebug(f"adding state '{label}'")
        if self._initial is None:
            self._initial = label
        registered = state.get_registered_outcomes()
        explicit = dict(transitions or {})
        implicit = dict.fromkeys(o for o in registered if o not in explicit)
        self.check_state_spec(label, state, explicit)
        if label in self._states:
            raise InvalidStateError(f"label '{label}' is taken")
        self._states[label] = state
        self._transitions[label] = {**explicit, **implicit}
        self._remappings[label] = {} if remapping is None else remapping
        if constants:
            self._constants[label] = dict(constants)
        if self._pending is not None:
            source, connectors = self._pending
            self._pending = None
            self._transitions[source].update(dict.fromkeys(connectors, label))
        self._changed()

    def _changed(self) -> None:
        """Look up all targets anew."""
        self._consistent = False
        for step in self._steps.values():
            step.next.clear()

    def check_state_spec(
        self, label: str, state: State, transitions: Mapping[str, str | None]
    ) -> None:
        """Raise InvalidTransitionError if a transition is for an outcome that the state lacks."""
        registered = state.get_registered_outcomes()
        unknown = [outcome for outcome in transitions if outcome not in registered]
        if unknown:
            raise InvalidTransitionError(
                f"state '{label}' has transitions for {unknown}; its outcomes: {registered}"
            )

    def register_outcomes(self, new_outcomes: Iterable[str]) -> None:
        """Add outcomes."""
        super().register_outcomes(new_outcomes)
        self._changed()

    def set_initial_state(
        self, initial_states: Sequence[str], userdata: UserData | None = None
    ) -> None:
        """Choose where all later runs start, and merge `userdata` into the machine's."""
        if len(initial_states) > 1:
            smach.logwarn(f"a state machine has one initial state; ignored: {initial_states[1:]}")
        if initial_states:
            self._initial = initial_states[0]
            self._changed()
        if userdata is not None:
            self.userdata.update(userdata)

    def check_consistency(self) -> None:
        """Raise InvalidTransitionError, with all faults, unless every target is known."""
        faults = []
        if self._initial is None:
            faults.append("there is no initial state")
        elif self._initial not in self._states:
            faults.append(f"the initial state '{self._initial}' was not added")
        for label, transitions in self._transitions.items():
            for outcome, target in transitions.items():
                if target and (target in self._states or target in self._outcomes):
                    continue
                if not target and outcome in self._outcomes:
                    continue
                place = f"'{label}':'{outcome}'-->'{target or outcome}'"
                faults.append(f"{place} leads to no state or outcome")
        if faults:
            raise InvalidTransitionError("; ".join(faults))

    # Introspection

    def get_children(self) -> dict[str, State]:
        """The contained states by label."""
        return self._states

    def get_initial_states(self) -> list[str]:
        """The label that runs first."""
        return [str(self._initial)]

    def get_active_states(self) -> list[str]:
        """The label that runs now, or ran last before an error; ['None'] when there is none."""
        return [str(None) if self._current is None else self._current.label]

    def get_internal_edges(self) -> list[tuple[str, str, str | None]]:
        """(outcome, label, target) in the order of adding; target None: ends the machine."""
        return [
            (outcome, label, target)
            for label, transitions in self._transitions.items()
            for outcome, target in transitions.items()
        ]

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
            except (InvalidStateError, InvalidTransitionError):
                smach.logerr("the state machine is inconsistent and does not run")
                return None
            self._consistent = True
        self._claim()
        try:
            return self._run(parent_ud)
        finally:
            self._active = None
            self._running.release()

    def _run(self, parent_ud: Any) -> str | None:
        if self._store is not self.userdata:
            self._store, self._steps = self.userdata, {}
        self._preempted = None
        step = self._current = self._step(str(self._initial))
        self.copy_input_keys(parent_ud)
        if smach.loginfo is not quiet:
            keys = self.userdata.keys()
            smach.loginfo(f"state machine starting in '{step.label}' with userdata {keys}")
        if self._start_cbs:
            self.call_start_cbs()
        end = self._walk(step)
        if end is not None:
            self._finish(end.label)
        self.copy_output_keys(parent_ud)
        return None if end is None else end.label

    def _walk(self, step: _Step) -> _Step | None:
        """Run child after child; the end reached, None after a shutdown."""
        while not smach.is_shutdown():
            state: Any = step.state
            self._active = state
            if self._preempt_requested:
                self._preempt_next(state)
            if step.constants is not None:
                for key, value in step.constants.items():
                    self.userdata[key] = value
            try:
                outcome = state.execute(step.view)
            except InvalidUserCodeError:
                raise
            except Exception as error:
                raise InvalidUserCodeError(
                    f"state '{step.label}' of type {type(state).__name__} failed:\n"
                    f"{traceback.format_exc()}"
                ) from error
            self._active = None
            try:
                following = step.next[outcome]
            except (KeyError, TypeError):
                following = self._follow(step, outcome)
            if smach.loginfo is not quiet:
                smach.loginfo(f"transition '{step.label}':'{outcome}'-->'{following.label}'")
            if following.state is None:
                return following
            step = self._current = following
            if self._transition_cbs:
                self.call_transition_cbs()
        return None

    def _step(self, label: str) -> _Step:
        """The place of a child, made at its first visit."""
        step = self._steps.get(label)
        if step is None:
            state = self._states[label]
            step = _Step(label, state, self._view(state, self._remappings[label]))
            step.constants = self._constants.get(label)
            self._steps[label] = step
        return step

    def _follow(self, step: _Step, outcome: Any) -> _Step:
        """Where an outcome not seen before leads. Raises InvalidTransitionError if nowhere."""
        state, label = self._states[step.label], step.label
        registered = state.get_registered_outcomes()
        if outcome not in registered:
            raise InvalidTransitionError(
                f"state '{label}' returned '{outcome}'; its outcomes: {registered}"
            )
        transitions = self._transitions[label]
        if outcome not in transitions:
            raise InvalidTransitionError(
                f"outcome '{outcome}' was registered after '{label}' was added: no transition"
            )
        target = transitions[outcome]
        following = self._step(target) if target in self._states else _Step(target or outcome)
        step.next[outcome] = following
        return following

    def _finish(self, outcome: str) -> None:
        """Settle the preempt request and tell the callbacks."""
        label = "" if self._current is None else self._current.label
        self._current = None
        if self._preempt_requested:
            with self._preempting:
                if self._preempted is not None and not self._preempted.preempt_requested():
                    self.service_preempt()
        if smach.loginfo is not quiet:
            smach.loginfo(f"state machine ending at '{label}' with outcome '{outcome}'")
        if self._termination_cbs:
            self.call_termination_cbs([label], outcome)

    # Preemption

    def request_preempt(self) -> None:
        """Ask the machine to end early: the child that runs, or else the next one, is told."""
        with self._preempting:
            super().request_preempt()
            if self._active is not None:
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
        """Preempt a child; one that already knows is told `again` or not."""
        self._preempted = state
        try:
            if again or not state.preempt_requested():
                state.request_preempt()
        except Exception:
            smach.logerr(f"request_preempt failed:\n{traceback.format_exc()}")
