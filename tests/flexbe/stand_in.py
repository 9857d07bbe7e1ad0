"""A stand-in for the parts of FlexBE 2.3.3 that generated behaviors use, with its errors.

FlexBE is on no registry of packages. The behavior was read in `flexbe_core` of
flexbe_behavior_engine 2.3.3 (commit cb0f431): core/*.py, behavior.py and logger.py. What it gets
from topics is in `TOPICS`: the last message by topic, as an operator sends them.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable
from typing import Any

TOPICS: dict[str, Any] = {}
_LOG = logging.getLogger("flexbe")


class StateError(Exception):
    """A fault of a state."""


class StateMachineError(Exception):
    """A fault of a state machine."""


class UserDataError(Exception):
    """A key that must not be read or written."""


class Autonomy:
    Inherit = Off = 0
    Low, High, Full = 1, 2, 3


class Logger:
    """FlexBE formats the text with the arguments also if there are none."""

    @staticmethod
    def initialize(node: object) -> None:
        pass

    @staticmethod
    def logerr(text: str, *arguments: object) -> None:
        _LOG.error("%s", text % arguments)

    logwarn = loginfo = localinfo = logerr


class UserData:
    """Values by key over a reference, with the keys that may be read and written."""

    def __init__(
        self,
        reference: Any = None,
        input_keys: list[str] | None = None,
        output_keys: list[str] | None = None,
        remap: dict[str, str] | None = None,
    ) -> None:
        self._data: dict[str, Any] = {}
        self._reference = {} if reference is None else reference
        self._input_keys, self._output_keys = input_keys, output_keys
        self._remap = remap or {}
        self._read: dict[str, int] = {}

    def __enter__(self) -> UserData:
        return self

    def __exit__(self, *_: object) -> None:
        for key, value in self._read.items():
            if value != hash(repr(self._data[key])):
                raise UserDataError(f"Illegally modified input-only key '{key}'")

    def __contains__(self, key: str) -> bool:
        if key in self._data:
            return True
        if self._input_keys is not None and key not in self._input_keys:
            return False
        return self._remap.get(key, key) in self._reference

    def __getitem__(self, key: str) -> Any:
        if key in self._data:
            return self._data[key]
        if key not in self:
            raise UserDataError(f"No data found for key '{key}'")
        value = self._reference[self._remap.get(key, key)]
        if self._output_keys is not None and key not in self._output_keys:
            self._data[key] = value
            self._read[key] = hash(repr(value))
        return value

    def __setitem__(self, key: str, value: Any) -> None:
        if self._output_keys is not None and key in self._output_keys:
            self._reference[self._remap.get(key, key)] = value
        self._data[key] = value

    def __getattr__(self, key: str) -> Any:
        return object.__getattribute__(self, key) if key.startswith("_") else self[key]

    def __setattr__(self, key: str, value: Any) -> None:
        if key.startswith("_"):
            object.__setattr__(self, key, value)
        elif self._output_keys is not None and key not in self._output_keys:
            raise UserDataError(f"Key '{key}' cannot be set")
        else:
            self[key] = value

    def __call__(self, add_from: UserData) -> None:
        for key, value in add_from._data.items():
            self._data.setdefault(key, value)


def _list(keys: dict[str, Any], name: str) -> list[str]:
    found = keys.pop(name, [])
    assert isinstance(found, list)  # FlexBE adds another list to it
    return list(dict.fromkeys(found))


class State:
    """A state. Name and parent are set once."""

    def __init__(self, **keys: Any) -> None:
        both = _list(keys, "io_keys")
        self.outcomes = _list(keys, "outcomes")
        self.input_keys = list(dict.fromkeys(_list(keys, "input_keys") + both))
        self.output_keys = list(dict.fromkeys(_list(keys, "output_keys") + both))
        self._name: str | None = None
        self._parent: StateMachine | None = None
        self._inner_sync_request = self._is_controlled = False

    @property
    def name(self) -> str:
        assert self._name is not None
        return self._name

    def set_name(self, value: str) -> None:
        if self._name is not None:
            raise StateError("Cannot change the name of a state!")
        self._name = value

    @property
    def parent(self) -> Any:
        return self._parent

    def set_parent(self, value: StateMachine) -> None:
        if self._parent is not None:
            raise StateError("Cannot change the parent of a state!")
        self._parent = value

    @property
    def path(self) -> str:
        return "" if self.parent is None else f"{self.parent.path}/{self.name}"

    @classmethod
    def initialize_ros(cls, node: object) -> None:
        pass


class PreemptableState(State):
    preempt = False


class EventState(PreemptableState):
    """A state whose `execute` is wrapped when it is made, as by the bases of FlexBE's class."""

    PERIOD = 1e8

    def __init__(self, **keys: Any) -> None:
        super().__init__(**keys)
        self._desired_period_ns = self.PERIOD
        self._entering, self._paused, self._skipped = True, False, False
        self._stored: str | None = None
        self._last_active_container: str | None = None
        PreemptableState.preempt = False
        self._work: Callable[[Any], str | None] = self.execute
        self.execute = self._event_execute  # type: ignore[method-assign]

    def execute(self, userdata: Any) -> str | None:
        raise NotImplementedError

    @property
    def sleep_duration(self) -> float:
        return self._desired_period_ns * 1e-9

    def _event_execute(self, userdata: Any) -> str | None:
        if self._is_controlled and "pause" in TOPICS:
            self._paused = TOPICS.pop("pause")
            if self._paused:
                self._last_active_container = PriorityContainer.active_container
                PriorityContainer.active_container = self.path
            else:
                PriorityContainer.active_container = self._last_active_container
        if self._paused and not PreemptableState.preempt:
            self._notify_skipped()
            return None
        if self._entering:
            self._entering = False
            self.on_enter(userdata)
        if self._skipped and not PreemptableState.preempt:
            self._skipped = False
            self.on_resume(userdata)
        outcome = self._operatable(userdata)
        if outcome is not None and not PreemptableState.preempt:
            self._entering = True
            self.on_exit(userdata)
        return outcome

    def _operatable(self, userdata: Any) -> str | None:
        """The outcome, if the level of autonomy allows it or the operator has chosen it."""
        if self._is_controlled and "preempt" in TOPICS:
            del TOPICS["preempt"]
            PreemptableState.preempt = True
        if PreemptableState.preempt:
            return "preempted"
        if self._is_controlled and "transition" in TOPICS:
            target, number = TOPICS.pop("transition")
            if target == self.name:
                chosen: str = self.outcomes[number]
                return chosen
        outcome = self._lockable(userdata)
        if self._is_controlled and outcome is not None:
            allowed = self.parent._autonomy[self.name].get(outcome, -1)
            if allowed >= OperatableStateMachine.autonomy_level:
                self.outcomes.index(outcome)
                return None
        return outcome

    def _lockable(self, userdata: Any) -> str | None:
        """FlexBE reads the outcome `None` as none."""
        outcome = self._work(userdata)
        return None if outcome == "None" else outcome

    def _notify_skipped(self) -> None:
        if not self._skipped:
            self.on_pause()
        self._skipped = True
        if self._is_controlled and "preempt" in TOPICS:
            del TOPICS["preempt"]
            PreemptableState.preempt = True

    def on_start(self) -> None: ...
    def on_stop(self) -> None: ...
    def on_pause(self) -> None: ...
    def on_resume(self, userdata: Any) -> None: ...
    def on_enter(self, userdata: Any) -> None: ...
    def on_exit(self, userdata: Any) -> None: ...


