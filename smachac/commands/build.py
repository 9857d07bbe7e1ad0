"""The command `build`: the files of a target, printed, written, or compared with those on disk."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from smachac.commands.output import FINDINGS, OK, print_report, shown, usage
from smachac.driver import analyse_file

if TYPE_CHECKING:
    from smachac.diagnostics.diagnostic import Report
    from smachac.driver import Analysis
    from smachac.frontend.loader import Library
    from smachac.targets import Target


def build(arguments: argparse.Namespace) -> int:
    from smachac.targets import BuildContext, OptionError, load_target, target_names

    target = load_target(arguments.target)
    if target is None:
        return usage(f"there is no target `{arguments.target}`", arguments.target, target_names())
    options: dict[str, str] = {}
    for text in arguments.option:
        name, equals, value = text.partition("=")
        if not equals:
            return usage(f"--option wants NAME=VALUE, not `{text}`")
        if name not in target.options:
            message = f"target `{target.name}` has no option `{name}`"
            return usage(message, name, list(target.options))
        options[name] = value
    try:
        analysis, library, files = generate(arguments, target, options)
    except OptionError as error:
        return usage(f"--option {error}")
    if files is None or analysis.checked is None or library is None:
        return FINDINGS
    context = BuildContext(library=library, options=options)
    return _put(files, target.runtime(analysis.checked, context), arguments)


def generate(
    arguments: argparse.Namespace, target: Target, options: dict[str, str]
) -> tuple[Analysis, Library | None, dict[str, str] | None]:
    """The files of a target; none, with a report on stderr, where the script has errors."""
    from smachac.diagnostics.diagnostic import has_errors
    from smachac.driver import build, together

    analysis, library = analyse_file(arguments.script, arguments.scripts, arguments.templates)
    files: dict[str, str] | None = None
    report = analysis.report
    if analysis.checked is not None and library is not None:
        found: Report = []
        files = build(analysis.checked, target, library, found, options)
        report = together(report, found)
        files = None if has_errors(found) else files
    print_report(shown(report), arguments, sys.stderr)
    return analysis, library, files


def _put(files: dict[str, str], runtime: Mapping[str, str], arguments: argparse.Namespace) -> int:
    from smachac.commands.files import changed_files, foreign_files, write_files
    from smachac.targets.runtime_files import runtime_files

    folder: Path = arguments.output
    if str(folder) == "-":
        sys.stdout.write(next(iter(files.values())))
        return OK
    files = {**files, **runtime_files(runtime)}
    if arguments.check:
        changed = changed_files(folder, files)
        for path in changed:
            print(f"{path} is not up to date: run `smachac build` again")
        return FINDINGS if changed else OK
    foreign = [] if arguments.force else foreign_files(folder, files)
    if foreign:
        for path in foreign:
            print(f"{path} was not written by smachac; --force overwrites it", file=sys.stderr)
        return FINDINGS
    try:
        for path in write_files(folder, files):
            print(f"wrote {path}")
    except OSError as error:
        print(f"cannot write to {folder}: {error.strerror or error}", file=sys.stderr)
        return FINDINGS
    return OK
