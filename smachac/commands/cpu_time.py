"""The limit of CPU time of a command, as a last resort against scripts and templates that take very
long."""

from __future__ import annotations

import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NoReturn

DEFAULT = 600
"""In seconds. The largest scripts that are accepted take less than a minute."""


class CpuTimeError(BaseException):
    """The limit is exceeded. No `except Exception` around code of templates catches it."""

    def __init__(self) -> None:
        super().__init__("the limit of CPU time is exceeded; raise it with `--time-limit`")


@contextmanager
def limited_time(seconds: int) -> Iterator[None]:
    """More CPU time than so many seconds raises CpuTimeError inside a `with` block.

    0 is no limit. A lower limit of the process stays. Windows has no such limit, and there is none
    outside of the main thread, which receives the signals.
    """
    import threading

    if not seconds or threading.current_thread() is not threading.main_thread():
        yield
        return
    try:
        import resource
    except ImportError:
        yield
        return
    soft, hard = resource.getrlimit(resource.RLIMIT_CPU)
    known = [number for number in (soft, hard) if number != resource.RLIM_INFINITY]
    before = signal.signal(signal.SIGXCPU, _exceeded)
    limit = min([*known, int(time.process_time()) + seconds + 1])
    resource.setrlimit(resource.RLIMIT_CPU, (limit, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_CPU, (soft, hard))
        signal.signal(signal.SIGXCPU, before)


def _exceeded(number: int, frame: object) -> NoReturn:
    raise CpuTimeError
