"""Exit codes, and how commands print reports and errors of usage."""

from __future__ import annotations

import sys
from argparse import Namespace

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Any

    from smachac.diagnostics.clusters import Cluster
    from smachac.diagnostics.diagnostic import Report
    from smachac.targets import Target

OK, FINDINGS, USAGE = 0, 1, 2
"""Exit codes: success; findings or failure; wrong usage."""

MOST_NAMES = 20
"""The most known names that an error of usage lists."""


def without_notes(report: Report) -> Report:
    """The findings that reports for people show: errors and warnings."""
    from smachac.diagnostics.diagnostic import Severity

    return [item for item in report if item.severity is not Severity.INFO]


def print_report(
    report: Report, arguments: Namespace, stream: Any, clusters: Sequence[Cluster] = ()
) -> None:
    """Print findings; on a terminal in its width."""
    from smachac.commands.terminal import file_uri, terminal_width, wants_colour, wants_links
    from smachac.report.text import Layout, render_text

    if not report:
        return
    layout = Layout(colour=wants_colour(arguments, stream))
    if stream.isatty():
        layout = layout._replace(width=terminal_width(stream), wraps=True)
    if wants_links(stream):
        layout = layout._replace(link=file_uri)
    print(render_text(report, layout, clusters), file=stream)


def shown(path: object) -> str:
    """The name of a file on one line, without characters that control a terminal or a CI log."""
    from smachac.report.terminal import on_one_line

    return on_one_line(str(path))


def usage(message: str, word: str = "", known: Sequence[str] = ()) -> int:
    """Print an error of usage as argparse does, with the known name that is nearest to `word`, or
    the first ones; the exit code."""
    from smachac.diagnostics.diagnostic import did_you_mean
    from smachac.report.terminal import visible

    print(f"smachac: error: {visible(message)}", file=sys.stderr)
    if known:
        more = f", and {len(known) - MOST_NAMES} more" if len(known) > MOST_NAMES else ""
        names = ", ".join(known[:MOST_NAMES])
        print(did_you_mean(word, known) or f"known: {names}{more}", file=sys.stderr)
    return USAGE


def target_options(texts: Sequence[str], target: Target) -> dict[str, str] | int:
    """The options of a target, from the texts `NAME=VALUE` of the command line; the exit code after
    an error of usage."""
    options: dict[str, str] = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if not equals:
            return usage(f"--option needs NAME=VALUE, not `{text}`")
        if name not in target.options:
            message = f"target `{target.name}` has no option `{name}`"
            return usage(message, name, list(target.options))
        options[name] = value
    return options
