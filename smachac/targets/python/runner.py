"""Runs a generated Python program in this process, with a trace; stop signals preempt it."""

from __future__ import annotations

import linecache
import os
import random
import sys
import time
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial, wraps
from pathlib import Path
from types import ModuleType
from typing import Any

from smachac.ir.nodes import Machine
from smachac.ir.script_paths import script_paths
from smachac.ir.secret_keys import secret_keys
from smachac.ir.traversal import walk
from smachac.records import dataclass, field
from smachac.robots.faults import Fault
from smachac.runtime import signals
from smachac.runtime.signals import StopSignals
from smachac.runtime.smach.failures import one_line
from smachac.runtime.tracing.gate import Gate
from smachac.runtime.tracing.writer import Observer, Sink

Event = dict[str, Any]


@dataclass(frozen=True, slots=True, kw_only=True)
class RunResult:
    """How a run ended: the outcome of the machine, the events of its trace, and the userdata of the
    outermost container at the end.

    `outcome` is None if the program returned none. `userdata` is None if the program does not give
    access to its machine, as some programs of SMACHA templates do not.
    """

    outcome: str | None
    userdata: dict[str, object] | None
    events: tuple[Event, ...] = ()


def places(machine: Machine) -> dict[str, str]:
    """The place of each state in the script (`pick_block.yml:12`), by the path of the state."""
    return {
        path: f"{node.span.source.file_name}:{node.span.line}" for path, node in walk(machine.root)
    }


@dataclass(frozen=True, slots=True, kw_only=True)
class PythonProgram:
    """A generated program: the file name and text of its module, and the machine that it runs.

    `folders` are those from which it may import modules of the user (`module_folders` of
    frontend/files.py), and where it finds descriptions of robots and scenes.
    """

    name: str
    text: str
    machine: Machine
    folders: Sequence[Path]


@dataclass(frozen=True, slots=True, kw_only=True)
class Simulation:
    """The settings of the simulated worlds that a program opens: see `sim.configure`."""

    gui: bool = False
    record: Path | None = None
    faults: Sequence[Fault] = ()
    poses: Mapping[str, Mapping[str, float]] = field(default_factory=dict)


DEFAULTS = Simulation()


def execute(
    program: PythonProgram,
    observe: Observer | Sink | None,
    *,
    seed: int = 0,
    simulation: Simulation = DEFAULTS,
    on_preempt: Callable[[], None] = lambda: None,
    arguments: Sequence[str] | None = None,
    gate: Gate | None = None,
) -> RunResult:
    """Run a program; the result has no events, which `observe` receives.

    `observe` gets every event of the trace, with paths of the script; the faults of the simulation
    are events of the trace. `seed` is that of the simulated worlds and of `random`. `gate` lets a
    debugger stop the machine between two states. The first stop signal requests the machine to
    preempt and calls `on_preempt`, in another thread; a second one ends the process. `arguments`
    are those of a node of ROS 2, which handles the signals itself. Exceptions of the program are
    not caught.
    """
    from smachac.runtime.tracing import trace

    random.seed(seed)
    given = [["smachac", *arguments]] if arguments is not None else []
    machine = program.machine
    with loaded(program.name, program.text, *program.folders) as module:
        built: list[Any] = []
        emits: list[Callable[..., None]] = []

        def watch(root: Any) -> None:
            if observe is not None:
                name, shown = machine.root.name, script_paths(machine.root)
                at = places(machine)
                emits.append(
                    trace.attach(
                        root,
                        name,
                        observe,
                        at,
                        clock=_clock(),
                        paths=shown,
                        gate=gate,
                        secret=secret_keys(machine),
                    )
                )
            built.append(root)

        with (
            _configured(
                simulation,
                seed=seed,
                folders=program.folders,
                on_event=partial(_record_fault, machine, emits),
            ),
            watching(module, watch) as outcomes,
            quiet(module["smach"], _print_log),
            _stopping(built, on_preempt),
        ):
            outcome: str | None = main_function(module, machine)(*given)
        return RunResult(
            outcome=outcomes[0] if outcomes else outcome,
            userdata=_userdata(built[-1]) if built else None,
        )


def _clock() -> Callable[[], float]:
    """The clock of a trace: that of the simulated world, if the program has opened one."""
    simulation = sys.modules.get("smachac.sim")
    world = simulation.open_world() if simulation is not None else None
    return time.monotonic if world is None else lambda: world.time


@contextmanager
def _configured(simulation: Simulation, **more: Any) -> Iterator[None]:
    """The settings of simulated worlds, and `more` of them, are in force, if the program imports
    the simulation."""
    wanted = simulation.record is not None or simulation.gui
    if not wanted and "smachac.sim" not in sys.modules:
        yield
        return
    from smachac import sim

    sim.configure(
        gui=simulation.gui,
        record=simulation.record,
        faults=simulation.faults,
        poses=simulation.poses,
        **more,
    )
    try:
        yield
    finally:
        sim.configure()


def _record_fault(machine: Machine, emits: Sequence[Callable[..., None]], event: Any) -> None:
    """Record an injected fault, an event of the simulated world, in the trace of the machine.

    `during` are the paths of the active states, `sim_time` the simulated time (s).
    """
    from smachac import sim

    if event.name == "fault":
        shown = script_paths(machine.root)
        during = [shown.get(path, path) for path in sim.world().caption.split(" + ")]
        for emit in emits:
            name = machine.root.name
            emit("fault", name, fault=event.text, during=during, sim_time=event.time)


def _userdata(root: Any) -> dict[str, object]:
    """The userdata of a machine of SMACH or of the bundled runtime."""
    return {key: root.userdata[key] for key in root.userdata.keys()}  # noqa: SIM118 (no mapping)


