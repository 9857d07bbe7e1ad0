"""Python files as arguments of commands for scripts: their machines, by name."""

from __future__ import annotations

from argparse import Namespace

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from smachac.driver import Analysis
    from smachac.frontend.discovery import PythonFiles
    from smachac.frontend.files import Disk


UNREAD = ""
"""The name in place of the machines of a file that cannot be read."""


class MachineError(Exception):
    """The arguments name no machine, or not one; `known` are the names nearest to `word`, or all
    names."""

    def __init__(self, message: str, word: str = "", known: tuple[str, ...] = ()) -> None:
        super().__init__(message)
        self.word, self.known = word, known


def is_python(path: Path) -> bool:
    """Whether an argument is a Python file and not a script."""
    from smachac.frontend.discovery import PYTHON_SUFFIX

    return path.suffix == PYTHON_SUFFIX


def python_finder(arguments: Namespace) -> PythonFiles | None:
    """The function that finds the Python files with machines in a folder, if `--python` is given:
    its modules are imported then alone."""
    if not arguments.python:
        return None
    from smachac.driver.python_machines import files_with_machines

    return files_with_machines


def python_analyses(paths: Iterable[Path], disk: Disk) -> dict[str, Mapping[str, Analysis]]:
    """The machines of Python files by the names of file and machine, each with its findings. Those
    of a file that cannot be read have the name UNREAD."""
    from smachac.driver import Analysis
    from smachac.driver.python_machines import PythonProject, analyses_by_name

    project = PythonProject(disk)
    found: dict[str, Mapping[str, Analysis]] = {}
    for path in paths:
        file = project.read(path)
        unread = Analysis(script=str(path), source=file.source, report=file.report)
        found[str(path)] = {UNREAD: unread} if file.coverage is None else analyses_by_name(file)
    return found


def named_analyses(path: Path, disk: Disk, name: str | None) -> Mapping[str, Analysis]:
    """As `python_analyses` of one file, with a name that of this machine alone. Raises MachineError
    if there is no machine, or none of that name."""
    found = python_analyses([path], disk)[str(path)]
    if not found:
        raise MachineError(f"no state machine found in {path}")
    if name is None or UNREAD in found:
        return found
    if name not in found:
        raise MachineError(f"{path} has no machine `{name}`", name, tuple(found))
    return {name: found[name]}


def one_analysis(path: Path, disk: Disk, name: str | None) -> Analysis:
    """The only machine of a Python file, or that of a name. Raises MachineError."""
    found = named_analyses(path, disk, name)
    if len(found) > 1:
        message = f"{path} has {len(found)} machines: use --machine NAME"
        raise MachineError(message, "", tuple(found))
    return next(iter(found.values()))
