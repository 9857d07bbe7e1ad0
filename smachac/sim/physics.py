"""Access to PyBullet: the import with a clear error, silenced output, one client per object.

PyBullet writes to the process-wide file descriptors 1 and 2, so one process-wide lock guards their
redirection.
"""

import contextlib
import functools
import os
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any, BinaryIO

_QUIET = threading.RLock()
"""Held while the file descriptors 1 and 2 are redirected."""


class SimUnavailable(RuntimeError):  # noqa: N818
    """The simulation cannot start here; the message names what is missing and how to install it."""


class UnknownNameError(KeyError):
    """The world has no limb, body or frame of that name; the message lists the known names."""

    def __init__(self, kind: str, name: str, known: object) -> None:
        names = ", ".join(f"`{item}`" for item in known) if isinstance(known, tuple) else known
        super().__init__(f"no {kind} `{name}`; known: {names or 'none'}")

    def __str__(self) -> str:
        return str(self.args[0])


@contextlib.contextmanager
def quiet(output: BinaryIO | None = None) -> Iterator[None]:
    """Keep what is written to the file descriptors 1 and 2 inside the block out of them.

    It goes to `output`, or nowhere. PyBullet prints from C code, not through sys.stdout; a trace
    on standard output must stay readable.
    """
    with _QUIET, contextlib.ExitStack() as undo:
        for stream in (sys.stdout, sys.stderr):
            with contextlib.suppress(AttributeError, ValueError, OSError):
                stream.flush()
        sink = output.fileno() if output is not None else os.open(os.devnull, os.O_WRONLY)
        if output is None:
            undo.callback(os.close, sink)
        for descriptor in (1, 2):
            with contextlib.suppress(OSError):
                kept = os.dup(descriptor)
                undo.callback(os.close, kept)
                undo.callback(os.dup2, kept, descriptor)
                os.dup2(sink, descriptor)
        yield


# Cached, because a call costs 0.1 us instead of 95 us, and each skill makes many.
@functools.cache
def pybullet() -> Any:
    """The pybullet module, imported once. Raises SimUnavailable without pybullet or numpy."""
    try:
        with quiet():
            # Without numpy, pybullet fails inside C code, so numpy is imported first.
            import numpy  # noqa: F401
            import pybullet
    except ImportError as error:
        raise _missing(error) from error
    return pybullet


def _missing(error: ImportError) -> SimUnavailable:
    return SimUnavailable(
        f"the simulation needs PyBullet and numpy ({error}); pip install 'smachac[sim]'"
    )


def data_file(path: str | Path) -> Path | None:
    """The file `path` on disk, else in PyBullet's own data; None when in neither.

    Raises SimUnavailable when that data is not installed.
    """
    here = Path(path).expanduser()
    if here.is_file():
        return here
    there = data_folder() / path
    return there if there.is_file() else None


def data_folder() -> Path:
    """The folder of PyBullet's data. Raises SimUnavailable when it is not installed."""
    try:
        import pybullet_data
    except ImportError as error:
        raise _missing(error) from error
    return Path(pybullet_data.getDataPath())


class Engine:
    """One physics client, with every function of pybullet as a method.

    Raises SimUnavailable without PyBullet, or if `gui` is set and there is no display.
    """

    def __init__(self, *, gui: bool = False) -> None:
        module = pybullet()
        # Without a display PyBullet raises no error; it ends the process.
        if gui and sys.platform == "linux" and not os.environ.get("DISPLAY"):
            raise SimUnavailable("no display for the window (DISPLAY is not set); run without gui")
        with quiet():
            self.client: int = module.connect(module.GUI if gui else module.DIRECT)
        if self.client < 0:
            raise SimUnavailable("PyBullet could not open its window; is there a display?")
        self._module = module

    def __getattr__(self, name: str) -> Any:
        found = getattr(self._module, name)
        if callable(found):
            found = functools.partial(found, physicsClientId=self.client)
        setattr(self, name, found)
        return found

    def close(self) -> None:
        """Free the client; a second call has no effect."""
        if self.client >= 0:
            with quiet():
                self.disconnect()
            self.client = -1
