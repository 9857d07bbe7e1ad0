"""Many scripts looked at together: what they share is read once, and told once."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from smachac.diagnostics.diagnostic import Report, identity, in_order
from smachac.diagnostics.source import Source, Word
from smachac.driver import CODES, Analysis, Judge, analyse, analyse_alone
from smachac.frontend.errors.suppressions import unused_allowances
from smachac.frontend.files import Disk, disk_library
from smachac.frontend.suppressions import Allowance
from smachac.frontend.yaml_tree import Seq


@dataclass(frozen=True, slots=True, kw_only=True)
class Survey:
    """What there is to say about scripts: reports by name, in the order given.

    A sub-script that one of the others calls has no report of its own. `uses`: by the same names,
    the real paths of all that a script was made of, or would have been had it been there.
    """

    reports: Mapping[str, Report]
    uses: Mapping[str, frozenset[str]]

    @property
    def report(self) -> Report:
        """All findings in order, each once, however many scripts it was met in."""
        return in_order(item for report in self.reports.values() for item in report)

    def only(self, kept: Report) -> Survey:
        """The same scripts with those findings alone that are like one of `kept`."""
        known = {identity(item) for item in kept}
        reports = {
            name: [item for item in report if identity(item) in known]
            for name, report in self.reports.items()
        }
        return replace(self, reports=reports)

    def touched_by(self, changed: set[str]) -> Survey:
        """The scripts that use one of these files."""
        names = [name for name, used in self.uses.items() if used & changed]
        return Survey(
            reports={name: self.reports[name] for name in names},
            uses={name: self.uses[name] for name in names},
        )


def survey(
    paths: Sequence[Path],
    disk: Disk,
    scripts: Sequence[Path] = (),
    templates: Sequence[Path] = (),
    more: Judge | None = None,
) -> Survey:
    """Judge scripts by every rule, and by `more`; sub-scripts through their callers, alone if they
    have none."""
    analyses: dict[str, Analysis] = {}
    uses: dict[str, frozenset[str]] = {}
    alone: list[Path] = []

    def judge(path: Path, source: Source | None, report: Report, *, called: bool) -> None:
        if source is None:
            analyses[str(path)] = Analysis(report=report)
        else:
            library = disk_library(
                path, report, scripts=scripts, templates=templates, disk=disk, codes=CODES
            )
            if called:
                analyses[str(path)] = analyse(source, library, report, more)
            else:
                analyses[str(path)] = analyse_alone(source, library, report)
        uses[str(path)] = frozenset(disk.asked)

    for path in paths:
        disk.asked.clear()
        report: Report = []
        source = disk.read(path, report)
        if source is not None and isinstance(disk.parse(source, []), Seq):
            alone.append(path)
        else:
            judge(path, source, report, called=True)
    called = frozenset().union(*uses.values())
    alone = [path for path in alone if os.path.realpath(path) not in called]
    for path in alone:
        disk.asked.clear()
        judge(path, disk.read(path, []), [], called=False)
    for path in alone:  # those that another one calls were judged twice
        others = (used for name, used in uses.items() if name != str(path))
        if any(os.path.realpath(path) in used for used in others):
            del uses[str(path)], analyses[str(path)]
    names = [str(path) for path in paths if str(path) in analyses]
    reports = {name: analyses[name].report for name in names}
    if len(names) > 1:
        _tell_unused(analyses, reports)
    return Survey(reports=reports, uses={name: uses[name] for name in names})


def _tell_unused(analyses: Mapping[str, Analysis], reports: dict[str, Report]) -> None:
    """SM021 for allowances of sub-scripts that no caller has a use for."""
    needed: set[Allowance] = set()
    for analysis in analyses.values():
        needed |= set(analysis.given) - set(analysis.unused)
    told = set(needed)
    for name in reports:
        new = [fit for fit in dict.fromkeys(analyses[name].unused) if fit not in told]
        told.update(new)
        words = (Word(fit.code, fit.span) for fit in new)
        reports[name] = [*reports[name], *unused_allowances(words)]
