"""SMACH without its log, as long as a test needs it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from smachac.runtime import smach


def _silent(message: str, *arguments: object) -> None:
    pass


@contextmanager
def quiet() -> Iterator[None]:
    """Loggers are process-wide: what was set before comes back."""
    before = smach.loginfo, smach.logwarn, smach.logdebug, smach.logerr
    smach.set_loggers(_silent, _silent, _silent, _silent)
    try:
        yield
    finally:
        smach.set_loggers(*before)
