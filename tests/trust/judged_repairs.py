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
from smachac.diagnostics.repair import Certainty, Repair, edited_texts
from smachac.driver import Analysis
from smachac.repair.search import again, clusters
from smachac.report.text import with_cluster
from tests.trust.kept_mutations import KEPT_MUTATIONS
from tests.trust.project_text import analysed
from tests.trust.text_mutations import TEXT_MUTATIONS, TextMutant, TextMutation

ALL_MUTATIONS: Mapping[str, TextMutation] = {**TEXT_MUTATIONS, **KEPT_MUTATIONS}

Files = Mapping[str, str]


@dataclass(frozen=True, slots=True)
class JudgedRepair:
    """A mutant of a project with its findings, errors and warnings, as they are printed: in their
    order, without those that the repair of another one explains. `original` are the files before
    the mutation, `files` those after it; `repair` is the first repair of the report."""

    original: Files
    file: str
    files: Files
    mutant: TextMutant
    findings: tuple[Diagnostic, ...]
    repair: Repair | None

    def after(self, repair: Repair) -> tuple[Diagnostic, ...]:
        """The findings after a repair."""
        return shown(analysed(self._files_after(repair)))[0]

    @property
    def named(self) -> bool:
        """Whether the first finding holds what was lost."""
        return bool(self.findings) and names_all(self.findings[0], self.mutant.lost)

    @property
    def restored(self) -> bool:
        """Whether the repair restores the original text of every file that it changes, exactly."""
        return bool(self._repaired) and all(old == new for old, new in self._repaired)

    @property
    def wrong(self) -> bool:
        """Whether there is a repair after which the script is another machine than the original."""
        if self.repair is None or self.restored:
            return False
        after = analysed(self._files_after(self.repair)).machine
        return after != analysed(self.original).machine

    def _files_after(self, repair: Repair) -> Files:
        new = {source.name: text for source, text in edited_texts(repair.edits).items()}
        return {**self.files, **new}

    @property
    def _repaired(self) -> list[tuple[str, str]]:
        """The original texts of the files that the repair changes, and those after it."""
        texts = edited_texts(self.repair.edits) if self.repair is not None else {}
        return [(self.original.get(source.name, ""), text) for source, text in texts.items()]


def names_all(item: Diagnostic, lost: tuple[str, ...]) -> bool:
    """Whether a finding holds all pieces of a text that were lost, in its message or its help."""
    words = f"{item.message} {item.help or ''}"
    return all(piece in words for piece in lost)


def mutated(files: Files, kind: str, seed: str) -> tuple[str, TextMutant | None]:
    """A file of a project and its mutant, which is None if the mutation does not fit the file."""
    draw = random.Random(seed)
    file = draw.choice(scripts(files))
    return file, ALL_MUTATIONS[kind](files[file], draw)


def judged(files: Files, kind: str, seed: str) -> JudgedRepair | None:
    """One mutant of a project, judged; None if the mutation does not fit its file."""
    file, mutant = mutated(files, kind, seed)
    if mutant is None:
        return None
    changed = {**files, file: mutant.text}
    return JudgedRepair(files, file, changed, mutant, *shown(analysed(changed)))


def scripts(files: Files) -> list[str]:
    return [name for name in sorted(files) if name.endswith((".yml", ".yaml"))]


def shown(analysis: Analysis) -> tuple[tuple[Diagnostic, ...], Repair | None]:
    """The errors and warnings of a project as they are printed, and the first repair, if it is more
    than possible."""
    found = clusters(analysis, analysis.report, again(analysis))
    hidden = {id(item) for cluster in found for item in cluster.explained}
    roots = {id(cluster.finding): cluster for cluster in found}
    items = [
        with_cluster(item, roots.get(id(item)))
        for item in analysis.report
        if item.severity is not Severity.INFO and id(item) not in hidden
    ]
    first = found[0].repair if found else None
    is_likely = first is not None and first.certainty is not Certainty.POSSIBLE
    return (*items,), first if is_likely else None


def printed(files: Files) -> list[tuple[str, str, str]]:
    """Code, text at the place, and help of each error and warning of a project as it is printed."""
    return [(item.code, item.span.text, item.help or "") for item in shown(analysed(files))[0]]


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
    one, other, found = (
        shown(analysed({**files, file: mutant.text}))[0] for mutant in (first, alone, second)
    )
    if not one or not other:
        return None
    named = [any(names_all(item, mutant.lost) for item in found) for mutant in (first, second)]
    return TwoFaults((first, second), (named[0], named[1]))
