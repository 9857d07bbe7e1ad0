"""Player of the Python target: the generated module is loaded once and built anew for each test
case."""

from __future__ import annotations

import copy
import logging
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, redirect_stdout, suppress
from functools import partial
from pathlib import Path
from typing import Any

from smachac.ir.nodes import Machine
from smachac.runtime.tracing import trace
from smachac.runtime.tracing.instrument import is_container
from smachac.runtime.tracing.writer import SECRET, trace_value
from smachac.targets.python.runner import (
    failure_text,
    hidden,
    loaded,
    main_function,
    places,
    quiet,
    watching,
)
from smachac.verify.players.ros_stand_ins import built, ros_stand_ins
from smachac.verify.python_values import ITEMS
from smachac.verify.test_case import Event, Player, TestCase, UnplayableError, record_read


def player(name: str, text: str, machine: Machine, *, folders: Sequence[Path]) -> Player:
    """A player of the module `text`, which may import modules of the user from `folders`.

    The first trace loads the module; each trace creates the objects of its states. Raises
    UnplayableError if that fails.
    """
    sources = places(machine)

    def play(cases: Sequence[TestCase]) -> Iterator[list[Event]]:
        with (
            unplayable_errors("the Python program"),
            ros_stand_ins(text, machine),
            loaded(name, text, *folders) as module,
            quiet(module["smach"], hidden),
        ):
            for case in cases:
                yield trace_of(_machine_of(module, machine), machine.root.name, case, sources)

    return play


_SMACH = ("smach", "smachac")
"""The packages whose containers a generated program uses."""


class _Found(BaseException):
    """The machine is about to run. No `except Exception` of the program catches it."""


def _machine_of(module: dict[str, Any], machine: Machine) -> Any:
    """A new machine of a loaded program.

    A program that is one function, as SMACHA's are, has no function `build`: its main function is
    called, and is left before the machine runs.
    """
    if "build" in module:
        return built(module["build"])
    found: list[Any] = []

    def leave(root: Any) -> None:
        found.append(root)
        raise _Found

    with suppress(_Found), watching(module, leave):
        main_function(module, machine)()
    if not found:
        raise RuntimeError("the program runs no state machine")
    return found[0]


@contextmanager
def unplayable_errors(program: str) -> Iterator[None]:
    """Convert errors outside the machine to UnplayableError, and send output of the program to
    stderr."""
    try:
        with redirect_stdout(sys.stderr):
            yield
    except Exception as error:
        words = f"{program} cannot be loaded: {failure_text(error)}"
        raise UnplayableError(words) from error


def trace_of(machine: Any, name: str, case: TestCase, sources: dict[str, str]) -> list[Event]:
    """The trace of one run; an error that ends the run is an event of it."""
    events: list[Event] = []
    strict = trace.StrictScript(case.reads, partial(record_read, events), case.most)
    prepared(machine, name, case, strict)
    trace.attach(machine, name, events.append, sources, secret=case.secret)
    if case.stopped:
        machine.request_preempt()
    with suppress(Exception):
        machine.execute()
    return events


@contextmanager
def silent(name: str) -> Iterator[None]:
    """Without the messages of a logger: the errors of a test case are in its trace."""
    log = logging.getLogger(name)
    before, log.disabled = log.disabled, True
    try:
        yield
    finally:
        log.disabled = before


def without_secret(event: Event, case: TestCase) -> Event:
    """An event of a machine on another engine as in a trace: secret values are hidden."""
    if event["event"] != "write":
        return event
    is_secret = event["key"] in case.secret.get(event["path"], ())
    return {**event, "value": SECRET if is_secret else trace_value(event["value"])}


def prepared(machine: Any, name: str, case: TestCase, strict: trace.StrictScript) -> Any:
    """The machine of SMACH `machine`, whose states perform the steps of a test case."""
    for path, key, value in case.samples:
        container = _state_at(machine, path)
        if key == ITEMS:
            container._items = value
        else:
            container.userdata[key] = copy.deepcopy(value)
    for key, value in case.userdata.items():
        machine.userdata[key] = value
    for path in case.rows:
        _close(_state_at(machine, path))
    trace.script(machine, name, case.rows, strict)
    return machine


def _close(state: Any) -> None:
    """Hide the states of a container that is a class of the user: in the script it is one state."""
    if is_container(state) and type(state).__module__.partition(".")[0] not in _SMACH:
        state.get_children = None


def _state_at(machine: Any, path: str) -> Any:
    """The state at a path of a built machine."""
    for name in path.split("/")[1:]:
        machine = machine.get_children()[name]
    return machine
