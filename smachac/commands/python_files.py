"""Python files as arguments of commands for scripts: their machines, by name."""

from __future__ import annotations

from argparse import Namespace

from smachac.frontend.discovery import PYTHON_SUFFIX

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from smachac.driver import Analysis
    from smachac.frontend.files import Disk


class MachineError(Exception):
    """The arguments name no machine, or not one; `known` are the names nearest to `word`, or all
    names."""

    def __init__(self, message: str, word: str = "", known: tuple[str, ...] = ()) -> None:
        super().__init__(message)
        self.word, self.known = word, known


def is_python(path: Path) -> bool:
    """Whether an argument is a Python file and not a script."""
    return path.suffix == PYTHON_SUFFIX


def python_analyses(path: Path, disk: Disk, arguments: Namespace) -> Mapping[str, Analysis]:
    """The machines of a Python file by name, each with its findings; that of `--machine` alone. Of
    a file that cannot be read, its findings by an empty name. Raises MachineError if there is no
    machine, or none of that name."""
    from smachac.driver import Analysis
    from smachac.python_machines import PythonProject, analyses_by_name

    file = PythonProject(disk).read(path)
    if file.coverage is None:
        return {"": Analysis(script=str(path), report=file.report)}
    named = analyses_by_name(file)
    if not named:
        raise MachineError(f"no state machine found in {path}")
    if arguments.machine is None:
        return named
    if arguments.machine not in named:
        message = f"{path} has no machine `{arguments.machine}`"
        raise MachineError(message, arguments.machine, tuple(named))
    return {arguments.machine: named[arguments.machine]}


def one_analysis(path: Path, disk: Disk, arguments: Namespace) -> Analysis:
    """The only machine of a Python file, or that of `--machine`. Raises MachineError."""
    found = python_analyses(path, disk, arguments)
    if len(found) > 1:
        raise MachineError(
            f"{path} has {len(found)} machines: use --machine NAME", "", tuple(found)
        )
    return next(iter(found.values()))
