"""The command `check`: find the errors in scripts; report, fix or record them; watch files."""

from __future__ import annotations

import argparse
import gc
import os
import sys
import time
from argparse import Namespace

from smachac.commands.arguments import (
    SCRIPTS,
    as_path,
    colour,
    memory_limit,
    quiet,
    report_output,
    search_folders,
    time_limit,
)
from smachac.commands.output import FINDINGS, OK, print_report, shown, usage, without_notes
from smachac.commands.python_files import is_python, python_finder
from smachac.commands.streams import print_failure

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from pathlib import Path
    from typing import Any, TextIO

    from smachac.diagnostics.baseline import Baseline
    from smachac.diagnostics.clusters import Cluster
    from smachac.diagnostics.diagnostic import Report
    from smachac.driver import IncrementalState, MachineCheck
    from smachac.driver.batch import Batch
    from smachac.frontend.files import Disk
    from smachac.pysource.machines.coverage import Coverage
    from smachac.refactor.autofix import FixResult

EXAMPLES = """\
examples:
  smachac check                                  all scripts below the current folder
  smachac check main.yml --format concise        one line for each finding
  smachac check . --format sarif -o smachac.sarif   a report for code scanning, in a file
  smachac check . --select SM3,SM4 --strict      only SM3xx and SM4xx; warnings fail too
  smachac check . --changed-since origin/main    scripts whose files a pull request changes
  smachac check . --baseline known.json --write-baseline   record the findings of old code
  smachac check . --baseline known.json          report new findings only
  smachac check . --fix --diff                   show what --fix would change, as a patch
  smachac check main.yml --sim                   check what the simulated arm can reach
  smachac check main.yml --watch                 check again after every change
  smachac check machine.py                       a machine in Python for SMACH, YASMIN or FlexBE
  smachac check src --python                     all scripts, and all Python files with machines

exit codes: 0 success, 1 findings that fail, 2 wrong usage, 70 a bug in smachac, 130 interrupted
"""

FORMATS = ("text", "concise", "json", "sarif", "github", "junit")

PAUSE = 0.3
"""Seconds between two reads of the times of watched files."""


def check_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EXAMPLES
    parser.add_argument("script", nargs="*", type=as_path, help=SCRIPTS)
    search_folders(parser)
    report_output(parser, *FORMATS)
    quiet(parser)
    parser.add_argument("--notes", action="store_true", help="show notes, not only their number")
    parser.add_argument("--strict", action="store_true", help="warnings fail, as errors do")
    for name, what in (("select", "report only these codes"), ("ignore", "ignore these codes")):
        parser.add_argument(f"--{name}", action="append", default=[], metavar="CODE[,CODE]",
                            help=f"{what}; SM2 stands for every SM2xx")  # fmt: skip
    parser.add_argument("--baseline", type=as_path, metavar="FILE",
                        help="ignore the findings that are listed in FILE")  # fmt: skip
    parser.add_argument("--write-baseline", action="store_true",
                        help="write all current findings to the file of --baseline")  # fmt: skip
    parser.add_argument("--changed-since", metavar="REV", help="check only scripts of which a file"
                        " changed since this git revision")  # fmt: skip
    parser.add_argument("--fix", action="store_true",
                        help="fix the findings that have one certain fix")  # fmt: skip
    parser.add_argument("--diff", action="store_true",
                        help="show what --fix would change, as a patch; write nothing")  # fmt: skip
    parser.add_argument("--sim", action="store_true",
                        help="also check what the simulated arm can reach")  # fmt: skip
    parser.add_argument("--python", action="store_true", help="in folders, also check Python files"
                        " that build machines for SMACH, YASMIN or FlexBE")  # fmt: skip
    parser.add_argument("--all", action="store_true", help="of Python files, report the findings of"
                        " all rules, not only what cannot work")  # fmt: skip
    parser.add_argument("--no-cache", action="store_true", help="read all Python files, also those"
                        " that did not change since the last run")  # fmt: skip
    parser.add_argument("--watch", action="store_true",
                        help="check again when a file changes, until Ctrl-C")  # fmt: skip
    memory_limit(parser)
    time_limit(parser)
    colour(parser)


