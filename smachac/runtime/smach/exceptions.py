"""What goes wrong with machines: four classes under one base."""

from __future__ import annotations

from smachac.runtime import smach


class SmachError(Exception):
    """The common base. Making one, caught later or not, writes it to the error logger."""

    def __init__(self, message: str) -> None:
        super().__init__(message)
        smach.logerr(f"{type(self).__name__}: {message}")


class InvalidTransitionError(SmachError):
    """A transition or an outcome that leads nowhere."""


class InvalidStateError(SmachError):
    """A container put together or run the wrong way, or a branch of a concurrence that failed."""


class InvalidConstructionError(SmachError):
    """A container that should have been open for construction and is not."""


class InvalidUserCodeError(SmachError):
    """The code of a state or of a callback raised, or read a key that it does not declare."""
