"""SMACH without its log, as long as a test needs it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from smachac.runtime import smach


def _silent(message: str, *arguments: object) -> None:
    pass


@contextmanager
def quiet(library: Any = smach) -> Iterator[None]:
    """Loggers are process-wide: what was set before comes back.

    `library` is the SMACH in use, if not the bundled runtime.
    """
    before = library.loginfo, library.logwarn, library.logdebug, library.logerr
    library.set_loggers(_silent, _silent, _silent, _silent)
    try:
        yield
    finally:
        library.set_loggers(*before)
