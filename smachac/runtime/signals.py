"""Stop signals: SIGINT (Ctrl-C), SIGTERM (systemd, `docker stop`, launch) and SIGHUP (a closed
terminal) are stop requests; the second one ends the process at once."""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import threading

TYPE_CHECKING = False  # annotations only: typing would be a third of the imports
if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Any

SIGNALS = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
)
"""The stop signals; Windows has no SIGHUP."""

received: list[int] = []
"""The number of the first stop signal that this process handled; empty if there was none."""


def exit_code(code: int = 0) -> int:
    """The exit code of a program: 128 + the number of the stop signal; without one, `code`."""
    return 128 + received[0] if received else code


def handled() -> list[int]:
    """The stop signals that this process does not ignore: `nohup` makes it ignore SIGHUP."""
    return [number for number in SIGNALS if signal.getsignal(number) is not signal.SIG_IGN]


class StopSignals:
    """The handler of the stop signals between `install` and `remove`, or in a `with` block.

    The first signal calls `stop` in a thread; each later one calls `end` with its number. A second
    thread reads the signals from a socket, because Python runs no signal handler while the main
    thread is blocked.
    """

    def __init__(self, stop: Callable[[], object], end: Callable[[int], object]) -> None:
        self._stop, self._end = stop, end
        self._stopping = threading.Thread(target=stop, name="stop", daemon=True)

    def install(self) -> None:
        """Handle the signals from now on; to be called in the main thread."""
        received.clear()
        self._read, self._write = socket.socketpair()
        self._write.setblocking(False)
        self._pipe_before = signal.set_wakeup_fd(self._write.fileno(), warn_on_full_buffer=False)
        self._before = {number: signal.signal(number, self) for number in handled()}
        self._terminals = [stream for stream in range(3) if os.isatty(stream)]
        self._reading = threading.Thread(target=self._wait, name="signals", daemon=True)
        self._reading.start()

    def ignore(self) -> None:
        """Ignore all signals until `remove`, while the program cleans up."""
        for number in self._before:
            signal.signal(number, signal.SIG_IGN)

    def remove(self, limit: float = 0.0) -> None:
        """Restore the handlers that were there before; wait up to `limit` seconds for `stop`."""
        for number, handler in self._before.items():
            signal.signal(number, handler)
        signal.set_wakeup_fd(self._pipe_before)
        self._write.send(b"\0")
        self._reading.join()
        if self._stopping.ident is not None:
            self._stopping.join(limit)
        self._read.close()
        self._write.close()

    def __enter__(self) -> None:
        self.install()

    def __exit__(self, *_: object) -> None:
        self.remove()

    def __call__(self, number: int, frame: object) -> None:
        """Note the signal; the thread does the rest."""
        if not received:
            received.append(number)

    def _wait(self) -> None:
        """Read the signals; a zero byte ends this."""
        while number := self._read.recv(1)[0]:
            if number not in self._before:
                continue  # Python writes the numbers of all signals that have a handler
            if self._stopping.ident is not None:
                self._end(number)
                continue
            self(number, None)
            for stream in self._terminals:
                if not os.isatty(stream):  # it was closed: output to it is an error
                    os.dup2(os.open(os.devnull, os.O_RDWR), stream)
            self._stopping.start()


def end_now(number: int) -> Any:
    """End the process with the exit code for a signal; nothing is cleaned up."""
    with contextlib.suppress(OSError):
        os.write(2, b"interrupted\n")
    os._exit(128 + number)


def stop_at_signals(machine: Any) -> None:
    """Preempt a machine at the first stop signal, for the rest of the program."""
    StopSignals(machine.request_preempt, end_now).install()
