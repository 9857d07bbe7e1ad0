"""Edits of findings, tried out in memory: what mends its finding and breaks nothing is kept."""

from __future__ import annotations

import difflib
import os
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from smachac.diagnostics import Diagnostic, Edit, Report, Severity, fingerprint
from smachac.files import BUILT_IN
from smachac.source import Source
from smachac.survey import Survey

Texts = Mapping[str, str]
"""Changed texts by the real path of their file."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Mended:
    """What edits make of scripts: the findings they mend, the new texts, the sources as they were,
    by real path, and what there is to say afterwards."""

    findings: tuple[Diagnostic, ...]
    texts: Texts
    sources: Mapping[str, Source]
    survey: Survey


def mended(before: Survey, report: Report, again: Callable[[Texts], Survey]) -> Mended:
    """Apply the edits of the findings in `report` as far as they prove right.

    `again` looks at the same scripts with other texts. Edits that overlap are left out unless they
    are the same, so are those of files that come with smachac. If all together do not do, halves
    are tried: each finding kept is gone afterwards, and no error is new.
    """
    kept: list[Diagnostic] = []
    survey = before

    def settle(batch: Sequence[Diagnostic]) -> None:
        nonlocal survey
        if not batch:
            return
        texts = {path: text for path, (_, text) in _edited([*kept, *batch]).items()}
        after = again(texts)
        if _better(before, after, [*kept, *batch]):
            kept.extend(batch)
            survey = after
        elif len(batch) > 1:
            settle(batch[: len(batch) // 2])
            settle(batch[len(batch) // 2 :])

    settle(_compatible([item for item in report if item.finding.edits]))
    edited = _edited(kept)
    return Mended(
        findings=tuple(kept),
        texts={path: text for path, (_, text) in edited.items()},
        sources={path: source for path, (source, _) in edited.items()},
        survey=survey,
    )


def _path(edit: Edit) -> str:
    return os.path.realpath(edit.span.source.name)


def _compatible(report: Report) -> Report:
    """The findings whose edits touch none of another finding, unless both say the same."""
    ours = tuple(os.path.realpath(folder) + os.sep for folder in BUILT_IN)
    taken: dict[str, list[tuple[int, int, str, int]]] = {}
    out: set[int] = set()
    for number, item in enumerate(report):
        for edit in item.finding.edits:
            if _path(edit).startswith(ours):
                out.add(number)
            row = (edit.span.start, edit.span.end, edit.text, number)
            taken.setdefault(_path(edit), []).append(row)
    for rows in taken.values():
        furthest = (-1, -1, "", -1)
        for row in sorted(rows):
            apart = row[0] >= furthest[1] and row[0] > furthest[0]
            if not apart and row[:3] != furthest[:3]:
                out |= {row[3], furthest[3]}
            furthest = max(furthest, row, key=lambda row: row[1])
    return [item for number, item in enumerate(report) if number not in out]


def _edited(report: Sequence[Diagnostic]) -> dict[str, tuple[Source, str]]:
    """The texts that edits give, beside their sources, by real path."""
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


def _better(before: Survey, after: Survey, kept: Sequence[Diagnostic]) -> bool:
    """Whether the findings are gone, and no error has come."""
    old = Counter(map(fingerprint, before.report))
    new = Counter(map(fingerprint, after.report))
    gone = Counter(map(fingerprint, kept))
    errors = {fingerprint(item) for item in after.report if item.severity is Severity.ERROR}
    return all(new[mark] <= old[mark] - count for mark, count in gone.items()) and all(
        new[mark] <= old[mark] for mark in errors
    )


def differences(found: Mended) -> Iterator[str]:
    """The new texts as a unified diff, by file in the order of their names, a line at a time."""
    for path in sorted(found.texts, key=lambda path: found.sources[path].name):
        source = found.sources[path]
        name = Path(source.name).as_posix()
        old, new = (_lines(text) for text in (source.text, found.texts[path]))
        for line in difflib.unified_diff(old, new, name, name):
            yield line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n"


def _lines(text: str) -> list[str]:
    lines = [f"{line}\n" for line in text.split("\n")]
    lines[-1] = lines[-1][:-1]
    return lines if lines[-1] else lines[:-1]
