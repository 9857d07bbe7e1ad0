"""What the commands share in speaking to the user: reports, colours, words on wrong usage."""

from __future__ import annotations

import os
import sys
from argparse import Namespace
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from smachac.diagnostics.diagnostic import Report

OK, FINDINGS, USAGE = 0, 1, 2
"""Exit code of wrong usage."""


def wants_colour(arguments: Namespace, stream: Any) -> bool:
    if arguments.colour != "auto":
        return bool(arguments.colour == "always")
    return bool(stream.isatty()) and "NO_COLOR" not in os.environ


def shown(report: Report) -> Report:
    """What people are shown of a report: all but information."""
    from smachac.diagnostics.diagnostic import Severity

    return [item for item in report if item.severity is not Severity.INFO]


def print_report(report: Report, arguments: Namespace, stream: Any) -> None:
    from smachac.report.text import render_text

    if report:
        print(render_text(report, colour=wants_colour(arguments, stream)), file=stream)


def usage(message: str, word: str = "", known: list[str] | None = None) -> int:
    """Wrong usage, in the words of argparse, with what may have been meant; its exit code."""
    from smachac.diagnostics.diagnostic import did_you_mean

    print(f"smachac: error: {message}", file=sys.stderr)
    if known:
        print(did_you_mean(word, known) or f"known: {', '.join(known)}", file=sys.stderr)
    return USAGE
