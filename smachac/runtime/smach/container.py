"""Container: a state that contains states, with its own userdata and callbacks."""

from __future__ import annotations

import threading
import traceback
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from types import TracebackType
from typing import Any, ClassVar, TypeVar

from smachac.runtime.messages import described
from smachac.runtime.smach import settings
from smachac.runtime.smach.exceptions import (
    InvalidConstructionError,
    InvalidStateError,
    InvalidTransitionError,
)
from smachac.runtime.smach.state import State
from smachac.runtime.smach.user_data import Remapper, UserData, read_keys, store, write_keys

C = TypeVar("C", bound="Container")
Callbacks = list[tuple[Callable[..., object], tuple[Any, ...]]]


class _Open(threading.local):
    """The containers that are open for construction in this thread, innermost last.

    Module state, as in SMACH: `add` is a static method without a container argument.
    """

    def __init__(self) -> None:
        self.stack: list[Container] = []


_open = _Open()


def open_container(kind: type[C]) -> C:
    """The innermost open container, which must be a `kind`. Raises InvalidStateError."""
    if not _open.stack:
        raise InvalidStateError(f"no {kind.__name__} is open for construction")
    top = _open.stack[-1]
    if not isinstance(top, kind):
        raise InvalidStateError(f"the open container is a {type(top).__name__}, no {kind.__name__}")
    return top


