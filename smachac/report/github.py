"""GitHub report: workflow commands of GitHub Actions, which annotate the line of each finding."""

from __future__ import annotations

from smachac.diagnostics.diagnostic import Diagnostic, Report, Severity
from smachac.diagnostics.source import NOWHERE
from smachac.report.terminal import on_one_line, visible
from smachac.report.text import steps

_COMMANDS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "notice"}


def render_github(report: Report) -> str:
    """One line for each finding, each with a line feed; empty for no findings.

    Line feeds in texts of the user are escaped, so that they cannot begin another command.
    """
    return "".join(f"{_command(item)}\n" for item in report)


def _command(item: Diagnostic) -> str:
    finding = item.finding
    properties: dict[str, object] = {}
    if finding.span.source is not NOWHERE.source:
        line, column = finding.span.source.position(finding.span.start)
        end_line, end_column = finding.span.source.position(finding.span.end)
        properties = {"file": on_one_line(finding.span.source.name), "line": line}
        properties["endLine"] = max(line, end_line)
        if line == end_line:  # GitHub refuses columns over several lines
            properties |= {"col": column, "endColumn": max(column, end_column)}
    properties["title"] = f"{item.code} {item.kind.name}"
    listed = ",".join(f"{name}={_property(str(value))}" for name, value in properties.items())
    return f"::{_COMMANDS[item.severity]} {listed}::{_data(_words(item))}"


def _words(item: Diagnostic) -> str:
    finding = item.finding
    lines = [finding.message]
    lines += [
        f"note: {related.message}"
        if related.span.source is NOWHERE.source
        else f"{related.span}: {related.message}"
        for related in finding.related
    ]
    if item.effect:
        lines.append(f"note: {item.effect}")
    if finding.path:
        lines.append(f"path: {''.join(steps(finding.path_labels))}")
    if finding.help:
        lines.append(f"help: {finding.help}")
    return visible("\n".join(lines))


def _data(text: str) -> str:
    """A message with the escapes of the runner (actions/toolkit, command.ts)."""
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
