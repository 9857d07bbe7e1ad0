"""The exceptions of SMACH: four classes with a common base."""

from __future__ import annotations

from smachac.runtime.smach import settings


class SmachError(Exception):
    """The common base. With `compat`, creating one writes its message to the error logger, as in
    SMACH, unless it is `logged` already.

    Attributes:
        blames: the state that failed first, and how, as a sentence; empty if not known.
    """

    def __init__(self, message: str, logged: bool = False, blames: str = "") -> None:
        super().__init__(message)
        self.blames = blames
        if not logged:
            settings.log_raised(f"{type(self).__name__}: {message}")


class InvalidTransitionError(SmachError):
    """A transition or an outcome without a valid target."""


class InvalidStateError(SmachError):
    """A container that is built or run incorrectly, or a failed branch of a concurrence."""


class InvalidConstructionError(SmachError):
    """A container that is not open for construction where it has to be."""


class InvalidUserCodeError(SmachError):
    """The code of a state or a callback raised, or read a key that it does not declare."""
