"""State, the leaf of a machine, and CBState, a leaf that calls a function."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from smachac.runtime.smach.util import has_smach_interface


class State:
    """A state: it runs on userdata and ends with one of its outcomes.

    It may read the userdata keys `input_keys`, write `output_keys`, and do both with `io_keys`;
    all three are lists. Subclasses define `execute`.
    """

    def __init__(
        self,
        outcomes: Iterable[str] | None = None,
        input_keys: list[str] | None = None,
        output_keys: list[str] | None = None,
        io_keys: list[str] | None = None,
    ) -> None:
        shared = io_keys or []
        # Dicts as ordered sets: the order of outcomes and keys must not depend on the hash seed.
        self._outcomes: dict[str, None] = dict.fromkeys(outcomes or ())
        self._input_keys: dict[str, None] = dict.fromkeys((input_keys or []) + shared)
        self._output_keys: dict[str, None] = dict.fromkeys((output_keys or []) + shared)
        self._preempt_requested = False

    def execute(self, ud: Any, /) -> str | None:
        """Run on the userdata; the outcome. Raises NotImplementedError unless overridden."""
        raise NotImplementedError

    def register_outcomes(self, new_outcomes: Iterable[str]) -> None:
        """Add outcomes."""
        self._outcomes.update(dict.fromkeys(new_outcomes))

    def get_registered_outcomes(self) -> tuple[str, ...]:
        """The outcomes, in the order of registration."""
        return tuple(self._outcomes)

    def register_io_keys(self, keys: Iterable[str]) -> None:
        """Add keys that are both input and output."""
        added = dict.fromkeys(keys)
        self._input_keys.update(added)
        self._output_keys.update(added)

    def register_input_keys(self, keys: Iterable[str]) -> None:
        """Add keys that may be read."""
        self._input_keys.update(dict.fromkeys(keys))

    def get_registered_input_keys(self) -> tuple[str, ...]:
        """The keys that may be read."""
        return tuple(self._input_keys)

    def register_output_keys(self, keys: Iterable[str]) -> None:
        """Add keys that may be written."""
        self._output_keys.update(dict.fromkeys(keys))

    def get_registered_output_keys(self) -> tuple[str, ...]:
        """The keys that may be written."""
        return tuple(self._output_keys)

    def request_preempt(self) -> None:
        """Request that the state ends early; its code may check `preempt_requested`."""
        self._preempt_requested = True

    def service_preempt(self) -> None:
        """Mark the request as answered."""
        self._preempt_requested = False

    def recall_preempt(self) -> None:
        """Withdraw the request."""
        self._preempt_requested = False

    def preempt_requested(self) -> bool:
        """Whether there is a request that is not marked as answered."""
        return self._preempt_requested


class CBState(State):
    """A state that calls `cb(userdata, *cb_args, **cb_kwargs)`; the return value is its outcome.

    Outcomes and keys that the callback declares (see `cb_interface`) are added to the state.
    """

    def __init__(
        self,
        cb: Callable[..., Any],
        cb_args: Iterable[Any] = (),
        cb_kwargs: Mapping[str, Any] | None = None,
        outcomes: Iterable[str] | None = None,
        input_keys: list[str] | None = None,
        output_keys: list[str] | None = None,
        io_keys: list[str] | None = None,
    ) -> None:
        super().__init__(outcomes, input_keys, output_keys, io_keys)
        self._cb: Callable[..., Any] = cb
        self._cb_args = tuple(cb_args)
        self._cb_kwargs = dict(cb_kwargs or {})
        if has_smach_interface(cb):
            self.register_outcomes(cb.get_registered_outcomes())
            self.register_input_keys(cb.get_registered_input_keys())
            self.register_output_keys(cb.get_registered_output_keys())

    def execute(self, ud: Any) -> str | None:
        """Call the function."""
        outcome: str | None = self._cb(ud, *self._cb_args, **self._cb_kwargs)
        return outcome