class StateMachine(State):
    _opened: StateMachine | None = None

    def __init__(self, **keys: Any) -> None:
        super().__init__(**keys)
        self._states: list[Any] = []
        self._labels: dict[str, Any] = {}
        self._transitions: dict[str, dict[str, str]] = {}
        self._remappings: dict[str, dict[str, str]] = {}
        self._autonomy: dict[str, dict[str, int]] = {}
        self._current_state: Any = None
        self._own_userdata = UserData()
        self._userdata: Any = None
        self._before: StateMachine | None = None
        self._last_exception: Exception | None = None

    def __enter__(self) -> None:
        self._before, StateMachine._opened = StateMachine._opened, self

    def __exit__(self, *_: object) -> None:
        StateMachine._opened, self._before = self._before, None

    @staticmethod
    def add(
        label: str,
        state: State,
        transitions: dict[str, str],
        autonomy: dict[str, int],
        remapping: dict[str, str] | None = None,
    ) -> None:
        self = StateMachine._opened
        if self is None:
            raise StateMachineError("No container opened")
        transitions["preempted"] = "preempted"
        if label in self._labels:
            raise StateMachineError(f"The label {label} has already been added")
        if label in self.outcomes:
            raise StateMachineError(f"The label {label} is an outcome of this state machine!")
        self._states.append(state)
        self._labels[label] = state
        self._transitions[label] = transitions
        self._remappings[label] = remapping or {}
        self._autonomy[label] = autonomy
        state.set_name(label)
        state.set_parent(self)

    @property
    def userdata(self) -> UserData:
        return self._own_userdata

    def get_deep_state(self) -> Any:
        state = self._current_state
        while isinstance(state, StateMachine):
            state = state._current_state
        return state

    @property
    def sleep_duration(self) -> float:
        return 0.0 if self._current_state is None else float(self._current_state.sleep_duration)

    def wait(self, seconds: float) -> None:
        raise NotImplementedError

    def spin(self) -> str:
        while True:
            outcome = self.execute(None)
            if outcome is not None:
                return outcome
            self.wait(seconds=self.sleep_duration)

    def execute(self, userdata: Any) -> str | None:
        if self._current_state is None:
            valid = {*self._labels, *self.outcomes, "preempted"}
            for edges in self._transitions.values():
                for target in edges.values():
                    if target not in valid:
                        raise StateMachineError(f"Transition target '{target}' missing")
            if not self._states:
                raise StateMachineError("No states added yet!")
            self._current_state = self._states[0]
            self._userdata = UserData() if userdata is None else userdata
            self._userdata(add_from=self._own_userdata)
        return self._execute_current_state()

    def _execute_current_state(self) -> str | None:
        """A tick of the current state. An exception is logged, and the state stays active."""
        try:
            outcome = self._step()
            self._last_exception = None
        except Exception as error:
            self._last_exception = error
            outcome = None
            Logger.logerr(f"Failed to execute state {self._current_state.name}:\n{error}")
        return outcome

    def _step(self) -> str | None:
        state = self._current_state
        with UserData(
            self._userdata, state.input_keys, state.output_keys, self._remappings[state.name]
        ) as userdata:
            outcome = state.execute(userdata)
        if outcome is None:
            return None
        if outcome not in self._transitions[state.name]:
            raise StateError(f"Returned outcome '{outcome}' is not registered as a transition")
        target = self._transitions[state.name][outcome]
        self._current_state = self._labels.get(target)
        return target if self._current_state is None else None


