"""Failures of user code: the errors that containers raise for them, with frames of user code."""

from __future__ import annotations

from pathlib import Path
from types import TracebackType
from typing import TypeVar

from smachac.runtime.messages import message_of
from smachac.runtime.smach import settings
from smachac.runtime.smach.exceptions import SmachError

E = TypeVar("E", bound=SmachError)

RUNTIME = str(Path(__file__).parents[1] / "_").removesuffix("_")
"""The folder whose frames are not shown."""


def child_error(kind: type[E], label: str, state: object, error: BaseException) -> BaseException:
    """The error of a container for the error of a child; it names the state that failed first, and
    its cause is the error of that state. The error itself, to be raised on, if it is of this kind,
    as in SMACH, or if it is no Exception.

    Frames of the runtime are removed from the traceback of the error.
    """
    if not (isinstance(error, Exception) or settings.compat):
        return error
    blames = error.blames if isinstance(error, SmachError) else ""
    if not blames:
        blames = f"state '{label}' of type {type(state).__name__} failed: {one_line(error)}"
        _own_frames_only(kind, blames, error)
    if isinstance(error, kind):
        if not error.blames and hasattr(error, "add_note"):
            error.add_note(f"in state '{label}' of type {type(state).__name__}")
        error.blames = blames
        return error
    found = kind(blames, logged=True, blames=blames)
    found.__cause__ = error
    if isinstance(error, SmachError) and error.__cause__ is not None:
        found.__cause__ = error.__cause__
    return found


def callback_error(kind: type[E], called: str, error: Exception) -> E:
    """The error of a container for the error of one of its callbacks, which is its cause."""
    blames = f"{called} failed: {one_line(error)}"
    _own_frames_only(kind, blames, error)
    found = kind(blames, logged=True, blames=blames)
    found.__cause__ = error
    return found


def _own_frames_only(kind: type[SmachError], message: str, error: BaseException) -> None:
    """Remove the frames of the runtime from the traceback of an error; with `compat`, log a message
    with the lines of user code."""
    own = without_runtime(error.__traceback__)
    error.__traceback__ = own or error.__traceback__
    if settings.compat:
        settings.log_raised("\n".join([f"{kind.__name__}: {message}", *_frames(own)]))


def one_line(error: BaseException) -> str:
    """The type and the first line of an exception."""
    lines = message_of(error).splitlines()
    first = next((line for line in lines if line.strip()), "")
    return f"{type(error).__name__}: {first}" if first else type(error).__name__


def without_runtime(trace: TracebackType | None) -> TracebackType | None:
    """A traceback without the frames of the runtime; None if there are no others."""
    kept = []
    while trace is not None:
        if not trace.tb_frame.f_code.co_filename.startswith(RUNTIME):
            kept.append(trace)
        trace = trace.tb_next
    found = None
    for type_ in reversed(kept):
        found = TracebackType(found, type_.tb_frame, type_.tb_lasti, type_.tb_lineno)
    return found


def _frames(trace: TracebackType | None) -> list[str]:
    """The lines of a traceback, the innermost frame last."""
    import traceback

    return "".join(traceback.format_tb(trace)).rstrip().splitlines()


def near(word: str, names: list[str]) -> str:
    """A question that names the nearest of some names; empty if none is near."""
    import difflib

    found = difflib.get_close_matches(word, names[:1000], n=1) if len(word) < 100 else []
    return f" did you mean '{found[0]}'?" if found else ""
