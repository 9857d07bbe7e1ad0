"""The commands that rewrite scripts: what they make of the texts is shown, or written."""

from __future__ import annotations

import os
import sys
from argparse import Namespace
from collections.abc import Mapping
from pathlib import Path

from smachac.commands.files import ChangedError, rewrite_files
from smachac.commands.output import FINDINGS, OK, print_report, usage
from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.frontend.discovery import NothingFoundError, scripts_of
from smachac.frontend.files import Disk
from smachac.refactor.autofix import Texts, differences
from smachac.refactor.formatter import format_script


def fmt(arguments: Namespace) -> int:
    """Lay out scripts; what is not YAML is reported and left alone."""
    disk = Disk()
    report: Report = []
    texts: dict[str, str] = {}
    sources: dict[str, Source] = {}
    left = 0
    try:
        paths = scripts_of(arguments.script or [Path()], disk)
    except NothingFoundError as error:
        return usage(str(error))
    for path in paths:
        found: Report = []
        source = disk.read(path, found)
        if source is None or disk.parse(source, found) is None:
            report += found
            left += bool(found)
            continue
        new = format_script(source, arguments.spelling)
        if new is None:
            print(f"{path} is left as it is: its YAML is too unusual", file=sys.stderr)
            left += 1
        elif new != source.text:
            name = os.path.realpath(path)
            texts[name], sources[name] = new, source
    print_report(report, arguments, sys.stderr)
    code = put(texts, sources, arguments, "laid out")
    return FINDINGS if left else code


def put(
    texts: Texts,
    sources: Mapping[str, Source],
    arguments: Namespace,
    done: str,
    new: frozenset[str] = frozenset(),
) -> int:
    """Write new texts, or show what would be written, as `--check` and `--diff` say. `new` are the
    paths of files that are not there yet."""
    verbs = {
        source.name: "made" if path in new else done
        for path, source in sorted(sources.items(), key=lambda each: each[1].name)
    }
    if arguments.diff:
        sys.stdout.writelines(differences(texts, sources))
        return FINDINGS if texts else OK
    if arguments.check:
        for name, verb in verbs.items():
            print(f"{name} would be {verb}")
        return FINDINGS if texts else OK
    try:
        rewrite_files(texts, {path: sources[path] for path in sources.keys() - new})
    except (OSError, ChangedError) as error:
        words = getattr(error, "strerror", None) or str(error)
        where = getattr(error, "filename", None)
        print(f"nothing was written: {f'{where}: ' if where else ''}{words}", file=sys.stderr)
        return FINDINGS
    for name, verb in verbs.items():
        print(f"{verb} {name}")
    return OK
