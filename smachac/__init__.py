"""smachac: a compiler for robot task state machines.

The verbs of the command line for programs; they read the disk and print nothing:

    import smachac
    for finding in smachac.check("main.yml"): ...
    files = smachac.build("main.yml", "python")
"""

from __future__ import annotations

from smachac.version import __version__ as __version__

TYPE_CHECKING = False  # typing and pathlib would double the time of `smachac --version`
if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from os import PathLike
    from typing import Any

    from smachac.diagnostics.diagnostic import Report
    from smachac.ir.nodes import Checked

    Folders = Sequence[str | PathLike[str]]


class ScriptError(Exception):
    """A script has errors; `report` holds everything there is to say about it."""

    def __init__(self, report: Report) -> None:
        from smachac.report.text import render_text

        super().__init__(render_text(report))
        self.report = report


def check(path: str | PathLike[str], *, scripts: Folders = (), templates: Folders = ()) -> Report:
    """Every finding about the script at `path`, in order; empty when there is nothing to say.

    `scripts` and `templates` are more folders with sub-scripts and with state types.
    """
    from smachac.driver import analyse_file

    return analyse_file(path, scripts, templates)[0].report


def load(path: str | PathLike[str], *, scripts: Folders = (), templates: Folders = ()) -> Checked:
    """The checked machine of the script at `path`. Raises ScriptError."""
    from smachac.driver import analyse_file

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
    from smachac.diagnostics.diagnostic import has_errors
    from smachac.targets import BuildContext, load_target
    from smachac.targets.runtime_files import runtime_files

    found = load_target(target)
    if found is None:
        raise LookupError(f"there is no target `{target}`")
    analysis, library = driver.analyse_file(path, scripts, templates)
    if analysis.checked is None or library is None:
        raise ScriptError(analysis.report)
    report: Report = []
    files = driver.build(analysis.checked, found, library, report, options)
    if has_errors(report):
        raise ScriptError(driver.together(analysis.report, report))
    context = BuildContext(library=library, options=options or {})
    return {**files, **runtime_files(found.runtime(analysis.checked, context))}


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

    from smachac.targets.python.runner import execute

    machine = load(path, scripts=scripts, templates=templates)
    ((name, text),) = build(path, "python", scripts=scripts, templates=templates).items()
    return execute(name, text, machine, observe, folder=Path(path).parent, seed=seed)