def check_command(arguments: Namespace) -> int:
    """Check scripts once, or again and again; the exit code."""
    from pathlib import Path

    from smachac.commands.cpu_time import CpuTimeError, limited_time
    from smachac.commands.memory import limited_memory
    from smachac.driver import CODES
    from smachac.frontend.files import Disk

    arguments.script = arguments.script or [Path()]
    for code in (*_codes_of(arguments.select), *_codes_of(arguments.ignore)):
        if not any(known.startswith(code) for known in CODES):
            return usage(f"there is no code `{code}`", code, list(CODES))
    if arguments.write_baseline and arguments.baseline is None:
        return usage("--write-baseline needs --baseline FILE")
    if arguments.watch and arguments.report_file is not None:
        return usage("--watch prints a report after each change, --output writes one: choose one")
    try:
        with limited_memory(arguments.memory_limit):
            if arguments.watch:
                return _watch(arguments)
            with limited_time(arguments.time_limit):
                return _check_once(arguments, set(), Disk())
    except CpuTimeError as error:
        print(error, file=sys.stderr)
        return FINDINGS
    except _wrong_usage() as error:
        return usage(_usage_message(error, arguments))


def _usage_message(error: Exception, arguments: Namespace) -> str:
    """The message of an error of usage; it names `--python` where folders without scripts have
    machines in Python."""
    from smachac.driver.python_machines import files_with_machines
    from smachac.frontend.discovery import NothingFoundError
    from smachac.frontend.files import Disk

    if isinstance(error, NothingFoundError) and not arguments.python:
        folders = (path for path in arguments.script if path.is_dir())
        if any(files_with_machines(folder, Disk()) for folder in folders):
            return f"{error}; `--python` checks the Python files with state machines"
    return str(error)


def _wrong_usage() -> tuple[type[Exception], ...]:
    """The exceptions that mean wrong usage."""
    from smachac.checks.robot.workspace import NoSimulationError
    from smachac.commands.git import GitError
    from smachac.diagnostics.baseline import BaselineError
    from smachac.frontend.discovery import NothingFoundError

    return NothingFoundError, GitError, BaselineError, NoSimulationError


def _codes_of(words: list[str]) -> list[str]:
    """The codes, or beginnings of codes, of options with commas between them."""
    return [code.strip().upper() for word in words for code in word.split(",") if code.strip()]


def _check_once(
    arguments: Namespace,
    used: set[str],
    disk: Disk,
    previous: dict[str, IncrementalState] | None = None,
) -> int:
    """Check once; the exit code. The real paths of all files that were read go into `used`.
    `previous`: see `check_scripts`."""
    from smachac.diagnostics.diagnostic import Severity
    from smachac.frontend.discovery import scripts_of
    from smachac.frontend.files import Disk

    started = time.perf_counter()
    paths = scripts_of(arguments.script, disk, python_finder(arguments))
    whole = _check_paths(arguments, paths, disk, previous)
    used.update(*whole.uses.values())
    changed = _changed(arguments.changed_since, used)
    found, notes = _select(whole, changed, arguments)
    if arguments.write_baseline:
        return _write_baseline(arguments, found.report)
    fixes = 0
    if arguments.fix or arguments.diff:
        from smachac.refactor.autofix import apply_fixes

        fixed = apply_fixes(
            whole,
            lambda batch: _select(batch, changed, arguments)[0].report,
            lambda texts: _check_paths(arguments, paths, Disk(texts, refused=disk.refused)),
        )
        fixes = fixed.count
        if arguments.diff:
            _put_diff(fixed)
        elif not _write_fixes(fixed):
            return FINDINGS
        found, notes = _select(fixed.batch, changed, arguments)
        notes += [f"{fixes} fixed"] if fixes else []
        if any(map(is_python, paths)):
            notes.append("--fix does not edit Python files")
    elif any(item.finding.edits for item in found.report):
        from smachac.refactor.autofix import fixable

        number = len(fixable(whole, found.report))
        notes += [f"{number} fixable with --fix"] if number else []
    severe = {Severity.ERROR, Severity.WARNING} if arguments.strict else {Severity.ERROR}
    failing = {
        name: [item for item in report if item.severity in severe]
        for name, report in found.reports.items()
    }
    if sys.stdout.isatty():
        notes.append(f"{time.perf_counter() - started:.2f} s")
    if not arguments.notes and len(without_notes(found.report)) < len(found.report):
        notes.append("--notes shows notes")
    if not arguments.diff:
        clusters = _clusters(found, _simulation_rule(arguments), arguments)
        coverage = {
            name: analysis.coverage
            for name, analysis in whole.analyses.items()
            if name in found.reports and analysis.coverage is not None
        }
        _put(found, failing, clusters, coverage, notes, arguments)
    return FINDINGS if any(failing.values()) or (arguments.diff and fixes) else OK


