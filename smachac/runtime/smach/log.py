"""The default loggers, the one that drops everything, and the default shutdown check."""

from __future__ import annotations

from collections.abc import Callable

Logger = Callable[[str], object]
"""Takes one message; what it returns is ignored."""


def quiet(message: str) -> None:
    """The logger that drops every message; info lines are not even built for it."""


_CONSTANT = (lambda: None).__code__.co_code


def audible(logger: Logger) -> Logger:
    """The logger itself, or `quiet` if it is a function that does nothing but return."""
    code = getattr(logger, "__code__", None)
    return quiet if code is not None and code.co_code == _CONSTANT else logger


def loginfo(message: str) -> None:
    """Print an info line to stdout."""
    print(f"[ INFO ] {message}")


def logwarn(message: str) -> None:
    """Print a warning line to stdout."""
    print(f"[ WARN ] {message}")


def logdebug(message: str) -> None:
    """Print a debug line to stdout."""
    print(f"[ DEBUG ] {message}")


def logerr(message: str) -> None:
    """Print an error line to stdout."""
    print(f"[ ERROR ] {message}")


def is_shutdown() -> bool:
    """The shutdown check of a machine that nothing outside can stop: never."""
    return False
