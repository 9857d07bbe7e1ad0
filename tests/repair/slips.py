"""One slip in a correct project: what is printed, and whether its repair restores the text."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from smachac.diagnostics.diagnostic import Diagnostic
from smachac.diagnostics.repair import Repair, edited_texts
from smachac.diagnostics.source import Span
from tests.trust.judged_repairs import shown
from tests.trust.project_text import analysed


class Slip(NamedTuple):
    """A slip in a file, with the findings that are printed and the first repair."""

    original: Mapping[str, str]
    file: str
    line: int
    items: tuple[Diagnostic, ...]
    repair: Repair | None

    @property
    def is_restored(self) -> bool:
        """Whether the repair gives the original text of all files that it changes."""
        texts = edited_texts(self.repair.edits) if self.repair is not None else {}
        return bool(texts) and all(
            self.original.get(source.name) == text for source, text in texts.items()
        )

    @property
    def is_shown(self) -> bool:
        """Whether a finding shows the line of the slip."""
        spans = [span for item in self.items for span in (item.span, *_related(item))]
        return any((span.source.name, span.line) == (self.file, self.line) for span in spans)


def _related(item: Diagnostic) -> list[Span]:
    return [related.span for related in item.finding.related]


def slip(files: Mapping[str, str], right: str, wrong: str) -> Slip:
    """A project with `wrong` in place of the first `right` in the first file that has it."""
    file = next(name for name, text in files.items() if right in text)
    line = files[file][: files[file].index(right)].count("\n") + 1
    found = shown(analysed({**files, file: files[file].replace(right, wrong, 1)}))
    return Slip(files, file, line, *found)
