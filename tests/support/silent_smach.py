"""SMACH with loggers that print nothing."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from smachac.runtime import smach
from smachac.runtime.smach.log import quiet


@contextmanager
def silent_smach(library: Any = smach) -> Iterator[None]:
    """Silence the loggers, which are process-wide, and restore those that were set before.

    `library` is the SMACH in use, if not the bundled runtime.
    """
    before = library.loginfo, library.logwarn, library.logdebug, library.logerr
    library.set_loggers(quiet, quiet, quiet, quiet)
    try:
        yield
    finally:
        library.set_loggers(*before)
