"""Repairs: edits of texts that correct a fault, and how certain it is that they are meant."""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum

from smachac.diagnostics.source import Source, Span
from smachac.records import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Edit:
    """A range of a source, and the text that replaces it."""

    span: Span
    text: str


class Certainty(Enum):
    """How certain a repair is.

    SAFE: `check --fix` makes it, if a new check has no new error. LIKELY: an editor offers it, and
    the help of the finding names it. POSSIBLE: it is shown where there is no other one.
    """

    SAFE = "safe"
    LIKELY = "likely"
    POSSIBLE = "possible"


@dataclass(frozen=True, slots=True, kw_only=True)
class Repair:
    """Edits that correct a fault, all of them together. `operator` is the kind of the change in a
    few words, such as `insert a sign`."""

    edits: tuple[Edit, ...]
    certainty: Certainty
    operator: str


def edited_texts(edits: Iterable[Edit]) -> dict[Source, str]:
    """The texts of the sources after edits that do not overlap."""
    by_source: dict[Source, list[Edit]] = {}
    for edit in edits:
        by_source.setdefault(edit.span.source, []).append(edit)
    texts = {}
    for source, own in by_source.items():
        text = source.text
        for edit in sorted(own, key=lambda edit: (edit.span.start, edit.span.end), reverse=True):
            text = text[: edit.span.start] + edit.text + text[edit.span.end :]
        texts[source] = text
    return texts