def _check_paths(
    arguments: Namespace,
    paths: Sequence[Path],
    disk: Disk,
    previous: dict[str, IncrementalState] | None = None,
) -> Batch:
    """The check of some scripts with the options of the command."""
    from smachac.driver.batch import check_scripts, processes_for

    rule = _simulation_rule(arguments)
    alone = rule is not None or previous is not None or disk.texts
    return check_scripts(
        paths,
        disk,
        arguments.scripts,
        arguments.templates,
        rule,
        previous,
        everything=arguments.all,
        cached=not (arguments.no_cache or arguments.watch or arguments.changed_since),
        processes=1 if alone else processes_for(len(paths)),
    )


def _simulation_rule(arguments: Namespace) -> MachineCheck | None:
    """The rule that runs the simulation, if the command has `--sim`."""
    if not arguments.sim:
        return None
    from smachac.checks.robot.workspace import unreachable

    return unreachable


def _changed(revision: str | None, used: set[str]) -> set[str] | None:
    """The files that differ from a revision; None without one."""
    if not revision:
        return None
    from smachac.commands.git import changed_since

    return changed_since(revision, frozenset(used))


def _select(
    found: Batch, changed: set[str] | None, arguments: Namespace
) -> tuple[Batch, list[str]]:
    """The findings that the arguments select, and notes for the summary on the others."""
    from smachac.diagnostics.severities import select_findings

    if changed is not None:
        found = found.touched_by(changed)
    report = select_findings(found.report, _codes_of(arguments.select), _codes_of(arguments.ignore))
    notes = []
    if arguments.baseline is not None and not arguments.write_baseline:
        from smachac.diagnostics import baseline

        old = _read_baseline(arguments.baseline)
        report, known, gone = baseline.compare(report, old)
        notes += [f"{known} in the baseline"] if known else []
        notes += [f"{gone} of the baseline no longer found"] if gone else []
        if old.version < baseline.VERSION:
            notes += ["the baseline is of an older version: write it again with --write-baseline"]
    return found.only(report), notes


def _put_diff(fixed: FixResult) -> None:
    """Print the fixes as a patch, and their number to standard error."""
    from smachac.refactor.autofix import differences

    sys.stdout.writelines(differences(fixed.texts, fixed.sources))
    findings = "1 finding" if fixed.count == 1 else f"{fixed.count} findings"
    files = "1 file" if len(fixed.texts) == 1 else f"{len(fixed.texts)} files"
    print(f"--fix would fix {findings} in {files}", file=sys.stderr)


def _write_fixes(fixed: FixResult) -> bool:
    """Write the fixed texts; whether that succeeded."""
    from smachac.commands.files import ChangedError, not_written, rewrite_files
    from smachac.commands.writing import PartlyWrittenError

    try:
        rewrite_files(fixed.texts, fixed.sources)
    except (OSError, ChangedError, PartlyWrittenError) as error:
        print(not_written(error), file=sys.stderr)
        return False
    return True


def _clusters(found: Batch, extra: MachineCheck | None, arguments: Namespace) -> Sequence[Cluster]:
    """The clusters of the findings, for the formats that show them."""
    if not without_notes(found.report) or arguments.format not in ("text", "json"):
        return ()
    from smachac.repair.search import clusters_of

    return clusters_of(found, found.report, extra)


def _put(
    found: Batch,
    failing: dict[str, Report],
    clusters: Sequence[Cluster],
    coverage: Mapping[str, Coverage],
    notes: list[str],
    arguments: Namespace,
) -> None:
    """Print the findings in the requested format."""
    report = found.report
    listed = report if arguments.notes else without_notes(report)
    # A reader of several documents has a simple rule: each line is one.
    on_one_line = bool(arguments.watch)
    match arguments.format:
        case "json":
            from smachac.report.json import render_json

            data = _coverage_data(coverage)
            sys.stdout.write(render_json(report, clusters, data, on_one_line=on_one_line))
        case "sarif":
            from smachac.report.sarif import render_sarif

            sys.stdout.write(render_sarif(report, on_one_line=on_one_line))
        case "junit":
            from smachac.report.junit import render_junit

            mild = found.only(listed).reports
            sys.stdout.write(render_junit(mild, failing))
        case "github":
            from smachac.report.github import render_github

            sys.stdout.write(render_github(listed))
            _put_summary(found, coverage, notes, arguments)
        case "concise":
            from smachac.report.concise import render_concise

            sys.stdout.write(render_concise(listed))
            _put_summary(found, coverage, notes, arguments)
        case _:
            print_report(listed, arguments, sys.stdout, clusters)
            _put_summary(found, coverage, notes, arguments)


