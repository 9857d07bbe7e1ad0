"""The command `fmt`: format scripts; comments stay."""

from __future__ import annotations

import argparse
import os
import sys
from argparse import Namespace

from smachac.commands.arguments import SCRIPTS, as_path, colour, dry_run, quiet
from smachac.commands.output import FINDINGS, print_report, shown, usage

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from smachac.diagnostics.diagnostic import Report
    from smachac.diagnostics.source import Source

EXAMPLES = """\
examples:
  smachac fmt                        format all scripts below the current folder
  smachac fmt main.yml --diff        show the changes as a patch
  smachac fmt --check                fail if a script is not formatted (CI)
  smachac fmt main.yml --shorthand   T, o, t, [[x]] instead of template, outcomes, transitions, ...

exit codes: 0 success, 1 a file would change (--check, --diff), cannot be read or written,
2 wrong usage, 70 a bug in smachac
"""


def fmt_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EXAMPLES
    parser.add_argument("script", nargs="*", type=as_path, help=SCRIPTS)
    dry_run(parser)
    quiet(parser)
    spelling = parser.add_mutually_exclusive_group()
    for name in ("short", "long"):
        spelling.add_argument(f"--{name}hand", dest="spelling", action="store_const", const=name,
                              default="kept", help=f"use {name} names of variables")  # fmt: skip
    colour(parser)


def fmt_command(arguments: Namespace) -> int:
    """Format scripts; the exit code. A file that is not YAML is reported and left unchanged."""
    from pathlib import Path

    from smachac.commands.files import put_changes
    from smachac.frontend.discovery import NothingFoundError, scripts_of
    from smachac.frontend.files import Disk
    from smachac.refactor.formatter import format_script

    disk = Disk()
    report: Report = []
    texts: dict[str, str] = {}
    sources: dict[str, Source] = {}
    failed = 0
    try:
        paths = scripts_of(arguments.script or [Path()], disk)
    except NothingFoundError as error:
        return usage(str(error))
    for path in paths:
        found: Report = []
        source = disk.read(path, found)
        tree = disk.parse(source, found) if source is not None else None
        broken = [item for item in found if item.code == "SM001"]
        if source is None or tree is None or broken:
            report += broken or found
            failed += bool(found)
            continue
        new = format_script(source, arguments.spelling)
        if new is None:
            print(
                f"{shown(path)} was not changed: `fmt` does not support its YAML", file=sys.stderr
            )
            failed += 1
        elif new != source.text:
            name = os.path.realpath(path)
            texts[name], sources[name] = new, source
    print_report(report, arguments, sys.stderr)
    code = put_changes(texts, sources, arguments, "formatted")
    return FINDINGS if failed else code
