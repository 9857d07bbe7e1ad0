"""What is set for the whole process, and the world that is open in it."""

from __future__ import annotations

import atexit
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .faults import Fault
    from .scene import World


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """What a World takes where it is told nothing else."""

    seed: int = 0
    gui: bool = False
    record: str | Path | None = None
    faults: tuple[Fault | Mapping[str, Any], ...] = ()


_settings = Settings()
_open: list[World] = []


def configure(
    *,
    seed: int = 0,
    gui: bool = False,
    record: str | Path | None = None,
    faults: Iterable[Fault | Mapping[str, Any]] = (),
) -> None:
    """Set what worlds opened from now on take; what is left out goes back to its default."""
    global _settings
    _settings = Settings(seed=seed, gui=gui, record=record, faults=tuple(faults))


def current() -> Settings:
    """What is set."""
    return _settings


def world() -> World:
    """The world that is open, the last one of several; one is opened if none is."""
    if _open:
        return _open[-1]
    from .scene import World

    return World()


def opened(each: World) -> None:
    """A world tells that it is open."""
    _open.append(each)


def closed(each: World) -> None:
    """A world tells that it is closed."""
    if each in _open:
        _open.remove(each)


@atexit.register
def close() -> None:
    """Close all worlds, so that films are whole even where nobody closed them."""
    while _open:
        _open[-1].close()