def _coverage_data(coverage: Mapping[str, Coverage]) -> list[dict[str, Any]]:
    if not coverage:
        return []
    from smachac.report.coverage import coverage_data

    return coverage_data(coverage)


def _put_summary(
    found: Batch, coverage: Mapping[str, Coverage], notes: list[str], arguments: Namespace
) -> None:
    """Print how much of the machines in Python files is known; then the numbers of findings and
    scripts, and the notes."""
    from smachac.report.text import summary

    if arguments.quiet:
        return
    if coverage:
        from smachac.report.coverage import coverage_lines

        for line in coverage_lines(coverage, every=arguments.notes):
            print(shown(line))
    words = summary(found.report)
    if len(found.reports) != 1:
        words += f"; {len(found.reports)} {'files' if coverage else 'scripts'} checked"
    print(f"{words} ({', '.join(notes)})" if notes else words)


def _write_baseline(arguments: Namespace, report: Report) -> int:
    """Write the findings to a baseline; the exit code. Only a baseline is overwritten."""
    from smachac.commands.files import write_files
    from smachac.commands.writing import PartlyWrittenError
    from smachac.diagnostics import baseline
    from smachac.frontend.files import read_source

    path: Path = arguments.baseline
    known = baseline.acceptable(report)
    if os.path.lexists(path):
        old = None if path.is_symlink() else read_source(path, [])
        if old is None or (old.text.strip() and not baseline.is_baseline(old.text)):
            return usage(f"--baseline {path} exists and is not a baseline: it was not overwritten")
    try:
        write_files(path.parent, {path.name: baseline.render(known)})
    except (OSError, PartlyWrittenError) as error:
        return usage(f"cannot write {path}: {getattr(error, 'strerror', None) or error}")
    words = f"wrote {shown(path)}: {len(known)} findings, which --baseline ignores from now on"
    if left := len(report) - len(known):
        errors = "1 error is" if left == 1 else f"{left} errors are"
        words += f"; {errors} not in it, because no program can be generated"
    print(words, file=_notices(arguments))
    return OK


def _notices(arguments: Namespace) -> TextIO:
    """The stream for lines that are not part of a report that programs read."""
    return sys.stdout if arguments.format in ("text", "concise") else sys.stderr


def _read_baseline(path: Path) -> Baseline:
    """The known findings of a baseline. Raises BaselineError."""
    from smachac.diagnostics import baseline
    from smachac.frontend.files import read_source

    problems: Report = []
    source = read_source(path, problems)
    if source is None:
        raise baseline.BaselineError(f"--baseline {path}: {problems[0].finding.message}")
    try:
        return baseline.read(source.text)
    except baseline.BaselineError as error:
        raise baseline.BaselineError(f"--baseline {path}: {error}") from error


def _watch(arguments: Namespace) -> int:
    """Check, and check again when a file changes, until Ctrl-C."""
    from smachac.frontend.files import Disk, stamps

    disk = Disk(in_pieces=True)  # files that did not change are read and parsed once
    previous: dict[str, IncrementalState] = {}
    known: set[str] = set()
    while True:
        before = stamps(_watched(arguments, known))
        used: set[str] = set()
        try:
            disk.refresh()
            _check_once(arguments, used, disk, previous)
        except _wrong_usage() as error:
            if not known:
                raise
            usage(str(error))  # a folder may be empty for some time
        known = used or known
        now = stamps(_watched(arguments, known))
        base = {**now, **{path: before[path] for path in now if path in before}}
        sys.stdout.flush()
        print(f"watching {len(base)} files; Ctrl-C ends", file=_notices(arguments), flush=True)
        if print_failure() is not None:
            return OK
        gc.collect()  # automatic collection is off
        while stamps(_watched(arguments, known)) == base:
            time.sleep(PAUSE)
        print(file=_notices(arguments))


def _watched(arguments: Namespace, used: Iterable[str]) -> list[str]:
    """The paths of the files to watch: the scripts of the arguments, and the files read so far."""
    from smachac.frontend.discovery import yaml_files

    named = [str(path) for path in arguments.script if not os.path.isdir(path)]  # noqa: PTH112
    inside = {*map(str, yaml_files(arguments.script))}
    if arguments.python:
        from smachac.driver.python_machines import python_files

        inside.update(str(path) for folder in arguments.script for path in python_files(folder))
    return sorted({*named, *inside, *used})
