"""What the findings about a damaged text are worth: whether they name the piece that was lost, and
whether the repair that they offer restores the original text.

A damaged text has one mutation of `text_mutations.TEXT_MUTATIONS` or of `kept_mutations`, or two
(`two_faults`).
"""

from __future__ import annotations

import random
from collections.abc import Mapping
from dataclasses import dataclass

from smachac.diagnostics.diagnostic import Diagnostic, Severity
from smachac.diagnostics.repair import Edit, Repair, edited_texts
from tests.trust.kept_mutations import KEPT_MUTATIONS
from tests.trust.project_text import analysed
from tests.trust.text_mutations import TEXT_MUTATIONS, TextMutant, TextMutation

ALL_MUTATIONS: Mapping[str, TextMutation] = {**TEXT_MUTATIONS, **KEPT_MUTATIONS}

Files = Mapping[str, str]


@dataclass(frozen=True, slots=True)
class JudgedRepair:
    """A mutant of a project with its findings, errors and warnings, in the order in which they are
    printed. `original` are the files before the mutation, `files` those after it."""

    original: Files
    file: str
    files: Files
    mutant: TextMutant
    findings: tuple[Diagnostic, ...]

    def after(self, repair: Repair) -> tuple[Diagnostic, ...]:
        """The findings after a repair."""
        new = {source.name: text for source, text in edited_texts(repair.edits).items()}
        return findings({**self.files, **new})

    @property
    def named(self) -> bool:
        """Whether the first finding holds what was lost."""
        return bool(self.findings) and names_all(self.findings[0], self.mutant.lost)

    @property
    def edits(self) -> tuple[Edit, ...]:
        """The edits of the best repair of the first finding that has one."""
        repairs = (item.finding.all_repairs for item in self.findings)
        return next((found[0].edits for found in repairs if found), ())

    @property
    def restored(self) -> bool:
        """Whether the edits restore the original text of every file that they change, exactly."""
        return bool(self.edits) and all(
            text == self.original.get(source.name)
            for source, text in edited_texts(self.edits).items()
        )


def names_all(item: Diagnostic, lost: tuple[str, ...]) -> bool:
    """Whether a finding holds all pieces of a text that were lost, in its message or its help."""
    words = f"{item.message} {item.help or ''}"
    return all(piece in words for piece in lost)


def judged(files: Files, kind: str, seed: str) -> JudgedRepair | None:
    """One mutant of a project, judged; None if the mutation does not fit its file."""
    draw = random.Random(seed)
    file = draw.choice(scripts(files))
    mutant = ALL_MUTATIONS[kind](files[file], draw)
    if mutant is None:
        return None
    changed = {**files, file: mutant.text}
    return JudgedRepair(files, file, changed, mutant, findings(changed))


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