class OperatableStateMachine(StateMachine):
    autonomy_level = 3

    def wait(self, seconds: float) -> None:
        """No time passes here."""

    def on_exit(self, userdata: Any) -> None:
        """The end from outside: that of its current state."""
        state = self._current_state
        if state is not None:
            keys = state.input_keys, state.output_keys
            state._entering = True
            state.on_exit(UserData(self.userdata, *keys, self._remappings[state.name]))
            self._current_state = None

    def confirm(self, name: str, number: int) -> None:
        """What comes before a run. With level 255 nobody controls the states."""
        self.set_name(name)
        if OperatableStateMachine.autonomy_level != 255:
            self._control(True)
        self.wait(seconds=0.001)
        self._notify_start()

    def _notify_start(self) -> None:
        for state in self._states:
            if isinstance(state, OperatableStateMachine):
                state._notify_start()
            else:
                state.on_start()

    def _control(self, is_controlled: bool) -> None:
        for state in self._states:
            state._is_controlled = is_controlled
            if isinstance(state, OperatableStateMachine):
                state._control(is_controlled)

    def destroy(self) -> None:
        for state in self._states:
            if isinstance(state, OperatableStateMachine):
                state.destroy()
            else:
                state.on_stop()
        PriorityContainer.active_container = None


class ConcurrencyContainer(OperatableStateMachine):
    def __init__(self, conditions: Iterable[Any] = (), **keys: Any) -> None:
        super().__init__(**keys)
        self._conditions = list(conditions)
        self._returned_outcomes: dict[str, str] = {}

    def _control(self, is_controlled: bool) -> None:
        """FlexBE controls the first state only."""
        for state in self._states[:1]:
            state._is_controlled = is_controlled
            if isinstance(state, OperatableStateMachine):
                state._control(is_controlled)

    def _execute_current_state(self) -> str | None:
        """A tick of each state that has not ended; then the first condition that holds."""
        for state in self._states:
            if self._returned_outcomes.get(state.name) is None:
                ended = self._execute_single_state(state)
                self._returned_outcomes[state.name] = ended  # type: ignore[assignment]
        if "preempted" in self._returned_outcomes.values():
            return "preempted"
        for outcome, conditions in self._conditions:
            if all(self._returned_outcomes.get(name) == wanted for name, wanted in conditions):
                self.on_exit(self.userdata)
                self._returned_outcomes = {}
                self._current_state = None
                found: str = outcome
                return found
        return None

    def on_exit(self, userdata: Any) -> None:
        for state in self._states:
            if self._returned_outcomes.get(state.name) is None:
                self._execute_single_state(state, force_exit=True)
        self._current_state = None

    def _execute_single_state(self, state: Any, force_exit: bool = False) -> str | None:
        result: str | None = None
        try:
            keys = state.input_keys, state.output_keys
            with UserData(self._userdata, *keys, self._remappings[state.name]) as userdata:
                if force_exit:
                    state._entering = True
                    state.on_exit(userdata)
                else:
                    result = state.execute(userdata)
        except Exception as error:
            result, self._last_exception = None, error
            Logger.logerr(f"ConcurrencyContainer: Failed to execute state\n{error}")
        return result


