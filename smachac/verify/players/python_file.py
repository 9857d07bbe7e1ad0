"""Player of a Python program on disk, such as one that was edited by hand.

The states of its machine are replaced as those of a generated program are. Before the first test
case its states, outcomes and keys are compared with those of the script.
"""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, redirect_stdout, suppress
from importlib import import_module
from pathlib import Path
from types import FrameType
from typing import Any

from smachac.diagnostics.source import Source
from smachac.ir.nodes import Key, Leaf, Machine, Node
from smachac.ir.traversal import outcome_names, walk
from smachac.runtime import smach as runtime_smach
from smachac.runtime.messages import described
from smachac.runtime.tracing.instrument import is_container
from smachac.targets.python.runner import hidden, loaded, places, quiet
from smachac.verify.file_faults import FileFault, unplayable
from smachac.verify.players.python import trace_of
from smachac.verify.players.ros_stand_ins import built, ros_stand_ins
from smachac.verify.test_case import Event, Player, TestCase, UnplayableError

ADDING = ("add", "add_auto", "set_contained_state")
"""The functions of SMACH's containers that add a state."""

AGAIN = "generate the file again with `smachac build --target python`"

Lines = dict[tuple[int, str], tuple[int, object]]
"""The line in which a state was added, by the id of the state and its label. The state is kept, so
that no other object gets its id."""


def file_player(source: Source, machine: Machine, *, folders: Sequence[Path]) -> Player:
    """A player of a Python program on disk, which may import modules from `folders`.

    Raises UnplayableError, with the place in the file, if the program cannot be loaded, has no
    function `build`, or builds a machine with other states, outcomes or keys than the script.
    """

    def play(cases: Sequence[TestCase]) -> Iterator[list[Event]]:
        with (
            _file_faults(source, folders),
            ros_stand_ins(source.text, machine),
            ExitStack() as stack,
        ):
            for smach in _smachs():
                stack.enter_context(quiet(smach, hidden))
            added: Lines = {}
            with _not_run(), _recorded(source.name, added):
                module = stack.enter_context(
                    loaded(source.name, source.text, *folders, importable=True)
                )
                build = _build_function(source, module)
                root = built(build)
            if not is_container(root):
                raise unplayable(source, [_no_machine(build, root)])
            found = _states(root, machine.root.name)
            labels = {path: path.rpartition("/")[2] for path in found}
            lines = {
                path: added.get((id(state), labels[path]), (0, None))[0]
                for path, state in found.items()
            }
            lines[machine.root.name] = _first_line(build)
            faults = list(_differences(found, machine, lines))
            if faults:
                raise unplayable(source, faults)
            stem = source.file_name
            sources = {path: f"{stem}:{line}" for path, line in lines.items() if line}
            for number, case in enumerate(cases):
                yield trace_of(built(build) if number else root, machine.root.name, case, sources)

    return play


# The file as a module


@contextmanager
def _file_faults(source: Source, folders: Sequence[Path]) -> Iterator[None]:
    """Convert exceptions of the file to UnplayableError, and send its output to stderr."""
    try:
        with redirect_stdout(sys.stderr):
            yield
    except UnplayableError:
        raise
    except (Exception, SystemExit) as error:
        message = f"the program cannot be loaded: {described(error)}"
        lines = _lines_of(error, source.name)
        line, help_ = lines[-1], f"correct it, or {AGAIN}"
        if isinstance(error, SyntaxError) and error.filename == source.name:
            message = f"this is not Python {sys.version_info[0]}: {error.msg}"
            line = error.lineno or 0
        elif isinstance(error, ImportError):
            homes = ", ".join(dict.fromkeys(os.path.realpath(folder) for folder in folders))
            help_ = f"install it; modules of your own are found in {homes}"
        elif isinstance(error, SystemExit | _RunsError):
            message = "the program runs its machine, or ends, when it is loaded"
            line = lines[0]
            help_ = "move this below `if __name__ == '__main__':`"
        raise unplayable(source, [FileFault(message=message, line=line, help=help_)]) from error


def _lines_of(error: BaseException, name: str) -> list[int]:
    """The lines of the file in the traceback of an exception, outermost first; 0 if there are
    none."""
    frames = traceback.extract_tb(error.__traceback__)
    return [frame.lineno or 0 for frame in frames if frame.filename == name] or [0]


def _smachs() -> list[Any]:
    """SMACH itself, where it is installed, and the bundled runtime: a program imports one of
    them."""
    found: list[Any] = [runtime_smach]
    with suppress(ImportError):
        found.append(import_module("smach"))
    return [smach for smach in found if hasattr(smach, "set_loggers")]


@contextmanager
def _replaced(names: Sequence[str], replacement: Callable[[Any], Any]) -> Iterator[None]:
    """Replace functions of the containers of SMACH, by name; `replacement` gets the function."""
    changed = [
        (kind, name, vars(kind)[name])
        for smach in _smachs()
        for kind in dict.fromkeys(
            type_ for type_ in vars(smach).values() if isinstance(type_, type)
        )
        for name in names
        if name in vars(kind) and is_container(kind)
    ]
    for kind, name, _ in changed:
        setattr(kind, name, replacement(getattr(kind, name)))
    try:
        yield
    finally:
        for kind, name, before in changed:
            setattr(kind, name, before)


