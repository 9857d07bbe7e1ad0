"""Plays scenes on a generated Python program: loaded once, built anew for each."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, redirect_stdout, suppress
from functools import partial
from pathlib import Path
from typing import Any

from smachac.ir.nodes import Machine
from smachac.runtime.tracing import trace
from smachac.targets.python.runner import hidden, loaded, places, quiet
from smachac.verify.test_case import Event, Player, Scene, UnplayableError, see


def player(name: str, text: str, machine: Machine, *, folder: Path) -> Player:
    """A player of the module `text`, which may import modules of the user from `folder`.

    The first trace loads it, which imports what it imports; each one makes the objects of its
    states. Raises UnplayableError where that fails.
    """
    sources = places(machine)

    def play(scenes: Sequence[Scene]) -> Iterator[list[Event]]:
        with _told(), loaded(name, text, folder) as module, quiet(module["smach"], hidden):
            for scene in scenes:
                yield _played(module["build"](), machine.root.name, scene, sources)

    return play


@contextmanager
def _told() -> Iterator[None]:
    """What goes wrong around the machine is why it cannot be played; what the program prints is
    not part of the report."""
    try:
        with redirect_stdout(sys.stderr):
            yield
    except Exception as error:
        words = f"the Python program cannot be loaded: {type(error).__name__}: {error}"
        raise UnplayableError(words) from error


def _played(built: Any, name: str, scene: Scene, sources: dict[str, str]) -> list[Event]:
    """The trace of one run; an error that ends it is an event."""
    events: list[Event] = []
    for key, value in scene.userdata.items():
        built.userdata[key] = value
    strict = trace.StrictScript(scene.reads, partial(see, events), scene.most)
    trace.script(built, name, scene.rows, strict)
    trace.attach(built, name, events.append, sources)
    with suppress(Exception):
        built.execute()
    return events
