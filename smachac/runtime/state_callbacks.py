"""The user callbacks of states that use ROS, for both versions of ROS."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from smachac.runtime import smach
from smachac.runtime.smach import InvalidStateError, Remapper, State, has_smach_interface


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


def is_outcome(state: State, outcome: Any, name: str) -> bool:
    """Whether a callback's result is an outcome of the state; logged if not."""
    known = state.get_registered_outcomes()
    if outcome not in known:
        smach.logerr(f"{name}: a callback returned {outcome!r}; the outcomes are {list(known)}")
    return outcome in known


def checked_slots(slots: Iterable[str], known: Iterable[str], what: str) -> list[str]:
    """The slots as a list. Raises InvalidStateError for one that the message does not have."""
    listed, fields = list(slots), list(known)
    unknown = [slot for slot in listed if slot not in fields]
    if unknown:
        raise InvalidStateError(f"the {what} has no slots {unknown}; it has {fields}")
    return listed
