"""Messages of exceptions, also of those that cannot be printed."""

from __future__ import annotations


def message_of(error: BaseException) -> str:
    """The message of an exception; empty if its `__str__` raises another one."""
    try:
        return str(error)
    except Exception:
        return ""


def described(error: BaseException) -> str:
    """The type and the message of an exception: `ValueError: too far`."""
    message = message_of(error)
    return f"{type(error).__name__}: {message}" if message else type(error).__name__
