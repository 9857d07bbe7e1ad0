"""Callbacks that declare outcomes and userdata keys, as states do."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, Protocol, TypeGuard

from smachac.runtime.smach import settings
from smachac.runtime.smach.settings import set_shutdown_check as set_shutdown_check


def is_shutdown() -> bool:
    """Whether running containers are to end, by the shutdown check that is set now."""
    return settings.is_shutdown()


class Interface(Protocol):
    """An object that declares its outcomes and the userdata keys that it reads and writes."""

    def get_registered_outcomes(self) -> tuple[str, ...]: ...
    def get_registered_input_keys(self) -> tuple[str, ...]: ...
    def get_registered_output_keys(self) -> tuple[str, ...]: ...


def has_smach_interface(obj: object) -> TypeGuard[Interface]:
    """Whether `obj` has the three getters of a state's outcomes and keys."""
    return (
        hasattr(obj, "get_registered_outcomes")
        and hasattr(obj, "get_registered_input_keys")
        and hasattr(obj, "get_registered_output_keys")
    )


class CBInterface:
    """A callable with declared outcomes and keys; it calls `cb` with the same arguments."""

    def __init__(
        self,
        cb: Callable[..., Any],
        outcomes: Iterable[str] = (),
        input_keys: Iterable[str] = (),
        output_keys: Iterable[str] = (),
        io_keys: Iterable[str] = (),
    ) -> None:
        shared = list(io_keys)
        self._cb: Callable[..., Any] = cb
        self._outcomes = tuple(outcomes)
        self._input_keys = (*input_keys, *shared)
        self._output_keys = (*output_keys, *shared)

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        return self._cb(*args, **kwargs)

    def get_registered_outcomes(self) -> tuple[str, ...]:
        """The declared outcomes."""
        return self._outcomes

    def get_registered_input_keys(self) -> tuple[str, ...]:
        """The keys that may be read."""
        return self._input_keys

    def get_registered_output_keys(self) -> tuple[str, ...]:
        """The keys that may be written."""
        return self._output_keys


def cb_interface(
    outcomes: Iterable[str] = (),
    input_keys: Iterable[str] = (),
    output_keys: Iterable[str] = (),
) -> Callable[[Callable[..., Any]], CBInterface]:
    """Decorate a function with the outcomes and keys it declares."""

    def decorate(cb: Callable[..., Any]) -> CBInterface:
        return CBInterface(cb, outcomes, input_keys, output_keys)

    return decorate
