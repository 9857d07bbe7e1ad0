"""A comparison as text, as Markdown for a pull request, and as JSON."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import Any

from smachac.diagnostics.diagnostic import Diagnostic, Report
from smachac.diff.comparison import Change, Comparison
from smachac.report.json import diagnostic_data, json_text
from smachac.report.markdown import cell, table
from smachac.report.terminal import on_one_line

VERSION = 2
"""The version of the form of the JSON; it increases with every change."""

SIGNS = {"added": "+", "removed": "-", "changed": "~", "renamed": "~", "moved": "~"}

_ORDER = ("added", "removed", "renamed", "moved", "changed")


def summary(comparison: Comparison) -> str:
    """The numbers of differences, in words."""
    if comparison.equal:
        return "no difference"
    if comparison.unread:
        return "not compared, because it cannot be read"
    if not comparison.was or not comparison.name:
        return "new script" if comparison.name else "removed script"
    counts = Counter((_noun(change), change.kind) for change in comparison.changes)
    nouns = dict.fromkeys(["state", "transition", *(noun for noun, _ in counts)])
    parts = [
        f"{count} {noun}{'s' * (count != 1)} {kind}"
        for noun in nouns
        for kind in _ORDER
        if (count := counts[noun, kind])  # type: ignore[index]
    ]
    for word, report in (("new", comparison.added), ("fixed", comparison.removed)):
        if report:
            parts.append(f"{len(report)} {word} finding{'s' * (len(report) != 1)}")
    return ", ".join(parts)


def _noun(change: Change) -> str:
    match change.what:
        case "input" | "output" | "userdata":
            return "key"
        case "field" | "param" | "variable":
            return "value"
    return change.what


SAME_BEHAVIOUR = (
    "same behaviour: every run goes through the same states, whatever their names and nesting"
)
"""The line of a comparison of machines that are proved to behave alike."""


def title(comparison: Comparison) -> str:
    """The name of the script, and its name before, where that is another."""
    names = dict.fromkeys(filter(None, [comparison.was, comparison.name]))
    return " -> ".join(names)


def render_text(found: Sequence[Comparison]) -> str:
    """The differences of scripts, one paragraph for each; those without any are left out."""
    parts = [
        "\n".join(map(on_one_line, _lines(comparison)))
        for comparison in found
        if not comparison.equal
    ]
    return "\n\n".join(parts) + "\n" if parts else ""


def _lines(comparison: Comparison) -> Iterator[str]:
    yield f"{title(comparison)}: {summary(comparison)}"
    if comparison.alike is not None and comparison.changes:
        yield f"  {SAME_BEHAVIOUR}"
    for path, changes in groupby(comparison.changes, lambda change: change.path):
        inside = list(changes)
        if inside[0].what == "state":
            yield f"  {_state_line(inside.pop(0))}"
        else:
            yield f"  ~ state {path}"
        yield from (f"      {_fact_line(change)}" for change in inside)
    for sign, report in (("+", comparison.added), ("-", comparison.removed)):
        yield from (f"  {sign} {_finding(diagnostic)}" for diagnostic in report)


def _state_line(change: Change) -> str:
    head = f"{SIGNS[change.kind]} state {change.path}"
    match change.kind:
        case "renamed" | "moved":
            return f"{head}: {change.kind} from {change.was}"
    text = change.after or change.before
    return f"{head}: {text}" if text else head


def _fact_line(change: Change) -> str:
    head = f"{SIGNS[change.kind]} {_fact(change)}"
    values = change.after or change.before
    if change.kind == "changed":
        values = f"{change.before or 'nothing'} -> {change.after or 'nothing'}"
    return f"{head}: {values}" if values else head


def change_text(change: Change) -> str:
    """A change on one line."""
    line = _state_line(change) if change.what == "state" else _fact_line(change)
    return on_one_line(line)


def _finding(item: Diagnostic) -> str:
    return f"{item.severity.value}[{item.code}] {item.message} ({item.span})"


def render_markdown(found: Sequence[Comparison]) -> str:
    """The differences as Markdown, for a comment on a pull request."""
    parts = [
        "\n".join([*_markdown(comparison), ""]) for comparison in found if not comparison.equal
    ]
    return "\n".join(parts) if parts else "No difference in the state machines.\n"


def _markdown(comparison: Comparison) -> Iterator[str]:
    yield f"### {cell(title(comparison))}"
    yield ""
    yield f"{summary(comparison)[0].upper()}{summary(comparison)[1:]}."
    if comparison.alike is not None and comparison.changes:
        yield ""
        yield f"{SAME_BEHAVIOUR[0].upper()}{SAME_BEHAVIOUR[1:]}."
    if comparison.changes:
        yield ""
        yield from table(("", "state", "what", "before", "after"), map(_row, comparison.changes))
    for heading, report in (("New", comparison.added), ("Fixed", comparison.removed)):
        if report:
            yield ""
            rows = (
                (
                    diagnostic.severity.value,
                    diagnostic.code,
                    str(diagnostic.span),
                    diagnostic.message,
                )
                for diagnostic in report
            )
            yield from table((f"{heading} findings", "code", "place", "message"), rows)


def _row(change: Change) -> tuple[str, ...]:
    return change.kind, change.path, _fact(change), change.before, change.after


def _fact(change: Change) -> str:
    """What a change is about: the name of a field, or the kind and the name of another fact."""
    if change.what == "field":
        return change.name
    return f"{change.what} {change.name}".rstrip()


def render_json(found: Sequence[Comparison]) -> str:
    """The differences of all scripts as JSON, also of those without any."""
    return json_text({"version": VERSION, "scripts": [_data(comparison) for comparison in found]})


def _data(comparison: Comparison) -> dict[str, Any]:
    return {
        "before": comparison.was or None,
        "after": comparison.name or None,
        "equal": comparison.equal,
        "same_behaviour": comparison.equal or comparison.alike is not None,
        "readable": not comparison.unread,
        "changes": [_change_data(change) for change in comparison.changes],
        "findings": {
            "added": _findings_data(comparison.added),
            "removed": _findings_data(comparison.removed),
            "same": comparison.same,
        },
    }


def _change_data(change: Change) -> dict[str, str]:
    return {
        "change": change.kind,
        "what": change.what,
        "path": change.path,
        "was": change.was or change.path,
        "name": change.name,
        "before": change.before,
        "after": change.after,
        "place": change.place,
    }


def _findings_data(report: Report) -> list[dict[str, Any]]:
    return [diagnostic_data(diagnostic) for diagnostic in report]