class PriorityContainer(OperatableStateMachine):
    active_container: str | None = None


class Behavior:
    """A behavior, with the functions that the engine calls."""

    def __init__(self) -> None:
        self._state_machine: Any = None
        self.name = "unnamed behavior"
        self.beh_id = 0
        self.contains: dict[str, Any] = {}

    def create(self) -> Any:
        raise NotImplementedError

    def add_parameter(self, name: str, default: Any) -> None:
        setattr(self, name, default)

    def add_behavior(self, behavior_class: Any, behavior_id: str, node: object) -> None:
        self.contains[behavior_id] = behavior_class(node)

    def use_behavior(
        self, behavior_class: Any, behavior_id: str, default_keys: list[str] | None = None,
        parameters: dict[str, Any] | None = None,
    ) -> Any:  # fmt: skip
        behavior = self.contains[behavior_id]
        for name, value in (parameters or {}).items():
            setattr(behavior, name, value)
        if behavior._state_machine is None:
            behavior._state_machine = behavior.create()
        machine = behavior._state_machine
        machine.input_keys = list({*machine.input_keys} - {*(default_keys or ())})
        for key in machine.input_keys:
            machine.userdata._data.pop(key, None)
        return machine

    def set_up(self, beh_id: int, autonomy_level: int, debug: bool) -> None:
        self.beh_id, OperatableStateMachine.autonomy_level = beh_id, autonomy_level

    def prepare_for_execution(self, input_data: dict[str, Any] | None = None) -> None:
        self._state_machine = self.create()
        for key, value in (input_data or {}).items():
            if key in self._state_machine.userdata:
                self._state_machine.userdata[key] = value

    def confirm(self) -> None:
        self._state_machine.confirm(self.name, self.beh_id)

    def execute(self) -> str:
        result: str = self._state_machine.spin()
        self._state_machine.destroy()
        return result

    @classmethod
    def preempt(cls) -> None:
        PreemptableState.preempt = True


class LoggingSeverity:
    FATAL = 50


class SignalHandlerOptions:
    NO = 0


class _Node:
    """A node of ROS 2, as far as a player of behaviors uses it."""

    def get_logger(self) -> _Node:
        return self

    def set_level(self, level: int) -> None: ...
    def destroy_node(self) -> None: ...


def ok() -> bool:
    return False


def init(*, args: list[str], signal_handler_options: int) -> None: ...
def shutdown() -> None: ...
def set_node(node: _Node) -> None: ...


def create_node(name: str, *, namespace: str) -> _Node:
    return _Node()
