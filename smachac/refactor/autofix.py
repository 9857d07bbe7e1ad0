"""Automatic fixes: the edits of findings, applied in memory and kept if they fix their finding and
add no error."""

from __future__ import annotations

import difflib
import os
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path

from smachac.diagnostics.diagnostic import Diagnostic, Report, Severity, fingerprint, identity
from smachac.diagnostics.repair import Edit
from smachac.diagnostics.source import Source
from smachac.driver.batch import Batch
from smachac.frontend.files import BUILT_IN
from smachac.records import dataclass

Texts = Mapping[str, str]
"""Changed texts by the real path of their file."""


UNCLEAR = frozenset(["SM001", "SM002", "SM106"])
"""The codes of scripts that may mean something else: syntax errors, equal entries or states."""

MAX_ROUNDS = 10
"""Rounds of analysis and edits: a fix can uncover findings with further edits."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FixResult:
    """The result of fixes: the number of fixed findings, the new texts, the original sources by
    real path, and the findings that remain."""

    count: int
    texts: Texts
    sources: Mapping[str, Source]
    batch: Batch


def apply_fixes(
    before: Batch, selected: Callable[[Batch], Report], reanalyse: Callable[[Texts], Batch]
) -> FixResult:
    """Apply the edits of the selected findings, and keep those that pass a new analysis.

    `reanalyse` analyses the same scripts with changed texts. If a batch of edits fails it is
    bisected: afterwards each fixed finding is gone, and there is no new error. Only the spans of
    the edits change; the layout of the rest stays.
    """
    count = 0
    current = before
    texts: dict[str, str] = {}
    sources: dict[str, Source] = {}
    for _ in range(MAX_ROUNDS):
        found = fixable(current, selected(current))
        kept, after = _fix_round(current, found, lambda new: reanalyse({**texts, **new}))
        if not kept:
            break
        for path, (source, text) in _apply_edits(kept).items():
            texts[path] = text
            sources.setdefault(path, source)
        count += len(kept)
        current = after
    return FixResult(count=count, texts=texts, sources=sources, batch=current)


def _fix_round(
    before: Batch, report: Report, reanalyse: Callable[[Texts], Batch]
) -> tuple[list[Diagnostic], Batch]:
    """The findings that their edits fix, of those with edits, and the analysis after the edits."""
    kept: list[Diagnostic] = []
    current = before

    def bisect(batch: Sequence[Diagnostic]) -> None:
        nonlocal current
        if not batch:
            return
        tried = [*kept, *batch]
        after = reanalyse({path: text for path, (_, text) in _apply_edits(tried).items()})
        if _is_improvement(before, after, tried):
            kept.extend(batch)
            current = after
        elif len(batch) > 1:
            bisect(batch[: len(batch) // 2])
            bisect(batch[len(batch) // 2 :])

    bisect(report)
    return kept, current


def fixable(batch: Batch, report: Report) -> Report:
    """The findings of a report with edits that can be applied.

    Overlapping edits are left out unless they are equal; so are edits of files that come with
    smachac, and all edits of scripts that are not read as they were meant: with a syntax error, or
    with two entries or two states of one name.
    """
    unclear = {
        identity(item)
        for report in batch.reports.values()
        if any(item.code in UNCLEAR for item in report)
        for item in report
    }
    rest = [item for item in report if item.finding.edits and identity(item) not in unclear]
    return _compatible(rest)


def _path(edit: Edit) -> str:
    return os.path.realpath(edit.span.source.name)


def _compatible(report: Report) -> Report:
    """The findings whose edits do not overlap edits of another finding, unless both are equal.

    Of several insertions at one place the first is kept; the next round handles the others.
    """
    ours = tuple(os.path.realpath(folder) + os.sep for folder in BUILT_IN)
    taken: dict[str, list[tuple[int, int, int, str]]] = {}
    out: set[int] = set()
    for number, item in enumerate(report):
        for edit in item.finding.edits:
            if _path(edit).startswith(ours):
                out.add(number)
            row = (edit.span.start, edit.span.end, number, edit.text)
            taken.setdefault(_path(edit), []).append(row)
    for rows in taken.values():
        furthest = (-1, -1, -1, "")
        for row in sorted(rows):
            start, end, number, text = row
            if (start, end, text) == (*furthest[:2], furthest[3]):
                continue
            if start == end == furthest[0] == furthest[1]:
                out.add(number)
                continue
            if start < furthest[1] or start == furthest[0]:
                out |= {number, furthest[2]}
            furthest = max(furthest, row, key=lambda row: row[1])
    return [item for number, item in enumerate(report) if number not in out]


def _apply_edits(report: Sequence[Diagnostic]) -> dict[str, tuple[Source, str]]:
    """The texts after the edits of some findings, with their sources, by real path."""
    edits: dict[str, dict[tuple[int, int], Edit]] = {}
    for item in report:
        for edit in item.finding.edits:
            edits.setdefault(_path(edit), {})[edit.span.start, edit.span.end] = edit
    found = {}
    for path, places in edits.items():
        source = next(iter(places.values())).span.source
        parts, at = [], 0
        for start, end in sorted(places):
            parts += [source.text[at:start], places[start, end].text]
            at = end
        found[path] = (source, "".join(parts) + source.text[at:])
    return found


def _is_improvement(before: Batch, after: Batch, kept: Sequence[Diagnostic]) -> bool:
    """Whether the fixed findings are gone, and no error is new."""
    old = Counter(map(fingerprint, before.report))
    new = Counter(map(fingerprint, after.report))
    gone = Counter(map(fingerprint, kept))
    errors = {fingerprint(item) for item in after.report if item.severity is Severity.ERROR}
    return all(new[mark] <= old[mark] - count for mark, count in gone.items()) and all(
        new[mark] <= old[mark] for mark in errors
    )


def differences(texts: Texts, sources: Mapping[str, Source]) -> Iterator[str]:
    """New texts as a unified diff, line by line, sorted by file name."""
    for path in sorted(texts, key=lambda path: sources[path].name):
        source = sources[path]
        name = Path(source.name).as_posix()
        old, new = (_lines(text) for text in (source.text, texts[path]))
        for line in difflib.unified_diff(old, new, name, name):
            yield line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n"


def _lines(text: str) -> list[str]:
    lines = [f"{line}\n" for line in text.split("\n")]
    lines[-1] = lines[-1][:-1]
    return lines if lines[-1] else lines[:-1]
