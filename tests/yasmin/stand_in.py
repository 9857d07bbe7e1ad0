"""A stand-in for the Python API of YASMIN 6.1.1 that generated modules and machines of users need,
with its errors.

YASMIN is on no registry of packages. The behaviour was read in its source: state.cpp,
state_machine.cpp, concurrence.cpp, blackboard.cpp and their bindings. The states of a concurrence
run one after the other.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any


class Blackboard:
    """Values by name. A copy has the same values and remappings of its own."""

    def __init__(self, other: Blackboard | None = None) -> None:
        self._values: dict[str, Any] = {} if other is None else other._values
        self._remappings: dict[str, str] = {} if other is None else dict(other._remappings)

    def copy(self) -> Blackboard:
        return Blackboard(self)

    def _name(self, key: str) -> str:
        if not isinstance(key, str):
            raise TypeError("incompatible function arguments")
        return self._remappings.get(key, key)

    def __getitem__(self, key: str) -> Any:
        if self._name(key) not in self._values:
            raise RuntimeError(f"Element '{key}' does not exist in the blackboard")
        return self._values[self._name(key)]

    def __setitem__(self, key: str, value: Any) -> None:
        self._values[self._name(key)] = value

    set, get = __setitem__, __getitem__

    def __delitem__(self, key: str) -> None:
        self._values.pop(self._name(key), None)

    def __contains__(self, key: str) -> bool:
        return self._name(key) in self._values

    def keys(self) -> list[str]:
        visible = {to: key for key, to in self._remappings.items()}
        return sorted(visible.get(key, key) for key in self._values)

    def get_remappings(self) -> dict[str, str]:
        return dict(self._remappings)

    def set_remappings(self, remappings: Mapping[str, str]) -> None:
        self._remappings = dict(remappings)


class State:
    """A state: `__call__` checks the outcome of `execute`."""

    def __init__(self, outcomes: Iterable[str]) -> None:
        if not list(outcomes):
            raise RuntimeError("A state must have at least one possible outcome.")
        self._outcomes = set(outcomes)
        self._status = "idle"
        self._parameters: dict[str, Any] = {}
        self._defaults: dict[str, Any] = {}

    def declare_parameter(self, name: str, description: str, *default: Any) -> None:
        if default:
            self._parameters.setdefault(name, default[0])

    def set_parameter(self, name: str, value: Any) -> None:
        self._parameters[name] = value

    def get_parameter(self, name: str) -> Any:
        return self._parameters[name]

    def add_input_key(self, name: str, description: str, *default: Any) -> None:
        if default:
            self._defaults[name] = default[0]

    def _inject(self, blackboard: Blackboard) -> None:
        """Sets the keys with default values that the blackboard does not have."""
        for key, value in self._defaults.items():
            if key not in blackboard:
                blackboard[key] = value

    def get_outcomes(self) -> set[str]:
        return set(self._outcomes)

    def is_running(self) -> bool:
        return self._status == "running"

    def is_canceled(self) -> bool:
        return self._status == "canceled"

    def cancel_state(self) -> None:
        self._status = "canceled"

    def configure(self) -> None:
        pass

    def execute(self, blackboard: Blackboard) -> str:
        raise RuntimeError('Tried to call pure virtual function "State::execute"')

    def __call__(self, blackboard: Blackboard | None = None) -> str:
        self._status = "running"
        board = Blackboard() if blackboard is None else blackboard
        self._inject(board)
        outcome = self.execute(board)
        if not isinstance(outcome, str):
            raise TypeError("Unable to cast Python instance to C++ type")
        if outcome not in self._outcomes:
            self._status = "idle"
            raise RuntimeError(f"Outcome '{outcome}' does not belong to the outcomes of the state")
        if self._status != "canceled":
            self._status = "completed"
        return outcome


class CbState(State):
    """A state that calls a function."""

    def __init__(self, outcomes: Iterable[str], callback: Callable[[Blackboard], str]) -> None:
        super().__init__(outcomes)
        self._callback = callback

    def execute(self, blackboard: Blackboard) -> str:
        return self._callback(blackboard)


class Concurrence(State):
    """States that run at the same time. Of the rules, at most one may hold."""

    def __init__(
        self,
        states: Mapping[str, State],
        default_outcome: str,
        outcome_map: Mapping[str, Mapping[str, str]] = {},
    ) -> None:
        super().__init__([*outcome_map, default_outcome])
        self._states, self._default, self._rules = dict(states), default_outcome, outcome_map

    def configure(self) -> None:
        for state in self._states.values():
            state.configure()

    def execute(self, blackboard: Blackboard) -> str:
        ended = {name: state(blackboard.copy()) for name, state in sorted(self._states.items())}
        found = [outcome for outcome, rule in self._rules.items() if rule.items() <= ended.items()]
        if len(found) > 1:
            raise RuntimeError(f"More than one satisfied outcomes ({', '.join(found)})")
        return found[0] if found else self._default


class StateMachine(State):
    """A state machine. Classes that derive from it in Python cannot replace `execute`."""

    def __init__(self, outcomes: Iterable[str], handle_sigint: bool = False) -> None:
        super().__init__(outcomes)
        self._states: dict[str, State] = {}
        self._transitions: dict[str, dict[str, str]] = {}
        self._remappings: dict[str, dict[str, str]] = {}
        self._start_state = self._current = ""
        self._cancel = False
        self._callbacks: dict[str, list[Callable[..., None]]] = {"start": [], "move": [], "end": []}

    def add_state(
        self,
        name: str,
        state: State,
        transitions: Mapping[str, str] = {},
        remappings: Mapping[str, str] = {},
    ) -> None:
        if name in self._states:
            raise RuntimeError(f"State '{name}' already registered in the state machine")
        if name in self._outcomes:
            raise RuntimeError(f"State name '{name}' is already registered as an outcome")
        for outcome, target in transitions.items():
            if not outcome or not target:
                raise ValueError(f"Transitions with empty source or target in state '{name}'")
            if outcome not in state.get_outcomes():
                raise ValueError(f"State '{name}' references unregistered outcomes '{outcome}'")
        self._states[name] = state
        self._transitions[name] = dict(transitions)
        self._remappings[name] = dict(remappings)
        self._start_state = self._start_state or name

    def set_start_state(self, name: str) -> None:
        if name not in self._states:
            raise ValueError(f"Initial state '{name}' is not in the state machine")
        self._start_state = name

    def add_start_cb(self, callback: Callable[..., None]) -> None:
        self._callbacks["start"].append(callback)

    def add_transition_cb(self, callback: Callable[..., None]) -> None:
        self._callbacks["move"].append(callback)

    def add_end_cb(self, callback: Callable[..., None]) -> None:
        self._callbacks["end"].append(callback)

    def _call(self, kind: str, *arguments: object) -> None:
        """YASMIN logs what a callback raises; here the test fails."""
        for callback in self._callbacks[kind]:
            callback(*arguments)

    def validate(self) -> None:
        """What YASMIN checks before the first run."""
        if not self._start_state:
            raise RuntimeError("No initial state set")
        for state in self._states.values():
            if isinstance(state, StateMachine):
                state.validate()
        targets = {to for edges in self._transitions.values() for to in edges.values()}
        for target in targets:
            if target not in self._states and target not in self._outcomes:
                raise RuntimeError(f"State machine outcome '{target}' not registered")
        reached, todo = {self._start_state}, [self._start_state]
        while todo:
            for target in self._transitions[todo.pop()].values():
                if target not in self._outcomes and target not in reached:
                    reached.add(target)
                    todo.append(target)
        for name in self._states:
            if name not in reached:
                raise RuntimeError(f"State '{name}' is unreachable")

    def configure(self) -> None:
        for state in self._states.values():
            state.configure()

    def get_current_state(self) -> str:
        return self._current

    def cancel_state(self) -> None:
        if self.is_running() and self._current:
            self._states[self._current].cancel_state()

    def cancel_state_machine(self) -> None:
        if self.is_running():
            self._cancel = True
            state = self._states.get(self._current)
            if isinstance(state, StateMachine):
                state.cancel_state_machine()
            elif state is not None:
                state.cancel_state()
            State.cancel_state(self)

    def _check_cancel(self) -> None:
        if self._cancel:
            raise RuntimeError("State machine was canceled")

    def execute(self, blackboard: Blackboard) -> str:
        raise AssertionError("YASMIN calls StateMachine::execute of C++")

    def __call__(self, blackboard: Blackboard | None = None) -> str:
        self._status = "running"
        board = Blackboard() if blackboard is None else blackboard
        self._inject(board)
        self.validate()
        self.configure()
        self._cancel = False
        self._current = self._start_state
        self._call("start", board, self._start_state)
        try:
            while True:
                self._check_cancel()
                outcome = self._step(board)
                if outcome is not None:
                    break
        except BaseException:
            self._call("end", board, "")
            self._current = ""
            raise
        if self._status != "canceled":
            self._status = "completed"
        return outcome

    def _step(self, board: Blackboard) -> str | None:
        name = self._current
        before = board.get_remappings()
        own = {key: before.get(to, to) for key, to in self._remappings[name].items()}
        board.set_remappings({**before, **own})
        try:
            found = self._states[name](board)
        finally:
            board.set_remappings(before)
        self._check_cancel()
        outcome = self._transitions[name].get(found, found)
        if outcome in self._outcomes:
            self._current = ""
            self._call("end", board, outcome)
            return outcome
        if outcome not in self._states:
            raise RuntimeError(f"Outcome '{outcome}' is not a state nor a state machine outcome")
        self._call("move", board, name, outcome, found)
        self._current = outcome
        return None


__all__ = ["Blackboard", "CbState", "Concurrence", "State", "StateMachine"]
