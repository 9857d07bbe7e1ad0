"""Edits of findings, tried out in memory: what mends its finding and breaks nothing is kept."""

from __future__ import annotations

import difflib
import os
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from smachac.batch import Survey
from smachac.diagnostics.diagnostic import Diagnostic, Edit, Report, Severity, fingerprint
from smachac.diagnostics.source import Source
from smachac.frontend.files import BUILT_IN
from smachac.refactor.formatter import laid_out

Texts = Mapping[str, str]
"""Changed texts by the real path of their file."""


MOST_ROUNDS = 10
"""What is mended may show what else can be mended; so often it is looked at."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Mended:
    """What edits make of scripts: how many findings they mend, the new texts, the sources as they
    were, by real path, and what there is to say afterwards."""

    count: int
    texts: Texts
    sources: Mapping[str, Source]
    survey: Survey


def mended(
    before: Survey, counted: Callable[[Survey], Report], again: Callable[[Texts], Survey]
) -> Mended:
    """Apply the edits of the findings that count, as far as they prove right.

    `again` looks at the same scripts with other texts. Edits that overlap are left out unless they
    are the same, so are those of files that come with smachac. If all together do not do, halves
    are tried: each finding kept is gone afterwards, and no error is new. The files that this
    changes come out in the layout of `smachac fmt`.
    """
    count = 0
    survey = before
    texts: dict[str, str] = {}
    sources: dict[str, Source] = {}
    for _ in range(MOST_ROUNDS):
        kept, after = _round(survey, counted(survey), lambda new: again({**texts, **new}))
        if not kept:
            break
        for path, (source, text) in _edited(kept).items():
            texts[path] = text
            sources.setdefault(path, source)
        count += len(kept)
        survey = after
    laid = {path: laid_out(Source(sources[path].name, text)) for path, text in texts.items()}
    new = {path: text for path, text in laid.items() if text is not None and text != texts[path]}
    if new and _better(survey, after := again({**texts, **new}), ()):
        texts.update(new)
        survey = after
    return Mended(count=count, texts=texts, sources=sources, survey=survey)


def _round(
    before: Survey, report: Report, again: Callable[[Texts], Survey]
) -> tuple[list[Diagnostic], Survey]:
    """The findings of a report that their edits mend, and what is left then."""
    kept: list[Diagnostic] = []
    survey = before

    def settle(batch: Sequence[Diagnostic]) -> None:
        nonlocal survey
        if not batch:
            return
        tried = [*kept, *batch]
        after = again({path: text for path, (_, text) in _edited(tried).items()})
        if _better(before, after, tried):
            kept.extend(batch)
            survey = after
        elif len(batch) > 1:
            settle(batch[: len(batch) // 2])
            settle(batch[len(batch) // 2 :])

    settle(_compatible([item for item in report if item.finding.edits]))
    return kept, survey


def _path(edit: Edit) -> str:
    return os.path.realpath(edit.span.source.name)


def _compatible(report: Report) -> Report:
    """The findings whose edits touch none of another finding, unless both say the same.

    Of insertions at one place the first stays; the next round finds the others.
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


def differences(texts: Texts, sources: Mapping[str, Source]) -> Iterator[str]:
    """New texts as a unified diff, by file in the order of their names, a line at a time."""
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
