"""State, the leaf of a machine, and CBState, a leaf around a function."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from smachac.runtime.smach.util import has_smach_interface


class State:
    """Something with outcomes that runs on userdata.

    `input_keys` may be read from the userdata, `output_keys` written, `io_keys` both;
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
        # Dicts as ordered sets: what is listed later does not hang on the hash seed.
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
        """Ask the state to end early; it may take notice through `preempt_requested`."""
        self._preempt_requested = True

    def service_preempt(self) -> None:
        """Mark the request as answered."""
        self._preempt_requested = False

    def recall_preempt(self) -> None:
        """Take the request back."""
        self._preempt_requested = False

    def preempt_requested(self) -> bool:
        """Whether a request waits for an answer."""
        return self._preempt_requested


class CBState(State):
    """A state that calls `cb(userdata, *cb_args, **cb_kwargs)` and ends with what it returns.

    A callback that declares outcomes and keys (see `cb_interface`) adds them to the state's.
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

    def execute(self, ud: Any, /) -> str | None:
        """Call the function."""
        outcome: str | None = self._cb(ud, *self._cb_args, **self._cb_kwargs)
        return outcome
