"""smachac: a compiler for robot task state machines. This is its public API (docs/api.md).

    import smachac
    for finding in smachac.check("main.yml"): ...
    machine = smachac.load("main.yml")
    files = smachac.compile("main.yml", "python")
    result = smachac.run("main.yml")

A source is a path, a `Source`, or a text: with `name`, the first argument is the text itself, and
reports show it under that name. The functions read files and write and print nothing.
"""

from __future__ import annotations

from smachac.version import __version__

TYPE_CHECKING = False  # typing, dataclasses and pathlib would double the time of `--version`
if TYPE_CHECKING:
    from collections import abc
    from os import PathLike
    from typing import Any

    from smachac.diagnostics.diagnostic import Code, Diagnostic, Related, Severity
    from smachac.diagnostics.repair import Edit
    from smachac.diagnostics.source import Source, Span
    from smachac.driver import Analysis
    from smachac.ir.nodes import (
        Checked,
        Concurrence,
        Expression,
        Iterator,
        Key,
        Leaf,
        Machine,
        Node,
        Outcome,
        OutcomeRule,
        Preset,
        Remap,
        Sequence,
        StateMachine,
        Transition,
        Value,
    )
    from smachac.ir.traversal import walk
    from smachac.targets import BuildContext, Target
    from smachac.targets.python.runner import RunResult

    Text = str | PathLike[str] | Source
    Folders = abc.Sequence[str | PathLike[str]]

__all__ = [
    "BuildContext",
    "Checked",
    "Code",
    "Concurrence",
    "Diagnostic",
    "Edit",
    "Expression",
    "Iterator",
    "Key",
    "Leaf",
    "Machine",
    "Node",
    "Outcome",
    "OutcomeRule",
    "Preset",
    "Related",
    "Remap",
    "RunResult",
    "ScriptError",
    "Sequence",
    "Severity",
    "Source",
    "Span",
    "StateMachine",
    "Target",
    "Transition",
    "Value",
    "__version__",
    "check",
    "compile",
    "load",
    "run",
    "walk",
]

_HOMES = {
    **dict.fromkeys(
        ("Code", "Diagnostic", "Edit", "Related", "Severity"), "diagnostics.diagnostic"
    ),
    **dict.fromkeys(("Source", "Span"), "diagnostics.source"),
    **dict.fromkeys(("BuildContext", "Target"), "targets"),
    "RunResult": "targets.python.runner",
    "walk": "ir.traversal",
}
"""Where the exported names that are not node kinds are defined."""


def __getattr__(name: str) -> object:
    """An exported name, imported when it is first used."""
    from importlib import import_module

    if name not in __all__:
        raise AttributeError(f"module `smachac` has no attribute `{name}`")
    module = import_module(f"smachac.{_HOMES.get(name, 'ir.nodes')}")
    value: object = getattr(module, name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


class ScriptError(Exception):
    """A script has errors. `report` is the list of all its findings; the message shows them."""

    def __init__(self, report: list[Diagnostic]) -> None:
        from smachac.report.text import render_text

        super().__init__(render_text(report))
        self.report = report


def check(
    source: Text, *, name: str | None = None, scripts: Folders = (), templates: Folders = ()
) -> list[Diagnostic]:
    """All findings in a script, in order; an empty list if there are none. A notebook shows them as
    a table.

    `scripts` and `templates` are more folders with sub-scripts and with state types.
    """
    from smachac.report.notebook import Findings

    return Findings(_analysis(source, name, scripts, templates, render=True).report)


def load(
    source: Text, *, name: str | None = None, scripts: Folders = (), templates: Folders = ()
) -> Checked:
    """The checked machine of a script. A notebook shows it as a picture. Raises ScriptError."""
    from smachac.report.notebook import show_machines

    analysis = _analysis(source, name, scripts, templates)
    if analysis.checked is None:
        raise ScriptError(analysis.report)
    show_machines()
    return analysis.checked


def compile(
    source: Text,
    target: str | Target,
    *,
    name: str | None = None,
    options: abc.Mapping[str, str] | None = None,
    scripts: Folders = (),
    templates: Folders = (),
) -> dict[str, str]:
    """The files that a target generates, with the runtime files they need: name to text.

    `target` is the name of an installed target, or a `Target`. Nothing is written. Raises
    ScriptError, LookupError for an unknown target, ValueError for a bad option.
    """
    from smachac.driver import compile_files
    from smachac.targets import load_target

    found = load_target(target) if isinstance(target, str) else target
    if found is None:
        raise LookupError(f"there is no target `{target}`")
    compiled = compile_files(_analysis(source, name, scripts, templates), found, options)
    if not compiled.files:
        raise ScriptError(compiled.report)
    return compiled.files


def run(
    source: Text,
    *,
    name: str | None = None,
    seed: int = 0,
    observe: abc.Callable[[dict[str, Any]], None] | None = None,
    scripts: Folders = (),
    templates: Folders = (),
) -> RunResult:
    """Generate the Python program of a script and run it in this process.

    `observe` is called with each event of the trace when it happens. `seed` is the seed of the
    simulated world and of `random`. Raises ScriptError, and every exception of the program.
    """
    from pathlib import Path

    from smachac.driver import compile_script
    from smachac.frontend.files import module_folders
    from smachac.records import replace
    from smachac.targets.python import TARGET
    from smachac.targets.python.runner import PythonProgram, execute

    analysis = _analysis(source, name, scripts, templates)
    compiled = compile_script(analysis, TARGET)
    if analysis.checked is None or not compiled.files:
        raise ScriptError(compiled.report)
    ((file, text),) = compiled.files.items()
    events: list[dict[str, Any]] = []

    def note(event: dict[str, Any]) -> None:
        events.append(event)
        if observe is not None:
            observe(event)

    folders = module_folders(Path(analysis.script))
    program = PythonProgram(name=file, text=text, machine=analysis.checked, folders=folders)
    result = execute(program, note, seed=seed)
    return replace(result, events=tuple(events))


def _analysis(
    source: Text, name: str | None, scripts: Folders, templates: Folders, render: bool = False
) -> Analysis:
    from smachac.diagnostics.source import Source
    from smachac.driver import analyse_script

    if name is not None:
        source = Source(name, str(source))
    return analyse_script(source, scripts, templates, render=render)
