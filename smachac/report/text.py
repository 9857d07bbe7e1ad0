"""A report for people: every finding with the lines it speaks of."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.diagnostics import Diagnostic, Report, Severity
from smachac.report.cells import columns, visible
from smachac.report.snippet import Mark, Paint, grouped, mark, snippet
from smachac.source import NOWHERE, Span

COLOURS = {
    "error": "1;31",
    "warning": "1;33",
    "info": "1;36",
    "related": "34",
    "gutter": "1;34",
    "help": "1;32",
    "path": "1;35",
    "strong": "1",
}
"""SGR parameters (ECMA-48, 8.3.117) of each style."""

MOST_FINDINGS = 1000

MOST_STEPS = 16
"""Longer witness paths lose their middle."""


def render_text(report: Report, *, colour: bool = False, width: int = 100) -> str:
    """The findings one after the other, with an empty line between; empty for none. Of very many
    only the first: nobody reads more, and other formats have them all.

    `width` is that of the terminal in columns: it bounds lines of the source, not messages.
    Nothing in the texts of the user can steer the terminal.
    """
    texts = [_rendered(item, colour=colour, width=width) for item in report[:MOST_FINDINGS]]
    more = len(report) - len(texts)
    if more:
        texts.append(f"... and {more:,} findings more: `--format json` has all\n")
    return "\n".join(texts)


def summary(report: Report) -> str:
    """What a report amounts to: `2 errors, 1 warning in main.yml`."""
    if not report:
        return "no findings"
    words = {
        Severity.ERROR: ("error", "errors"),
        Severity.WARNING: ("warning", "warnings"),
        Severity.INFO: ("note", "notes"),
    }
    counts = [
        f"{count} {words[severity][count != 1]}"
        for severity in Severity
        if (count := sum(item.severity is severity for item in report))
    ]
    names = list(dict.fromkeys(i.span.source.name for i in report if not _nowhere(i.span)))
    if not names:
        return ", ".join(counts)
    where = visible(names[0]) if len(names) == 1 else f"{len(names)} files"
    return f"{', '.join(counts)} in {where}"


def steps(path: tuple[str, ...]) -> list[str]:
    """A witness path as arrows and states; an outcome in brackets stands on its arrow."""
    parts: list[str] = []
    arrow = ""
    for name in path:
        if name.startswith("(") and name.endswith(")") and parts:
            arrow = f" -{name}-> "
            continue
        parts.append((arrow or (" -> " if parts else "")) + name)
        arrow = ""
    return [*parts, arrow.rstrip()] if arrow else parts


def shortened(path: tuple[str, ...]) -> list[str]:
    """The steps of a path as they are printed; long ones lose their middle."""
    parts = [visible(part).replace("\n", "␊") for part in steps(path)]
    if len(parts) <= MOST_STEPS:
        return parts
    left_out = len(parts) - MOST_STEPS
    half = MOST_STEPS // 2
    return [*parts[:half], f" -> ... {left_out} more ...", *parts[-half:]]


def _rendered(item: Diagnostic, *, colour: bool, width: int) -> str:
    def paint(style: str, text: str) -> str:
        if not colour or not text:
            return text
        kind = item.severity.value if style == "primary" else style
        return f"\x1b[{COLOURS[kind]}m{text}\x1b[0m"

    return "\n".join([*_lines(item, width, paint), ""])


def _lines(item: Diagnostic, width: int, paint: Paint) -> Iterator[str]:
    finding = item.finding
    head = paint("primary", f"{item.severity.value}[{item.code.code}]")
    yield head + paint("strong", f": {visible(finding.message)}")
    places = [("", "primary", finding.span)]
    places += [(related.message, "related", related.span) for related in finding.related]
    marks = [
        mark(span.source, span.start, span.end, label, style)
        for label, style, span in places
        if not _nowhere(span)
    ]
    yield from _snippets(marks, width, paint)
    for label, style, span in places:
        if _nowhere(span) and style == "related":
            yield paint("related", "note") + f": {visible(label)}"
    if finding.path:
        yield from _path(finding.path, width, paint)
    if finding.help:
        for line in visible(finding.help).split("\n"):
            yield paint("help", "help") + f": {line}"


def _nowhere(span: Span) -> bool:
    return span.source is NOWHERE.source


def _snippets(marks: list[Mark], width: int, paint: Paint) -> Iterator[str]:
    if not marks:
        return
    digits = len(str(max(m.last_line for m in marks)))
    for index, group in enumerate(grouped(marks, width)):
        first = group[0]
        arrow = "-->" if index == 0 and first.style == "primary" else ":::"
        if index:
            yield paint("gutter", " " * digits + " |")
        place = f"{visible(first.source.name)}:{first.line}:{first.start + 1}"
        yield f"{' ' * digits}{paint('gutter', arrow)} {place}"
        yield from snippet(group, digits, width, paint)


def _path(path: tuple[str, ...], width: int, paint: Paint) -> Iterator[str]:
    """The line `path: A -(aborted)-> B`, broken before an arrow where it is too long."""
    parts = shortened(path)
    line = ""
    indent = "      "
    head = paint("path", "path") + ": "
    for part in parts:
        if line and columns(line + part) + len(indent) > width:
            yield head + line
            head, line = indent, part.lstrip()
        else:
            line += part
    yield head + line