class _RunsError(Exception):
    """The file runs a machine, though it is only loaded."""


@contextmanager
def _not_run() -> Iterator[None]:
    """Let no machine run. The file may keep the replaced functions, which then work as before."""
    loading = True

    def guarded(execute: Callable[..., Any]) -> Callable[..., Any]:
        def run(*arguments: Any, **keywords: Any) -> Any:
            if loading:
                raise _RunsError
            return execute(*arguments, **keywords)

        return run

    try:
        with _replaced(["execute"], guarded):
            yield
    finally:
        loading = False


def _build_function(source: Source, module: dict[str, Any]) -> Callable[[], Any]:
    build = module.get("build")
    if callable(build):
        return build  # type: ignore[no-any-return]
    message = "the program has no function `build` that returns its state machine"
    help_ = f"add `def build():` with a `return` of the outermost machine, or {AGAIN}"
    raise unplayable(source, [FileFault(message=message, help=help_)])


def _no_machine(build: Callable[[], Any], built: object) -> FileFault:
    type_ = type(built).__name__
    return FileFault(
        message=f"`build` returns a value of type {type_}, which is no state machine",
        line=_first_line(build),
        help="it has to return the outermost machine",
    )


def _first_line(build: Callable[[], Any]) -> int:
    code = getattr(build, "__code__", None)
    return code.co_firstlineno if code is not None else 0


# Lines of states


@contextmanager
def _recorded(name: str, added: Lines) -> Iterator[None]:
    """Record the line of the file `name` in which each state is added to a container."""
    with _replaced(ADDING, lambda add: staticmethod(_recording(add, name, added))):
        yield


def _recording(add: Callable[..., Any], name: str, added: Lines) -> Callable[..., Any]:
    def recording(*arguments: Any, **keywords: Any) -> Any:
        given = dict(zip(("label", "state"), arguments, strict=False)) | keywords
        label, state = given.get("label"), given.get("state")
        added.setdefault((id(state), str(label)), (_calling_line(name), state))
        return add(*arguments, **keywords)

    return recording


def _calling_line(name: str) -> int:
    """The line of the file that is executed now; 0 if none is."""
    frame: FrameType | None = sys._getframe(2)
    while frame is not None and frame.f_code.co_filename != name:
        frame = frame.f_back
    return 0 if frame is None else frame.f_lineno


# Comparison with the script


def _differences(
    found: Mapping[str, Any], machine: Machine, lines: Mapping[str, int]
) -> Iterator[FileFault]:
    """What the machine of a file has more or less than the script: states, outcomes, keys."""
    root, nodes, srcs = machine.root, dict(walk(machine.root)), places(machine)
    edit = f"edit the script too, or {AGAIN}"
    for path in nodes:
        around = path.rpartition("/")[0]
        if path not in found and is_container(found.get(around)):
            message = f"the state `{path}` of the script ({srcs[path]}) is not in the program"
            yield FileFault(message=message, line=lines[around], help=edit)
    for path, state in found.items():
        around = path.rpartition("/")[0]
        if path not in nodes:
            if around in nodes and not isinstance(nodes[around], Leaf):
                message = f"the state `{path}` of the program is not in the script"
                yield FileFault(message=message, line=lines[path], help=edit)
        elif is_container(state) == isinstance(nodes[path], Leaf):
            kinds = ("a container", "no container")
            here, there = kinds if is_container(state) else reversed(kinds)
            message = f"`{path}` is {here}, but {there} in the script ({srcs[path]})"
            yield FileFault(message=message, line=lines[path], help=edit)
    for what, ours, theirs in _interface(root, found[root.name]):
        if set(ours) != set(theirs):
            message = f"the machine has the {what} {_listed(theirs)}, in the script {_listed(ours)}"
            yield FileFault(message=message, line=lines[root.name], help=edit)


def _states(built: Any, name: str) -> dict[str, Any]:
    """The states of a built machine by path, containers before their children."""
    found = {}
    stack = [(name, built)]
    while stack:
        path, state = stack.pop()
        found[path] = state
        if is_container(state):
            children = state.get_children().items()
            inner = [(f"{path}/{label}", child) for label, child in children if child is not None]
            stack.extend(reversed(inner))
    return found


def _interface(root: Node, built: Any) -> Iterator[tuple[str, Sequence[str], Sequence[str]]]:
    """What the outermost machine declares, in the script and in the file."""
    yield "outcomes", outcome_names(root), built.get_registered_outcomes()
    yield "input keys", _key_names(root.inputs), built.get_registered_input_keys()
    yield "output keys", _key_names(root.outputs), built.get_registered_output_keys()


def _key_names(keys: Sequence[Key]) -> list[str]:
    return [key.name for key in keys]


def _listed(names: Sequence[str]) -> str:
    return ", ".join(f"`{name}`" for name in sorted(map(str, names))) or "(none)"
