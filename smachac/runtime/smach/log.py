"""The default loggers and shutdown check, and the logger that drops every message."""

from __future__ import annotations

from collections.abc import Callable

Logger = Callable[[str], object]
"""A function of one message; its return value is ignored."""


def quiet(msg: str) -> None:
    """Drop the message. Info lines are not built at all while this is the info logger."""


set_loggers: Callable[[Logger, Logger, Logger, Logger], None]
"""The function `set_loggers` of `settings`, which sets it here, as SMACH has it here too."""


_EMPTY_BYTECODE = (lambda: None).__code__.co_code
"""The bytecode of a function that only returns a constant."""


def audible(logger: Logger) -> Logger:
    """The logger itself, or `quiet` if it is a function that does nothing but return."""
    code = getattr(logger, "__code__", None)
    return quiet if code is not None and code.co_code == _EMPTY_BYTECODE else logger


def loginfo(msg: str) -> None:
    """Print an info line to stdout."""
    print(f"[ INFO ] {msg}")


def logwarn(msg: str) -> None:
    """Print a warning line to stdout."""
    print(f"[ WARN ] {msg}")


def logdebug(msg: str) -> None:
    """Print a debug line to stdout."""
    print(f"[ DEBUG ] {msg}")


def logerr(msg: str) -> None:
    """Print an error line to stdout."""
    print(f"[ ERROR ] {msg}")


def is_shutdown() -> bool:
    """The default shutdown check: never."""
    return False
