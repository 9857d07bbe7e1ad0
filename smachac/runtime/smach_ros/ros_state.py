"""RosState: a leaf that waits for ROS and can be preempted; the user callbacks of such leaves."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from smachac.runtime import smach
from smachac.runtime.smach import InvalidStateError, Remapper, State, has_smach_interface
from smachac.runtime.smach_ros import ros

POLL_INTERVAL = 0.05
"""Seconds between two checks of the conditions that notify nobody: shutdown, ROS time."""


class RosState(State):
    """A state whose waits end at a preempt request, a shutdown of the node, or a time limit."""

    def __init__(
        self,
        outcomes: Iterable[str],
        input_keys: list[str] | None = None,
        output_keys: list[str] | None = None,
    ) -> None:
        super().__init__(outcomes, input_keys, output_keys)
        self._rospy = ros.rospy()
        self._changed = threading.Condition()

    def request_preempt(self) -> None:
        """Request that the state ends early; its wait ends."""
        super().request_preempt()
        self._wake()

    def _wake(self) -> None:
        """Make the waiting thread check its condition again."""
        with self._changed:
            self._changed.notify_all()

    def _stopped(self) -> bool:
        """Whether waits are to end: a preempt request or a shutdown."""
        return self.preempt_requested() or bool(self._rospy.is_shutdown())

    def _wait(
        self,
        ready: Callable[[], bool],
        limit: float | None = None,
        stopped: Callable[[], bool] | None = None,
    ) -> bool:
        """Wait until `ready()`, `stopped()`, or `limit` seconds of ROS time; whether it is ready.

        `stopped` defaults to a preempt request or a shutdown.
        """
        stopped = stopped or self._stopped
        end = None if limit is None else self._rospy.get_time() + limit
        while not ready():
            if stopped() or (end is not None and self._rospy.get_time() >= end):
                return False
            with self._changed:
                self._changed.wait(POLL_INTERVAL)
        return True

    def _preempted(self) -> bool:
        """Whether there is a preempt request; if so, it is marked as answered."""
        if not self.preempt_requested():
            return False
        self.service_preempt()
        return True


@dataclass(frozen=True, slots=True, kw_only=True)
class Callback:
    """A function of the user, with the userdata keys that it may read and write."""

    function: Callable[..., Any]
    args: tuple[Any, ...]
    kwargs: Mapping[str, Any]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]

    def __call__(self, ud: Any, *given: Any) -> Any:
        """Call it with its userdata, the arguments of the state, then those of the user."""
        view = Remapper(ud, self.inputs, self.outputs, {})
        return self.function(view, *given, *self.args, **self.kwargs)


def callback(
    state: State,
    what: str,
    function: Callable[..., Any] | None,
    args: Iterable[Any],
    kwargs: Mapping[str, Any] | None,
    keys: tuple[Iterable[str], Iterable[str]],
) -> Callback | None:
    """The callback `function` of a state; None if there is none.

    Its keys are those that it declares (see `smach.cb_interface`), which are registered with the
    state, or else `keys` (input keys, output keys). Raises InvalidStateError if it is not callable.
    """
    if function is None:
        return None
    if not callable(function):
        raise InvalidStateError(f"the {what} callback {function!r} of a state cannot be called")
    call: Callable[..., Any] = function
    if has_smach_interface(function):
        keys = function.get_registered_input_keys(), function.get_registered_output_keys()
        state.register_input_keys(keys[0])
        state.register_output_keys(keys[1])
    inputs, outputs = keys
    return Callback(
        function=call,
        args=tuple(args),
        kwargs=dict(kwargs or {}),
        inputs=tuple(inputs),
        outputs=tuple(outputs),
    )


def check_slots(slots: Iterable[str], message: Any, what: str) -> list[str]:
    """The slots as a list. Raises InvalidStateError for one that the message does not have."""
    listed, known = list(slots), list(message.__slots__)
    unknown = [slot for slot in listed if slot not in known]
    if unknown:
        raise InvalidStateError(f"the {what} has no slots {unknown}; it has {known}")
    return listed


def is_outcome(state: State, outcome: Any, name: str) -> bool:
    """Whether a callback's result is an outcome of the state; logged if not."""
    known = state.get_registered_outcomes()
    if outcome not in known:
        smach.logerr(f"{name}: a callback returned {outcome!r}; the outcomes are {list(known)}")
    return outcome in known
