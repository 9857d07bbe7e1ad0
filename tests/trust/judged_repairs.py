"""What the findings about a damaged text are worth: whether they name the piece that was lost, and
whether the repair that they offer restores the original text.

A damaged text has one mutation of `text_mutations.TEXT_MUTATIONS` or of `kept_mutations`, or two
(`two_faults`).
"""

from __future__ import annotations

import random
from collections.abc import Mapping
from dataclasses import dataclass

from smachac.diagnostics.diagnostic import Diagnostic, Edit, Severity
from tests.trust.kept_mutations import KEPT_MUTATIONS
from tests.trust.project_text import analysed
from tests.trust.text_mutations import TEXT_MUTATIONS, TextMutant, TextMutation

ALL_MUTATIONS: Mapping[str, TextMutation] = {**TEXT_MUTATIONS, **KEPT_MUTATIONS}

Files = Mapping[str, str]


@dataclass(frozen=True, slots=True)
class JudgedRepair:
    """A mutant of a project with its findings, errors and warnings, in the order in which they are
    printed. `original` are the files before the mutation."""

    original: Files
    file: str
    mutant: TextMutant
    findings: tuple[Diagnostic, ...]

    @property
    def named(self) -> bool:
        """Whether the first finding holds what was lost."""
        return bool(self.findings) and names_all(self.findings[0], self.mutant.lost)

    @property
    def edits(self) -> tuple[Edit, ...]:
        """The edits of the first finding that has some."""
        return next((item.finding.edits for item in self.findings if item.finding.edits), ())

    @property
    def restored(self) -> bool:
        """Whether the edits restore the original text of every file that they change, exactly."""
        return bool(self.edits) and all(
            text == self.original.get(name) for name, text in applied(self.edits).items()
        )


def names_all(item: Diagnostic, lost: tuple[str, ...]) -> bool:
    """Whether a finding holds all pieces of a text that were lost, in its message or its help."""
    words = f"{item.message} {item.help or ''}"
    return all(piece in words for piece in lost)


def applied(edits: tuple[Edit, ...]) -> dict[str, str]:
    """The texts of the files after some edits, by name."""
    texts = {edit.span.source.name: edit.span.source.text for edit in edits}
    for edit in sorted(edits, key=lambda edit: edit.span.start, reverse=True):
        name = edit.span.source.name
        texts[name] = texts[name][: edit.span.start] + edit.text + texts[name][edit.span.end :]
    return texts


def judged(files: Files, kind: str, seed: str) -> JudgedRepair | None:
    """One mutant of a project, judged; None if the mutation does not fit its file."""
    draw = random.Random(seed)
    file = draw.choice(scripts(files))
    mutant = ALL_MUTATIONS[kind](files[file], draw)
    if mutant is None:
        return None
    return JudgedRepair(files, file, mutant, findings({**files, file: mutant.text}))


def scripts(files: Files) -> list[str]:
    return [name for name in sorted(files) if name.endswith((".yml", ".yaml"))]


def findings(files: Files) -> tuple[Diagnostic, ...]:
    """The errors and warnings of a project."""
    report = analysed(files).report
    return tuple(item for item in report if item.severity is not Severity.INFO)


@dataclass(frozen=True, slots=True)
class TwoFaults:
    """Two mutations of one file, and which of them a finding names."""

    mutants: tuple[TextMutant, TextMutant]
    named: tuple[bool, bool]


def two_faults(files: Files, kinds: tuple[str, str], seed: str) -> TwoFaults | None:
    """A file with two faults. Each of them alone has a finding; else the result is None."""
    draw = random.Random(seed)
    file = draw.choice(scripts(files))
    first = ALL_MUTATIONS[kinds[0]](files[file], draw)
    second = ALL_MUTATIONS[kinds[1]](first.text, draw) if first is not None else None
    alone = ALL_MUTATIONS[kinds[1]](files[file], random.Random(seed))
    if first is None or second is None or alone is None:
        return None
    if not findings({**files, file: first.text}) or not findings({**files, file: alone.text}):
        return None
    found = findings({**files, file: second.text})
    named = [any(names_all(item, mutant.lost) for item in found) for mutant in (first, second)]
    return TwoFaults((first, second), (named[0], named[1]))
