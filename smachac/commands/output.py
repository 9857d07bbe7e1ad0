"""Exit codes, and how commands print reports and errors of usage."""

from __future__ import annotations

import os
import sys
from argparse import Namespace

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Any

    from smachac.diagnostics.diagnostic import Report

OK, FINDINGS, USAGE = 0, 1, 2
"""Exit codes: success; findings or failure; wrong usage."""


def wants_colour(arguments: Namespace, stream: Any) -> bool:
    if arguments.colour != "auto":
        return bool(arguments.colour == "always")
    return bool(stream.isatty()) and "NO_COLOR" not in os.environ


def without_notes(report: Report) -> Report:
    """The findings that reports for people show: errors and warnings."""
    from smachac.diagnostics.diagnostic import Severity

    return [item for item in report if item.severity is not Severity.INFO]


def print_report(report: Report, arguments: Namespace, stream: Any) -> None:
    from smachac.report.text import render_text

    if report:
        print(render_text(report, colour=wants_colour(arguments, stream)), file=stream)


def shown(path: object) -> str:
    """The name of a file on one line, without characters that control a terminal or a CI log."""
    from smachac.report.terminal import on_one_line

    return on_one_line(str(path))


def usage(message: str, word: str = "", known: Sequence[str] = ()) -> int:
    """Print an error of usage as argparse does, with the known name that is nearest to `word`, or
    all of them; the exit code."""
    from smachac.diagnostics.diagnostic import did_you_mean
    from smachac.report.terminal import visible

    print(f"smachac: error: {visible(message)}", file=sys.stderr)
    if known:
        print(did_you_mean(word, known) or f"known: {', '.join(known)}", file=sys.stderr)
    return USAGE
