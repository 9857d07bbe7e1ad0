"""Ctrl-C: it ends the process at once, except where a command has to clean up."""

from __future__ import annotations

import contextlib
import os
import signal
import sys

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from collections.abc import Iterator


def end_at_interrupts() -> None:
    """Make Ctrl-C end the process, also in its last moments. A KeyboardInterrupt may be lost, or
    replaced by another exception, where it is raised in the middle of an import. A process that
    ignores Ctrl-C, as one in the background does, still ignores it."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, end_at_once)


@contextlib.contextmanager
def interrupts_raise() -> Iterator[None]:
    """Make Ctrl-C raise KeyboardInterrupt, so that `with` and `finally` clean up."""
    before = signal.getsignal(signal.SIGINT)
    if before is end_at_once:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def end_at_once(*_: object) -> None:
    """A signal handler that ends the process."""
    with contextlib.suppress(OSError, RuntimeError):  # in the middle of a print, or a closed stream
        sys.stdout.flush()
    with contextlib.suppress(OSError):
        os.write(2, b"interrupted\n")
    os._exit(130)  # 128 + SIGINT
