"""Several scripts checked together: a file that they share is read once and reported once.

A sub-script is checked through its callers; one without a caller is checked alone.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from smachac.diagnostics.diagnostic import Diagnostic, Report, identity, in_order
from smachac.diagnostics.source import Source, Word
from smachac.driver import CODES, Analysis, IncrementalState, MachineCheck, analyse, read_machine
from smachac.frontend.discovery import PYTHON_SUFFIX
from smachac.frontend.errors.suppressions import unused_allowances
from smachac.frontend.files import Disk, disk_library
from smachac.frontend.loader import Library
from smachac.frontend.text.suppressions import Suppression
from smachac.frontend.text.yaml_tree import Seq
from smachac.ir.recursion import deep_recursion
from smachac.ir.traversal import outer_inputs, outer_outputs
from smachac.records import dataclass, field, replace

TYPE_CHECKING = False
if TYPE_CHECKING:
    from smachac.driver.python_machines import PythonProject


LEAST_SCRIPTS = 16
"""With fewer scripts one process is faster: the start of others takes as long as five checks."""


def processes_for(scripts: int) -> int:
    """How many processes check so many scripts in the shortest time: one for each processor that
    this process may use. It is 1 where a process cannot be copied."""
    if scripts < LEAST_SCRIPTS or not hasattr(os, "sched_getaffinity"):
        return 1
    return min(len(os.sched_getaffinity(0)), scripts // (LEAST_SCRIPTS // 2))


@dataclass(frozen=True, kw_only=True)
class Batch:
    """The reports of several scripts by name, in the order given.

    A sub-script that one of the others calls has no report of its own. `uses` holds, by the same
    names, the real paths of all files that a script was read from, and of those that were looked
    for and not found. `analyses` has the analysis of each script; those of other processes have no
    machine and no library, which `whole` makes.
    """

    reports: Mapping[str, Report]
    uses: Mapping[str, frozenset[str]]
    analyses: Mapping[str, Analysis] = field(default_factory=dict, compare=False, repr=False)
    again: Callable[[str], Analysis] | None = field(default=None, compare=False, repr=False)

    def whole(self, name: str) -> Analysis:
        """The analysis of a script with its machine and its library. That of a Python file has
        none: its text is no script."""
        analysis = self.analyses[name]
        is_whole = analysis.library is not None or Path(name).suffix == PYTHON_SUFFIX
        if is_whole or analysis.source is None or self.again is None:
            return analysis
        return self.again(name)

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


class _Checked(NamedTuple):
    """The analysis of a script, and the real paths of the files that it was read from."""

    analysis: Analysis
    uses: frozenset[str]


@dataclass(slots=True, kw_only=True)
class _Checker:
    """Checks scripts with the same options."""

    disk: Disk
    scripts: Sequence[Path]
    templates: Sequence[Path]
    extra: MachineCheck | None
    previous: dict[str, IncrementalState] | None

    def script(self, path: Path) -> _Checked | None:
        """A script checked by all rules; None if it is a sub-script."""
        self.disk.searched.clear()
        report: Report = []
        source = self.disk.read(path, report)
        if source is not None and isinstance(self.disk.parse(source, []), Seq):
            return None
        return self._checked(path, source, report, called=True)

    def light(self, path: Path) -> tuple[Analysis | None, frozenset[str]]:
        """As `script`, without what only this process can use."""
        checked = self.script(path)
        if checked is None:
            return None, frozenset()
        light = replace(checked.analysis, machine=None, checked=None, library=None)
        return light, checked.uses

    def taken(self, result: bytes | None) -> _Checked | None:
        """The result of `light` in another process; None if there is none that holds here."""
        if result is None:
            return None
        from smachac.driver.parallel import unpacked

        found = unpacked(result, self.disk)
        return _Checked(*found) if found is not None and found[0] is not None else None

    def again(self, path: str) -> Analysis:
        """The analysis of a script that is no sub-script."""
        checked = self.script(Path(path))
        assert checked is not None
        return checked.analysis

    def sub_script(self, path: Path) -> _Checked:
        """A sub-script that no script calls."""
        self.disk.searched.clear()
        return self._checked(path, self.disk.read(path, []), [], called=False)

    def _checked(
        self, path: Path, source: Source | None, report: Report, *, called: bool
    ) -> _Checked:
        if source is None:
            return _Checked(Analysis(report=report), self.disk.searched_files())
        library = disk_library(
            path,
            report,
            scripts=self.scripts,
            templates=self.templates,
            disk=self.disk,
            codes=CODES,
        )
        last = (
            None
            if self.previous is None
            else self.previous.setdefault(str(path), IncrementalState())
        )
        if called:
            found = analyse(source, library, report, self.extra, render=True, previous=last)
        else:
            found = analyse_alone(source, library, report, last)
        return _Checked(found, self.disk.searched_files())


def check_scripts(
    paths: Sequence[Path],
    disk: Disk,
    scripts: Sequence[Path] = (),
    templates: Sequence[Path] = (),
    extra: MachineCheck | None = None,
    previous: dict[str, IncrementalState] | None = None,
    *,
    everything: bool = False,
    cached: bool = False,
    processes: int = 1,
) -> Batch:
    """Check scripts by all rules and by `extra`: sub-scripts through their callers, or alone; and
    the machines in Python files, with `everything` by all rules. `cached`: what is known of Python
    files from the last run is used, and kept for the next one.

    Templates of the user are rendered, for their findings. `previous` are the results of the last
    analyses by path, which become those of these ones. `processes`: how many check the scripts; the
    results are the same.
    """
    checker = _Checker(
        disk=disk, scripts=scripts, templates=templates, extra=extra, previous=previous
    )
    analyses: dict[str, Analysis] = {}
    uses: dict[str, frozenset[str]] = {}
    alone: list[Path] = []
    python = _python_project(paths, disk, cached=cached)
    results: Mapping[Path, bytes] = {}
    for path in paths:
        if python is not None and path.suffix == PYTHON_SUFFIX:
            disk.searched.clear()
            file = python.read(path, everything=everything)
            analyses[str(path)] = Analysis(
                script=str(path), source=file.source, report=file.report, coverage=file.coverage
            )
            uses[str(path)] = disk.searched_files()
            continue
        checked = checker.taken(results.get(path)) or checker.script(path)
        if checked is None:
            alone.append(path)
            continue
        if processes > 1 and not analyses:  # the first script has loaded what all need
            left = [other for other in paths if other not in (path, *alone)
                    and (python is None or other.suffix != PYTHON_SUFFIX)]  # fmt: skip
            from smachac.driver.parallel import results_of

            results = results_of(checker.light, left, disk, processes)
        analyses[str(path)], uses[str(path)] = checked
    if python is not None:
        python.keep()
    called = frozenset().union(*uses.values())
    alone = [path for path in alone if os.path.realpath(path) not in called]
    for path in alone:
        analyses[str(path)], uses[str(path)] = checker.sub_script(path)
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
        again=checker.again,
    )


def _python_project(paths: Sequence[Path], disk: Disk, *, cached: bool) -> PythonProject | None:
    """The reader of Python files, if there is one among the paths: its modules are imported then
    alone."""
    if all(path.suffix != PYTHON_SUFFIX for path in paths):
        return None
    from smachac.driver.python_machines import PythonProject

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
    previous: IncrementalState | None = None,
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
    import json

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
        related = tuple(place for place in finding.related if place.span.source is not caller)
        yield replace(item, finding=replace(finding, related=related))
