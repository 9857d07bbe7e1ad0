"""Several scripts checked together: a file that they share is read once and reported once.

A sub-script is checked through its callers; one without a caller is checked alone.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import Path

from smachac.diagnostics.diagnostic import Diagnostic, Report, identity, in_order
from smachac.diagnostics.source import Source, Word
from smachac.driver import CODES, Analysis, MachineCheck, Previous, analyse, read_machine
from smachac.frontend.discovery import PYTHON_SUFFIX
from smachac.frontend.errors.suppressions import unused_allowances
from smachac.frontend.files import Disk, disk_library
from smachac.frontend.loader import Library
from smachac.frontend.text.suppressions import Suppression
from smachac.frontend.text.yaml_tree import Seq
from smachac.ir.recursion import deep_recursion
from smachac.ir.traversal import outer_inputs, outer_outputs
from smachac.records import dataclass, field

TYPE_CHECKING = False
if TYPE_CHECKING:
    from smachac.python_machines import PythonProject


@dataclass(frozen=True, kw_only=True)
class Batch:
    """The reports of several scripts by name, in the order given.

    A sub-script that one of the others calls has no report of its own. `uses` holds, by the same
    names, the real paths of all files that a script was read from, and of those that were looked
    for and not found. `analyses` has the analysis of each script.
    """

    reports: Mapping[str, Report]
    uses: Mapping[str, frozenset[str]]
    analyses: Mapping[str, Analysis] = field(default_factory=dict, compare=False, repr=False)

    @cached_property
    def report(self) -> Report:
        """All findings in order; a finding in a shared sub-script appears once."""
        return in_order(item for report in self.reports.values() for item in report)

    def only(self, kept: Report) -> Batch:
        """The same scripts, with only the findings that are in `kept`."""
        known = {identity(item) for item in kept}
        reports = {
            name: [item for item in report if identity(item) in known]
            for name, report in self.reports.items()
        }
        return replace(self, reports=reports)

    def touched_by(self, changed: set[str]) -> Batch:
        """The scripts that use one of these files."""
        names = [name for name, used in self.uses.items() if used & changed]
        return Batch(
            reports={name: self.reports[name] for name in names},
            uses={name: self.uses[name] for name in names},
        )


def check_scripts(
    paths: Sequence[Path],
    disk: Disk,
    scripts: Sequence[Path] = (),
    templates: Sequence[Path] = (),
    extra: MachineCheck | None = None,
    previous: dict[str, Previous] | None = None,
    *,
    everything: bool = False,
    cached: bool = False,
) -> Batch:
    """Check scripts by all rules and by `extra`: sub-scripts through their callers, or alone; and
    the machines in Python files, with `everything` by all rules. `cached`: what is known of Python
    files from the last run is used, and kept for the next one.

    Templates of the user are rendered, for their findings. `previous` are the results of the last
    analyses by path, which become those of these ones.
    """
    analyses: dict[str, Analysis] = {}
    uses: dict[str, frozenset[str]] = {}
    alone: list[Path] = []

    def analyse_path(path: Path, source: Source | None, report: Report, *, called: bool) -> None:
        if source is None:
            analyses[str(path)] = Analysis(report=report)
        else:
            library = disk_library(
                path, report, scripts=scripts, templates=templates, disk=disk, codes=CODES
            )
            last = None if previous is None else previous.setdefault(str(path), Previous())
            if called:
                analyses[str(path)] = analyse(
                    source, library, report, extra, render=True, previous=last
                )
            else:
                analyses[str(path)] = analyse_alone(source, library, report, last)
        uses[str(path)] = disk.searched_files()

    python = _python_project(paths, disk, cached=cached)
    for path in paths:
        disk.searched.clear()
        report: Report = []
        if python is not None and path.suffix == PYTHON_SUFFIX:
            file = python.read(path, everything=everything)
            analyses[str(path)] = Analysis(
                script=str(path), source=file.source, report=file.report, coverage=file.coverage
            )
            uses[str(path)] = disk.searched_files()
            continue
        source = disk.read(path, report)
        if source is not None and isinstance(disk.parse(source, []), Seq):
            alone.append(path)
        else:
            analyse_path(path, source, report, called=True)
    if python is not None:
        python.keep()
    called = frozenset().union(*uses.values())
    alone = [path for path in alone if os.path.realpath(path) not in called]
    for path in alone:
        disk.searched.clear()
        analyse_path(path, disk.read(path, []), [], called=False)
    for path in alone:  # one that another sub-script calls was checked through it already
        others = (used for name, used in uses.items() if name != str(path))
        if any(os.path.realpath(path) in used for used in others):
            del uses[str(path)], analyses[str(path)]
    names = [str(path) for path in paths if str(path) in analyses]
    reports = {name: analyses[name].report for name in names}
    if len(names) > 1:
        _report_unused_allowances(analyses, reports)
    return Batch(
        reports=reports,
        uses={name: uses[name] for name in names},
        analyses={name: analyses[name] for name in names},
    )


def _python_project(paths: Sequence[Path], disk: Disk, *, cached: bool) -> PythonProject | None:
    """The reader of Python files, if there is one among the paths: its modules are imported then
    alone."""
    if all(path.suffix != PYTHON_SUFFIX for path in paths):
        return None
    from smachac.python_machines import PythonProject

    return PythonProject(disk, cached=cached)


def _report_unused_allowances(analyses: Mapping[str, Analysis], reports: dict[str, Report]) -> None:
    """SM021 for suppressions in sub-scripts that suppress nothing for any caller."""
    needed: set[Suppression] = set()
    for analysis in analyses.values():
        needed |= set(analysis.given) - set(analysis.unused)
    done = set(needed)
    for name in reports:
        new = [fit for fit in dict.fromkeys(analyses[name].unused) if fit not in done]
        done.update(new)
        words = (Word(fit.code, fit.span) for fit in new)
        reports[name] = [*reports[name], *unused_allowances(words)]


def analyse_alone(
    source: Source,
    library: Library,
    report: Report,
    previous: Previous | None = None,
) -> Analysis:
    """The analysis of a sub-script that no script calls: a script is generated that calls it.

    The generated script provides the keys that the sub-script needs and ends with its outcomes.
    Params come from callers, so unresolved look-ups are not reported. Undefined names are not
    reported either: the base template of a caller may define them. The machine is that of the
    generated script, and so never a checked one.
    """
    name = f"{source.name} (alone)"

    def script(word: str, by: str) -> Source | None:
        return source if by == name else library.script(word, by)

    own = replace(library, script=script)
    with deep_recursion():
        machine = read_machine(_caller(name, (), (), ()), own, [])
    if machine is None or not machine.root.children:
        caller = _caller(name, (), (), ())
    else:
        state = machine.root.children[0]
        outcomes = [outcome.name for outcome in state.outcomes]
        caller = _caller(name, outcomes, outer_inputs(state), outer_outputs(state))
    found = analyse(caller, own, report, previous=previous)
    left = list(_without(caller, found.report))
    return replace(found, source=source, library=library, report=left, checked=None, alone=True)


def _caller(
    name: str, outcomes: Iterable[str], inputs: Iterable[str], outputs: Iterable[str]
) -> Source:
    """A script that calls one sub-script, and ends with its outcomes."""
    ends = list(outcomes)
    script = {
        "name": "alone",
        "template": "Base",
        "outcomes": ends or ["done"],
        "forever": not ends,
        "input_keys": list(inputs),
        "output_keys": list(outputs),
        "states": [{"CALL": {"script": "called", "transitions": {end: end for end in ends}}}],
    }
    return Source(name, json.dumps(script, ensure_ascii=False))


def _without(caller: Source, report: Report) -> Iterator[Diagnostic]:
    """The findings that are not in the generated caller."""
    for item in report:
        if item.span.source is caller or item.code in ("SM015", "SM019"):
            continue
        finding = item.finding
        related = tuple(each for each in finding.related if each.span.source is not caller)
        yield replace(item, finding=replace(finding, related=related))
