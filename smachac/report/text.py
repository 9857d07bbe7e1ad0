"""Text report: every finding with its source lines, for terminals.

Sections: findings, then snippets (source lines with marks).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import groupby
from operator import itemgetter
from typing import NamedTuple

from smachac.diagnostics.diagnostic import Diagnostic, Related, Report, Severity
from smachac.diagnostics.repair import Certainty
from smachac.diagnostics.source import NOWHERE, Source, Span
from smachac.records import replace
from smachac.report.repair_words import in_words
from smachac.report.terminal import Line, columns, lay_out, linked, on_one_line, visible, wrapped

TYPE_CHECKING = False  # annotations only: a correct script has no clusters
if TYPE_CHECKING:
    from smachac.diagnostics.clusters import Cluster

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
"""Limit on the findings in a text report; the other formats contain all."""

LEAST_ROOM = 20
"""Columns that a wrapped message has at least."""

MOST_STEPS = 16
"""Limit on the states of a printed path; the middle of longer ones is left out."""


class Layout(NamedTuple):
    """How findings are laid out.

    `width` is the width of the terminal in columns: it limits source lines and paths, with `wraps`
    messages too. `link` is the function from the name of a file to the URI that its places open.
    """

    colour: bool = False
    width: int = 100
    wraps: bool = False
    link: Callable[[str], str | None] = lambda name: None


PLAIN = Layout()


def render_text(report: Report, layout: Layout = PLAIN, clusters: Sequence[Cluster] = ()) -> str:
    """The findings, separated by empty lines; empty for no findings. At most MOST_FINDINGS are
    printed. An effect is printed once for each code. Findings that a cluster explains are a line
    each in the finding of the cluster. Texts of the user cannot control the terminal.
    """
    hidden = {id(item) for cluster in clusters for item in cluster.explained}
    roots = {id(cluster.finding): cluster for cluster in clusters}
    shown = [item for item in report if id(item) not in hidden]
    texts = [
        _rendered(with_cluster(item, roots.get(id(item))), effect, layout)
        for item, effect in zip(shown[:MOST_FINDINGS], effects(shown), strict=False)
    ]
    more = len(shown) - len(texts)
    if more:
        texts.append(f"... and {more:,} findings more: `--format json` has all\n")
    return "\n".join(texts)


MOST_EXPLAINED = 5
"""The most findings of a cluster that are listed; the others are counted."""


def with_cluster(item: Diagnostic, cluster: Cluster | None) -> Diagnostic:
    """A finding with the repair of its cluster as a help, and the explained findings as notes. Its
    own help is left out if it is a repair too: that one was tried, and corrects less."""
    if cluster is None:
        return item
    words = in_words(cluster.repair, item.span)
    own, repairs = item.help, item.finding.all_repairs
    # The help is about the first repair of the rule, if that is likely.
    named = [repair.edits for repair in repairs[:1] if repair.certainty is not Certainty.POSSIBLE]
    if own and (cluster.repair.edits in named or words in own):
        help = own
    elif own and not repairs:
        is_possible = cluster.repair.certainty is Certainty.POSSIBLE
        help = f"{own}\nor {words}" if is_possible else f"{words}\nor {own}"
    else:
        help = words
    edited = cluster.repair.edits[0].span
    notes = [
        Related(span=NOWHERE, message=f"this also corrects {other.span}: {other.message}")
        for other in cluster.explained[:MOST_EXPLAINED]
    ]
    more = len(cluster.explained) - len(notes)
    if more:
        notes.append(Related(span=NOWHERE, message=f"and {more} findings more"))
    if (edited.source, edited.line) != (item.span.source, item.span.line):
        notes.insert(0, Related(span=edited, message="the place of the change"))
    finding = replace(item.finding, help=help, related=(*item.related, *notes))
    return replace(item, finding=finding)


def effects(report: Report) -> Iterator[str]:
    """The effect of each finding; empty where an earlier finding of its code has the same."""
    seen: set[tuple[str, str]] = set()
    for item in report:
        effect = item.effect
        yield "" if (item.code, effect) in seen else effect
        seen.add((item.code, effect))


def summary(report: Report) -> str:
    """The number of findings: `2 errors, 1 warning in main.yml`."""
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
    where = on_one_line(names[0]) if len(names) == 1 else f"{len(names)} files"
    return f"{', '.join(counts)} in {where}"


def steps(path: tuple[str, ...]) -> list[str]:
    """A witness path as arrows and states; an outcome in parentheses is put on its arrow."""
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
    """The steps of a path as printed; the middle of a long path is left out."""
    parts = [on_one_line(part) for part in steps(path)]
    if len(parts) <= MOST_STEPS:
        return parts
    left_out = len(parts) - MOST_STEPS
    half = MOST_STEPS // 2
    return [*parts[:half], f" -> ... {left_out} more ...", *parts[-half:]]


def _rendered(item: Diagnostic, effect: str, layout: Layout) -> str:
    def paint(style: str, text: str) -> str:
        if not layout.colour or not text:
            return text
        kind = item.severity.value if style == "primary" else style
        return f"\x1b[{COLOURS[kind]}m{text}\x1b[0m"

    return "\n".join([*_lines(item, effect, layout, paint), ""])


def _lines(item: Diagnostic, effect: str, layout: Layout, paint: Paint) -> Iterator[str]:
    finding = item.finding
    head = f"{item.severity.value}[{item.code}]"
    first, *more = _labelled(head, on_one_line(finding.message), layout)
    yield paint("primary", head) + paint("strong", first)
    yield from (paint("strong", line) for line in more)
    places = [("", "primary", finding.span)]
    places += [(related.message, "related", related.span) for related in finding.related]
    marks = [
        mark(span.source, span.start, span.end, label, style)
        for label, style, span in places
        if not _nowhere(span)
    ]
    yield from _snippets(marks, layout, paint)
    notes = [label for label, style, span in places if _nowhere(span) and style == "related"]
    for note in (*notes, effect) if effect else notes:
        first, *more = _labelled("note", on_one_line(note), layout)
        yield paint("related", "note") + first
        yield from more
    if finding.path:
        yield from _path(finding.path_labels, layout.width, paint)
    if finding.help:
        for line in visible(finding.help).split("\n"):
            first, *more = _labelled("help", line, layout)
            yield paint("help", "help") + first
            yield from more


def _labelled(label: str, text: str, layout: Layout) -> list[str]:
    """The lines of a text after its label; those after the first are indented."""
    room = max(layout.width - len(label) - 2, LEAST_ROOM)
    first, *more = wrapped(text, room) if layout.wraps else [text]
    return [f": {first}", *(" " * (len(label) + 2) + line for line in more)]


def _nowhere(span: Span) -> bool:
    return span.source is NOWHERE.source


def _snippets(marks: list[Mark], layout: Layout, paint: Paint) -> Iterator[str]:
    if not marks:
        return
    digits = len(str(max(m.last_line for m in marks)))
    for index, group in enumerate(grouped(marks, layout.width)):
        first = group[0]
        arrow = "-->" if index == 0 and first.style == "primary" else ":::"
        if index:
            yield paint("gutter", " " * digits + " |")
        place = f"{on_one_line(first.source.name)}:{first.line}:{first.start + 1}"
        uri = layout.link(first.source.name)
        shown = linked(place, uri) if uri else place
        yield f"{' ' * digits}{paint('gutter', arrow)} {shown}"
        yield from snippet(group, digits, layout.width, paint)


def _path(path: tuple[str, ...], width: int, paint: Paint) -> Iterator[str]:
    """The line `path: A -(aborted)-> B`, broken before an arrow if it is too long."""
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


# --- snippets

Paint = Callable[[str, str], str]
"""Applies a style (first argument) to a text (second): "primary", "related" or "gutter"."""

NEAR = 8
"""Marks at most so many lines apart share a snippet."""

MOST_LINES = 6
"""Limit on the lines of a span; the middle of longer ones is left out."""


class Mark(NamedTuple):
    """A marked range of a source: lines counted from 1, characters in them from 0, end excluded."""

    source: Source
    line: int
    start: int
    last_line: int
    end: int
    label: str
    style: str

    @property
    def flat(self) -> bool:
        return self.line == self.last_line


def mark(source: Source, start: int, end: int, label: str, style: str) -> Mark:
    """The mark of a range of offsets, limited to the source and without trailing blanks."""
    size = len(source.text)
    start = min(max(start, 0), size)
    end = min(max(end, start), size)
    if "\n" in source.text[start:end]:
        end = start + len(source.text[start:end].rstrip())
    line, column = source.position(start)
    last_line, last_column = source.position(max(end - 1, start))
    first = source.line(line)
    last = first if last_line == line else source.line(last_line)
    start_index = min(column - 1, len(first))
    end_index = min(last_column, len(last)) if end > start else start_index
    return Mark(source, line, start_index, last_line, end_index, visible(label), style)


def grouped(marks: list[Mark], width: int) -> list[list[Mark]]:
    """Marks by snippet: marks of one source that are near one another share one."""
    groups: list[list[Mark]] = []
    for new in marks:
        for group in groups:
            if _belongs(new, group, width):
                group.append(new)
                break
        else:
            groups.append([new])
    return groups


def _belongs(new: Mark, group: list[Mark], width: int) -> bool:
    if new.source is not group[0].source or not new.flat or not all(old.flat for old in group):
        return False
    beside = [old for old in group if old.line == new.line]
    if beside:
        extent = max(m.end for m in (new, *beside)) - min(m.start for m in (new, *beside))
        return extent < width - 20
    return any(abs(new.line - old.line) <= NEAR for old in group)


def snippet(marks: list[Mark], digits: int, width: int, paint: Paint) -> Iterator[str]:
    """The printed lines of one snippet; line numbers take `digits` columns."""
    if not marks[0].source.text:
        return
    room = width - digits - 3
    empty = paint("gutter", " " * digits + " |")
    yield empty
    body = _flat(marks, room, paint) if marks[0].flat else _tall(marks[0], room - 2, paint)
    for number, text in body:
        if number is None:
            yield "..."
        elif number == 0:
            yield f"{empty} {text}".rstrip()
        else:
            yield f"{paint('gutter', f'{number:>{digits}} |')} {text}".rstrip()


Row = tuple["int | None", str]
"""A line of a snippet: its number (0: none, None: lines are left out) and its text."""


def _flat(marks: list[Mark], room: int, paint: Paint) -> Iterator[Row]:
    source = marks[0].source
    before = 0
    for number in sorted({m.line for m in marks}):
        text = source.line(number)
        if before and number - before == 2:
            yield before + 1, lay_out(source.line(before + 1), 0, 0, room).text
        elif before and number - before > 2:
            yield None, ""
        here = sorted((m for m in marks if m.line == number), key=lambda m: (m.start, m.end))
        line = lay_out(text, here[0].start, max(m.end for m in here), room)
        yield number, line.text
        for row in _beneath(here, line, room, paint):
            yield 0, row
        before = number


def _beneath(marks: list[Mark], line: Line, room: int, paint: Paint) -> Iterator[str]:
    """The rows under a line: carets, and one row for each label that does not fit beside them."""
    row: dict[int, tuple[str, str]] = {}
    for m in sorted(marks, key=lambda m: m.style == "primary"):
        sign = "^" if m.style == "primary" else "-"
        start = line.column(m.start)
        for column in range(start, max(line.column(m.end), start + 1)):
            row[column] = (m.style, sign)
    edge = max(row) + 1
    hanging = [m for m in marks if m.label]
    beside = ""
    if hanging and line.column(hanging[-1].start) == max(line.column(m.start) for m in marks):
        first = hanging[-1].label.split("\n")[0]
        if "\n" not in hanging[-1].label and edge + 1 + columns(first) <= room:
            beside = " " + paint(hanging.pop().style, first)
    yield _drawn(row, paint) + beside
    if hanging:
        yield _drawn({line.column(m.start): (m.style, "|") for m in hanging}, paint)
    while hanging:
        m = hanging.pop()
        column = line.column(m.start)
        bars = {line.column(left.start): (left.style, "|") for left in hanging}
        for text in m.label.split("\n"):
            kept = {at: bar for at, bar in bars.items() if at < column}
            yield _drawn(kept, paint, upto=column) + paint(m.style, text)


def _drawn(row: dict[int, tuple[str, str]], paint: Paint, upto: int = 0) -> str:
    """A row of signs at columns; runs of one style are painted together."""
    width = max([upto, *(at + 1 for at in row)])
    cells = (row.get(column, ("", " ")) for column in range(width))
    runs = ((style, "".join(map(_SIGN, run))) for style, run in groupby(cells, key=_STYLE))
    return "".join(paint(style, text) if style else text for style, text in runs)


_STYLE, _SIGN = itemgetter(0), itemgetter(1)


def _tall(m: Mark, room: int, paint: Paint) -> Iterator[Row]:
    """A span of several lines, with a bar at its left."""
    bar = paint(m.style, "|")
    sign = "^" if m.style == "primary" else "-"
    text = m.source.line(m.line)
    line = lay_out(text, m.start, m.start, room)
    if text[: m.start].strip():
        yield m.line, f"  {line.text}"
        yield 0, " " + paint(m.style, "_" * (line.column(m.start) + 1) + sign)
    else:
        yield m.line, f"{paint(m.style, '/')} {line.text}"
    shown = range(m.line + 1, m.last_line)
    cut = len(shown) + 2 > MOST_LINES
    for number in shown[: MOST_LINES - 3] if cut else shown:
        yield number, f"{bar} {lay_out(m.source.line(number), 0, 0, room).text}"
    if cut:
        yield None, ""
    line = lay_out(m.source.line(m.last_line), max(m.end - 1, 0), m.end, room)
    yield m.last_line, f"{bar} {line.text}"
    last = max(line.column(m.end) - 1, 0)
    label = f" {m.label}" if m.label else ""
    yield 0, paint(m.style, "|" + "_" * (last + 1) + sign + label.replace("\n", " "))