class Container(State):
    """The base of state machines, concurrences and iterators.

    Attributes:
        userdata: the container's own store. Input keys are copied in from the parent when it
            starts, output keys out when it ends; it is never cleared in between.
    """

    _unsaved: ClassVar[tuple[str, ...]] = ("_preempting", "_running")

    def __init__(
        self,
        outcomes: Iterable[str] | None = None,
        input_keys: list[str] | None = None,
        output_keys: list[str] | None = None,
    ) -> None:
        super().__init__(outcomes, input_keys, output_keys)
        self.userdata = UserData()
        self._start_cbs: Callbacks = []
        self._transition_cbs: Callbacks = []
        self._termination_cbs: Callbacks = []
        self._make_locks()

    def _make_locks(self) -> None:
        self._preempting = threading.RLock()
        self._running = threading.Lock()

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in vars(self).items() if name not in self._unsaved}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        self._make_locks()

    # Construction

    def open(self) -> None:
        """Make this the container that `add` adds to."""
        _open.stack.append(self)

    def close(self) -> None:
        """End the construction and log what is inconsistent; states may still be added later.

        Raises InvalidStateError if another container is on top, IndexError if none is open.
        """
        if _open.stack[-1] is not self:
            raise InvalidStateError(f"a {type(self).__name__} is closed before what it contains")
        _open.stack.pop()
        try:
            self.check_consistency()
        except (InvalidStateError, InvalidTransitionError) as error:
            settings.logerr(f"the container is inconsistent: {error}")

    def __enter__(self) -> None:
        self.open()

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if error is None and _open.stack and _open.stack[-1] is self:
            self.close()
            return
        self._abandon()
        if error is None:
            raise InvalidStateError(f"a {type(self).__name__} is closed before what it contains")
        if not isinstance(error, (InvalidStateError, InvalidTransitionError)):
            settings.log_raised(f"construction failed: {described(error)}")

    def _abandon(self) -> None:
        """Remove this container, and those left open inside it, from the stack."""
        stack = _open.stack
        for depth in range(len(stack) - 1, -1, -1):
            if stack[depth] is self:
                del stack[depth:]
                return

    @contextmanager
    def opened(self: C, **kwargs: object) -> Iterator[C]:
        """Open the container for a `with` block, as its value. The arguments are ignored."""
        with self:
            yield self

    def is_opened(self) -> bool:
        """Whether the container is open for construction in this thread."""
        return any(container is self for container in _open.stack)

    def assert_opened(self, msg: str = "the container is not open for construction") -> None:
        """Raise InvalidConstructionError unless the container is open."""
        if not self.is_opened():
            raise InvalidConstructionError(msg)

    # Defined by each kind of container

    def get_children(self) -> dict[str, State]:
        """The contained states by label."""
        raise NotImplementedError

    def __getitem__(self, label: str) -> State:
        return self.get_children()[label]

    def get_initial_states(self) -> list[str]:
        """The labels that run first."""
        raise NotImplementedError

    def set_initial_state(self, initial_states: Sequence[str], userdata: UserData | None) -> None:
        """Choose the labels that run first, and merge `userdata` into the container's."""
        raise NotImplementedError

    def get_active_states(self) -> list[str]:
        """The labels that run now."""
        raise NotImplementedError

    def get_child_outcomes(self) -> dict[str, str | None]:
        """The outcomes of children that have ended, by label: in a callback, of those whose end is
        its cause."""
        return {}

    def get_internal_edges(self) -> Sequence[Sequence[str | None]]:
        """(outcome, label, target) for every outcome of every child."""
        raise NotImplementedError

    def check_consistency(self) -> None:
        """Raise InvalidStateError or InvalidTransitionError if the container cannot run."""
        raise NotImplementedError

    # Execution

    def is_running(self) -> bool:
        """Whether the container is being executed."""
        return self._running.locked()

    def _claim(self) -> None:
        """Mark the container as running until `_running` is released.

        Raises InvalidStateError if it runs already.
        """
        if not self._running.acquire(False):
            raise InvalidStateError(f"a {type(self).__name__} is executed while it runs")

    def copy_input_keys(self, parent_ud: Any) -> None:
        """Copy the input keys from the parent (UserData, Remapper or mapping; None: nothing)."""
        if parent_ud is None or not self._input_keys:
            return
        missing = read_keys(parent_ud, self._input_keys, store(self.userdata))
        if missing:
            settings.logwarn(f"input keys absent in the parent's userdata: {missing}")

    def copy_output_keys(self, parent_ud: Any) -> None:
        """Copy the output keys to the parent (UserData, Remapper or mapping; None: nothing). Keys
        that were never written are left out, as in SMACH."""
        if parent_ud is not None and self._output_keys:
            write_keys(parent_ud, self._output_keys, store(self.userdata))

    def _view(self, state: State, remapping: Mapping[str, str]) -> Remapper:
        """The userdata of a child. Later changes of a State's keys apply to it too."""
        if isinstance(state, State):
            return Remapper(self.userdata, state._input_keys, state._output_keys, remapping)
        inputs, outputs = state.get_registered_input_keys(), state.get_registered_output_keys()
        return Remapper(self.userdata, inputs, outputs, remapping)

    # Callbacks

    def register_start_cb(
        self, start_cb: Callable[..., object], cb_args: Iterable[Any] = ()
    ) -> None:
        """Call `start_cb(userdata, initial_labels, *cb_args)` at every start."""
        self._start_cbs.append((start_cb, tuple(cb_args)))

    def register_transition_cb(
        self, transition_cb: Callable[..., object], cb_args: Iterable[Any] = ()
    ) -> None:
        """Call `transition_cb(userdata, active_labels, *cb_args)` at every transition inside."""
        self._transition_cbs.append((transition_cb, tuple(cb_args)))

    def register_termination_cb(
        self, termination_cb: Callable[..., object], cb_args: Iterable[Any] = ()
    ) -> None:
        """Call `termination_cb(userdata, terminal_labels, outcome, *cb_args)` at every end."""
        self._termination_cbs.append((termination_cb, tuple(cb_args)))

    def call_start_cbs(self) -> None:
        """Run the start callbacks."""
        self._call(self._start_cbs, self.get_initial_states())

    def call_transition_cbs(self) -> None:
        """Run the transition callbacks."""
        self._call(self._transition_cbs, self.get_active_states())

    def call_termination_cbs(self, terminal_states: Any, outcome: str | None) -> None:
        """Run the termination callbacks."""
        self._call(self._termination_cbs, terminal_states, outcome)

    def _call(self, callbacks: Callbacks, *args: Any) -> None:
        """Run callbacks in order up to the first that raises, which is logged."""
        try:
            for callback, more in callbacks:
                callback(self.userdata, *args, *more)
        except Exception:
            settings.logerr(f"a callback failed:\n{traceback.format_exc()}")


def needs_request(state: State) -> bool:
    """Whether a running state gets a preempt request: a leaf that has one unanswered gets no second
    one, a container passes it on to those states inside that need it."""
    if isinstance(state, Container) and not settings.compat:
        return True
    return not state.preempt_requested()


def withdraw(state: State) -> None:
    """Recall the unanswered preempt request of a state and, except as SMACH, of states inside."""
    if not state.preempt_requested():
        return
    state.recall_preempt()
    if isinstance(state, Container) and not settings.compat:
        for child in state.get_children().values():
            withdraw(child)