@contextmanager
def watching(module: dict[str, Any], watch: Callable[[Any], None]) -> Iterator[list[str | None]]:
    """Calls `watch` with the machine before it runs.

    A program with a function `build` returns the machine from it, and the outcome from its main
    function. In a program that is one function, as SMACHA's are, the first machine that runs is the
    root; its outcome is put into the list.
    """
    outcomes: list[str | None] = []
    build = module.get("build")
    if build is not None:

        @wraps(build)  # a node declares the parameters of its signature
        def watched_build(*arguments: Any, **keywords: Any) -> Any:
            root = build(*arguments, **keywords)
            watch(root)
            return root

        module["build"] = watched_build
        yield outcomes
        return
    kind = module["smach"].StateMachine
    execute = kind.execute

    def watched_execute(self: Any, *arguments: Any) -> Any:
        kind.execute = execute
        watch(self)
        outcome = self.execute(*arguments)
        outcomes.append(outcome)
        return outcome

    kind.execute = watched_execute
    try:
        yield outcomes
    finally:
        kind.execute = execute


@contextmanager
def loaded(
    name: str, text: str, *folders: Path, importable: bool = False
) -> Iterator[dict[str, Any]]:
    """The namespace of the module `text`. Inside the context it can import modules of the user from
    `folders`. Exceptions of the module are not caught.

    `importable`: the module is known by its own name, as dataclasses and pickle need it, unless
    another module has that name.
    """
    module = ModuleType(Path(name).stem)
    module.__file__ = name
    linecache.cache[name] = (len(text), None, text.splitlines(keepends=True), name)
    # The program may change the working folder.
    homes = list(dict.fromkeys(Path(os.path.realpath(folder)) for folder in folders))
    sys.path[:0] = map(str, homes)
    before = set(sys.modules)
    if importable:
        sys.modules.setdefault(module.__name__, module)
    try:
        exec(compile(text, name, "exec"), module.__dict__)
        yield module.__dict__
    finally:
        for home in map(str, homes):
            if home in sys.path:
                sys.path.remove(home)
        if sys.modules.get(module.__name__) is module:
            del sys.modules[module.__name__]
        _forget(before, homes)


def _forget(before: set[str], folders: Sequence[Path]) -> None:
    """Remove the modules and packages that stand in some folders and were imported since `before`:
    the next script may have others of the same names."""
    mine = {
        name
        for name in sys.modules.keys() - before
        if "." not in name and _home(sys.modules[name]) in folders
    }
    for name in [name for name in sys.modules if name.partition(".")[0] in mine]:
        del sys.modules[name]


def _home(module: ModuleType) -> Path | None:
    """The folder that a module file or a package stands in."""
    places = [*getattr(module, "__path__", ())] or [getattr(module, "__file__", None)]
    return Path(places[0]).parent if places[0] is not None else None


def hidden(message: str, *arguments: object) -> None:
    """A logger that drops its messages."""


def _print_log(message: str, *arguments: object) -> None:
    print(message % arguments if arguments else message, file=sys.stderr)


@contextmanager
def quiet(smach: Any, log: Callable[..., None]) -> Iterator[None]:
    """Passes only warnings and errors of SMACH to `log`: progress comes from the trace."""
    before = smach.loginfo, smach.logwarn, smach.logdebug, smach.logerr
    smach.set_loggers(hidden, log, hidden, log)
    try:
        yield
    finally:
        smach.set_loggers(*before)


SMACH_ERRORS = frozenset(
    ["SmachError", "InvalidTransitionError", "InvalidStateError", "InvalidUserCodeError"]
)
"""The exceptions of containers; that of a state is their cause."""

HIDDEN = str(Path(__file__).parents[2] / "_").removesuffix("_")
"""The folder of the frames that are not shown: this package."""


def failure_text(error: BaseException) -> str:
    """The exception that user code raised first, and the lines of user code that raised it, the
    innermost last. Frames of smachac are not shown."""
    while type(error).__name__ in SMACH_ERRORS:
        cause = error.__cause__ or error.__context__
        if cause is None:
            break
        error = cause
    frames = traceback.extract_tb(error.__traceback__)
    ours = [at for at, frame in enumerate(frames, 1) if frame.filename.startswith(HIDDEN)]
    after = frames[max(ours, default=0) :] or frames
    own = [summary for summary in after if not summary.filename.startswith((HIDDEN, "<frozen"))]
    lines = [one_line(error)]
    lines += [
        f"  in {summary.filename}:{summary.lineno}, {summary.name}: {summary.line}"
        for summary in own
    ]
    if error.__cause__ is not None:
        lines.append(f"  caused by {one_line(error.__cause__)}")
    return "\n".join(lines)


def main_function(module: Mapping[str, Any], machine: Machine) -> Callable[..., Any]:
    """The main function of a loaded program. Raises NameError if it has none.

    Bases in the manner of SMACHA print its name in lower case.
    """
    name = "main"
    for variable in machine.variables:
        if variable.name == "function_name" and isinstance(variable.value.data, str):
            name = variable.value.data
    for text in (name, name.lower()):
        if callable(found := module.get(text)):
            return found  # type: ignore[no-any-return]
    raise NameError(f"the base of the program defines no function `{name}`")


def _stopping(built: Sequence[Any], on_preempt: Callable[[], None]) -> StopSignals:
    """The first stop signal is a stop request; the second one ends the process. Without a machine
    the first one does."""

    def request() -> None:
        if not built:
            signals.end_now(signals.received[0])
            return
        on_preempt()
        built[-1].request_preempt()

    return StopSignals(request, signals.end_now)
