"""The command `check`: which scripts, what counts, in which form, once or again and again."""

from __future__ import annotations

import gc
import sys
import time
from argparse import Namespace
from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from smachac.batch import Survey, survey
from smachac.checks.workspace import NoSimulationError, unreachable
from smachac.commands.files import ChangedError, rewrite_files, write_files
from smachac.commands.output import FINDINGS, OK, print_report, shown, usage
from smachac.diagnostics import baseline
from smachac.diagnostics.diagnostic import Report, Severity
from smachac.diagnostics.severities import select_findings
from smachac.driver import CODES
from smachac.frontend.discovery import (
    GitError,
    NothingFoundError,
    changed_since,
    scripts_of,
    yaml_files,
)
from smachac.frontend.files import Disk, read_source, stamps

if TYPE_CHECKING:
    from smachac.refactor.autofix import FixResult

WRONG_USAGE = (NothingFoundError, GitError, baseline.BaselineError, NoSimulationError)

PAUSE = 0.3
"""Seconds between two looks at the files that are watched."""


def check(arguments: Namespace) -> int:
    """Judge scripts as the arguments say; the exit code."""
    arguments.script = arguments.script or [Path()]
    for code in (*_codes(arguments.select), *_codes(arguments.ignore)):
        if not any(known.startswith(code) for known in CODES):
            return usage(f"there is no code `{code}`", code, list(CODES))
    if arguments.write_baseline and arguments.baseline is None:
        return usage("--write-baseline wants --baseline FILE")
    try:
        return _watch(arguments) if arguments.watch else _once(arguments, set())
    except WRONG_USAGE as error:
        return usage(str(error))


def _codes(words: list[str]) -> list[str]:
    """Codes, or beginnings of codes, from options that may hold several."""
    return [code.strip().upper() for word in words for code in word.split(",") if code.strip()]


def _once(arguments: Namespace, used: set[str]) -> int:
    """One round; the exit code. What the scripts are made of comes into `used`."""
    started = time.perf_counter()
    disk = Disk()
    paths = scripts_of(arguments.script, disk)
    more = unreachable if arguments.sim else None
    whole = survey(paths, disk, arguments.scripts, arguments.templates, more)
    used.update(*whole.uses.values())
    changed = changed_since(arguments.changed_since) if arguments.changed_since else None
    found, notes = _counted(whole, changed, arguments)
    if arguments.write_baseline:
        return _write_baseline(arguments.baseline, found.report)
    mends = 0
    if arguments.fix or arguments.diff:
        from smachac.refactor.autofix import Texts, apply_fixes

        def again(texts: Texts) -> Survey:
            return survey(paths, Disk(texts), arguments.scripts, arguments.templates, more)

        def counted(survey: Survey) -> Report:
            return _counted(survey, changed, arguments)[0].report

        cured = apply_fixes(whole, counted, again)
        mends = cured.count
        if arguments.diff:
            _put_diff(cured)
        elif not _rewritten(cured):
            return FINDINGS
        found, notes = _counted(cured.survey, changed, arguments)
        notes += [f"{mends} mended"] if mends else []
    elif cures := sum(bool(item.finding.edits) for item in found.report):
        notes.append(f"{cures} with a cure: --fix")
    grave = {Severity.ERROR, Severity.WARNING} if arguments.strict else {Severity.ERROR}
    failing = {
        name: [item for item in each if item.severity in grave]
        for name, each in found.reports.items()
    }
    if sys.stdout.isatty():
        notes.append(f"{time.perf_counter() - started:.2f} s")
    if not arguments.diff:
        _put(found, failing, notes, arguments)
    return FINDINGS if any(failing.values()) or (arguments.diff and mends) else OK


def _counted(
    found: Survey, changed: set[str] | None, arguments: Namespace
) -> tuple[Survey, list[str]]:
    """What of a survey counts by the arguments, and notes on what does not."""
    if changed is not None:
        found = found.touched_by(changed)
    report = select_findings(found.report, _codes(arguments.select), _codes(arguments.ignore))
    notes = []
    if arguments.baseline is not None and not arguments.write_baseline:
        report, known, gone = baseline.compare(report, _read_baseline(arguments.baseline))
        notes += [f"{known} known"] if known else []
        notes += [f"{gone} of the baseline gone"] if gone else []
    return found.only(report), notes


def _put_diff(cured: FixResult) -> None:
    from smachac.refactor.autofix import differences

    sys.stdout.writelines(differences(cured.texts, cured.sources))
    print(f"--fix would mend {cured.count} findings in {len(cured.texts)} files", file=sys.stderr)


def _rewritten(cured: FixResult) -> bool:
    """Write what was mended; whether that went well."""
    try:
        rewrite_files(cured.texts, cured.sources)
    except (OSError, ChangedError) as error:
        words = getattr(error, "strerror", None) or str(error)
        print(f"nothing was mended: {words}", file=sys.stderr)
        return False
    return True


def _put(found: Survey, failing: dict[str, Report], notes: list[str], arguments: Namespace) -> None:
    """Print what was found, in the form that is asked for."""
    report = found.report
    match arguments.format:
        case "json":
            from smachac.report.json import render_json

            sys.stdout.write(render_json(report))
        case "sarif":
            from smachac.report.sarif import render_sarif

            sys.stdout.write(render_sarif(report))
        case "junit":
            from smachac.report.junit import render_junit

            mild = {name: shown(each) for name, each in found.reports.items()}
            sys.stdout.write(render_junit(mild, failing))
        case "github":
            from smachac.report.github import render_github

            sys.stdout.write(render_github(shown(report)))
            print(_summary(report, len(found.reports), notes))
        case _:
            print_report(shown(report), arguments, sys.stdout)
            print(_summary(report, len(found.reports), notes))


def _summary(report: Report, scripts: int, notes: list[str]) -> str:
    from smachac.report.text import summary

    words = summary(report)
    if scripts != 1:
        words += f"; {scripts} scripts checked"
    return f"{words} ({', '.join(notes)})" if notes else words


def _write_baseline(path: Path, report: Report) -> int:
    try:
        write_files(path.parent, {path.name: baseline.render(report)})
    except OSError as error:
        return usage(f"cannot write {path}: {error.strerror or error}")
    print(f"wrote {path}: {len(report)} findings are known from now on")
    return OK


def _read_baseline(path: Path) -> Counter[str]:
    problems: Report = []
    source = read_source(path, problems)
    if source is None:
        raise baseline.BaselineError(f"--baseline {path}: {problems[0].finding.message}")
    try:
        return baseline.read(source.text)
    except baseline.BaselineError as error:
        raise baseline.BaselineError(f"--baseline {path}: {error}") from error


def _watch(arguments: Namespace) -> int:
    """Check, and check again whenever a file changes, until Ctrl-C."""
    known: set[str] = set()
    while True:
        before = stamps(_watched(arguments, known))
        used: set[str] = set()
        try:
            _once(arguments, used)
        except WRONG_USAGE as error:
            if not known:
                raise
            usage(str(error))  # a folder may be empty for a while
        known = used or known
        now = stamps(_watched(arguments, known))
        base = {**now, **{path: before[path] for path in now if path in before}}
        print(f"watching {len(base)} files; Ctrl-C ends", flush=True)
        gc.collect()  # it is off while we work
        while stamps(_watched(arguments, known)) == base:
            time.sleep(PAUSE)
        print()


def _watched(arguments: Namespace, used: Iterable[str]) -> list[str]:
    named = [str(path) for path in arguments.script if not path.is_dir()]
    inside = map(str, yaml_files(arguments.script))
    return sorted({*named, *inside, *used})
