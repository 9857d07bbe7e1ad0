"""smachac: a compiler for robot task state machines.

The verbs of the command line for programs; they read the disk and print nothing:

    import smachac
    for finding in smachac.check("main.yml"): ...
    files = smachac.build("main.yml", "python")
"""

from __future__ import annotations

TYPE_CHECKING = False  # typing and pathlib would double the time of `smachac --version`
if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from os import PathLike
    from typing import Any

    from smachac.diagnostics import Report
    from smachac.driver import Analysis
    from smachac.ir.nodes import Checked
    from smachac.states import Library

    Folders = Sequence[str | PathLike[str]]

__version__ = "0.1.0"


class ScriptError(Exception):
    """A script has errors; `report` holds everything there is to say about it."""

    def __init__(self, report: Report) -> None:
        from smachac.report.text import render_text

        super().__init__(render_text(report))
        self.report = report


def analyse_file(
    path: str | PathLike[str], scripts: Folders, templates: Folders
) -> tuple[Analysis, Library | None]:
    """The script at `path`, read and judged; and the library it was read with."""
    from pathlib import Path

    from smachac.driver import Analysis, analyse
    from smachac.files import disk_library, read_source

    report: Report = []
    source = read_source(Path(path), report)
    if source is None:
        return Analysis(report=report), None
    folders = [[Path(folder) for folder in each] for each in (scripts, templates)]
    library = disk_library(Path(path), report, scripts=folders[0], templates=folders[1])
    return analyse(source, library, report), library


def check(path: str | PathLike[str], *, scripts: Folders = (), templates: Folders = ()) -> Report:
    """Every finding about the script at `path`, in order; empty when there is nothing to say.

    `scripts` and `templates` are more folders with sub-scripts and with state types.
    """
    return analyse_file(path, scripts, templates)[0].report


def load(path: str | PathLike[str], *, scripts: Folders = (), templates: Folders = ()) -> Checked:
    """The checked machine of the script at `path`. Raises ScriptError."""
    analysis, _ = analyse_file(path, scripts, templates)
    if analysis.checked is None:
        raise ScriptError(analysis.report)
    return analysis.checked


def build(
    path: str | PathLike[str],
    target: str,
    *,
    options: Mapping[str, str] | None = None,
    scripts: Folders = (),
    templates: Folders = (),
) -> dict[str, str]:
    """The files that a target prints for the script at `path`, with those that they stand on: name
    to text, not yet written.

    Raises ScriptError, LookupError for an unknown target, ValueError for a bad option.
    """
    from smachac import driver
    from smachac.diagnostics import has_errors
    from smachac.files import runtime_files
    from smachac.targets import load_target

    found = load_target(target)
    if found is None:
        raise LookupError(f"there is no target `{target}`")
    analysis, library = analyse_file(path, scripts, templates)
    if analysis.checked is None or library is None:
        raise ScriptError(analysis.report)
    report: Report = []
    files = driver.build(analysis.checked, found, library, report, options)
    if has_errors(report):
        raise ScriptError(driver.together(analysis.report, report))
    return {**files, **runtime_files(found.runtime(files))}


def run(
    path: str | PathLike[str],
    *,
    seed: int = 0,
    observe: Callable[[dict[str, Any]], None] | None = None,
    scripts: Folders = (),
    templates: Folders = (),
) -> str | None:
    """Run the generated program of the script at `path` in this process; its outcome.

    `observe` gets the events of the trace. Raises ScriptError, and whatever the program raises.
    """
    from pathlib import Path

    from smachac.execute import execute

    machine = load(path, scripts=scripts, templates=templates)
    ((name, text),) = build(path, "python", scripts=scripts, templates=templates).items()
    return execute(name, text, machine, observe, folder=Path(path).parent, seed=seed)
