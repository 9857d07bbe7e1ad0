"""Ctrl-C and the other stop signals: they end the process at once, except where a command has to
clean up."""

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


def end_at_stop_signals() -> None:
    """Make SIGTERM and SIGHUP end the process as Ctrl-C does, for commands that run machines."""
    from smachac.runtime.signals import handled

    for number in handled():
        if signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, end_at_once)


@contextlib.contextmanager
def interrupts_raise() -> Iterator[None]:
    """Make the first stop signal raise KeyboardInterrupt, so that `with` and `finally` clean up. It
    is noted in `smachac.runtime.signals.received`; the second one ends the process at once."""
    from smachac.runtime.signals import handled, received

    def interrupt(number: int, frame: object) -> None:
        if received:
            end_at_once(number)
        received.append(number)
        raise KeyboardInterrupt

    received.clear()
    before = {number: signal.signal(number, interrupt) for number in handled()}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def end_at_once(number: int = signal.SIGINT, *_: object) -> None:
    """A signal handler that ends the process."""
    with contextlib.suppress(OSError, RuntimeError):  # in the middle of a print, or a closed stream
        sys.stdout.flush()
    with contextlib.suppress(OSError):
        os.write(2, b"interrupted\n")
    os._exit(128 + number)
