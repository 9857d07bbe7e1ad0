"""PyBullet itself: found or missed with a clear word, silent, one client to an object."""

import contextlib
import functools
import os
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

_QUIET = threading.RLock()


class SimUnavailable(RuntimeError):  # noqa: N818
    """The simulation cannot start here; the text says what is missing and how to get it."""


class UnknownNameError(KeyError):
    """A limb, body or frame that the world does not have; the text names those it has."""

    def __init__(self, kind: str, name: str, known: object) -> None:
        names = ", ".join(f"`{each}`" for each in known) if isinstance(known, tuple) else known
        super().__init__(f"no {kind} `{name}`; known: {names or 'none'}")

    def __str__(self) -> str:
        return str(self.args[0])


@contextlib.contextmanager
def quiet() -> Iterator[None]:
    """Nothing written to the file descriptors 1 and 2 meanwhile gets out.

    PyBullet prints from C, below sys.stdout; a trace on standard output must stay readable.
    """
    with _QUIET, contextlib.ExitStack() as undo:
        for stream in (sys.stdout, sys.stderr):
            with contextlib.suppress(AttributeError, ValueError, OSError):
                stream.flush()
        sink = os.open(os.devnull, os.O_WRONLY)
        undo.callback(os.close, sink)
        for descriptor in (1, 2):
            with contextlib.suppress(OSError):
                kept = os.dup(descriptor)
                undo.callback(os.close, kept)
                undo.callback(os.dup2, kept, descriptor)
                os.dup2(sink, descriptor)
        yield


@functools.cache
def pybullet() -> Any:
    """The pybullet module. Raises SimUnavailable when it or numpy is not installed."""
    try:
        with quiet():
            # pybullet fails deep inside C without numpy, so numpy is asked for first.
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
    try:
        import pybullet_data
    except ImportError as error:
        raise _missing(error) from error
    there = Path(pybullet_data.getDataPath()) / path
    return there if there.is_file() else None


class Engine:
    """One physics client: every function of pybullet, with the client already given."""

    def __init__(self, *, gui: bool = False) -> None:
        module = pybullet()
        # Without a display PyBullet does not fail, it ends the process.
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
        """Free the client; a second time does nothing."""
        if self.client >= 0:
            self.disconnect()
            self.client = -1
