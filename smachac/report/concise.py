"""Concise report: one line for each finding, in the form of compilers, which editors read."""

from __future__ import annotations

from smachac.diagnostics.diagnostic import Diagnostic, Report
from smachac.diagnostics.source import NOWHERE
from smachac.report.terminal import on_one_line


def render_concise(report: Report) -> str:
    """`FILE:LINE:COLUMN: SEVERITY: MESSAGE [CODE]` for each finding, each with a line feed; empty
    for no findings. A finding without a place has no file."""
    return "".join(f"{on_one_line(_line(item))}\n" for item in report)


def _line(item: Diagnostic) -> str:
    finding = item.finding
    place = "" if finding.span.source is NOWHERE.source else f"{finding.span}: "
    return f"{place}{item.severity.value}: {finding.message} [{item.code}]"
