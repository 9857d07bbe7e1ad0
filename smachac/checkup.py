"""The command `check`: which scripts, what counts, in which form, once or again and again."""

from __future__ import annotations

import gc
import sys
import time
from argparse import Namespace
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from smachac import baseline, checks
from smachac.diagnostics import CODES, Report, Severity
from smachac.discover import GitError, NothingFoundError, changed_since, scripts_of, yaml_files
from smachac.files import Disk, read_source, stamps, write_files
from smachac.policy import chosen
from smachac.streams import print_report, shown, usage
from smachac.survey import Survey, survey

assert checks is not None  # imported for the codes it files

OK, FINDINGS = 0, 1

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
    return _watch(arguments) if arguments.watch else _once(arguments, set())


def _codes(words: list[str]) -> list[str]:
    """Codes, or beginnings of codes, from options that may hold several."""
    return [code.strip().upper() for word in words for code in word.split(",") if code.strip()]


def _once(arguments: Namespace, used: set[str]) -> int:
    """One round; the exit code. What the scripts are made of comes into `used`."""
    started = time.perf_counter()
    try:
        disk = Disk()
        paths = scripts_of(arguments.script, disk)
        found = survey(paths, disk, arguments.scripts, arguments.templates)
        used.update(*found.uses.values())
        if arguments.changed_since is not None:
            found = found.touched_by(changed_since(arguments.changed_since))
    except (NothingFoundError, GitError) as error:
        return usage(str(error))
    report = chosen(found.report, _codes(arguments.select), _codes(arguments.ignore))
    if arguments.write_baseline:
        return _write_baseline(arguments.baseline, report)
    notes = []
    if arguments.baseline is not None:
        known = _read_baseline(arguments.baseline)
        if isinstance(known, str):
            return usage(f"--baseline {arguments.baseline}: {known}")
        before = len(report)
        report, gone = baseline.compared(report, known)
        notes += [f"{before - len(report)} known"] if before > len(report) else []
        notes += [f"{gone} of the baseline gone"] if gone else []
    found = found.only(report)
    grave = {Severity.ERROR, Severity.WARNING} if arguments.strict else {Severity.ERROR}
    failing = {
        name: [item for item in each if item.severity in grave]
        for name, each in found.reports.items()
    }
    if sys.stdout.isatty():
        notes.append(f"{time.perf_counter() - started:.2f} s")
    _put(found, failing, notes, arguments)
    return FINDINGS if any(failing.values()) else OK


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
        write_files(path.parent, {path.name: baseline.written(report)})
    except OSError as error:
        return usage(f"cannot write {path}: {error.strerror or error}")
    print(f"wrote {path}: {len(report)} findings are known from now on")
    return OK


def _read_baseline(path: Path) -> Counter[str] | str:
    """What a baseline knows, or what is wrong with it."""
    problems: Report = []
    source = read_source(path, problems)
    if source is None:
        return problems[0].finding.message
    try:
        return baseline.read(source.text)
    except baseline.BaselineError as error:
        return str(error)


def _watch(arguments: Namespace) -> int:
    """Check, and check again whenever a file changes, until Ctrl-C."""
    known: set[str] = set()
    while True:
        before = stamps(_watched(arguments, known))
        used: set[str] = set()
        code = _once(arguments, used)
        if code not in (OK, FINDINGS):
            return code
        known = used
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
