"""The mutation score: how many mutants of correct projects the checks find, by mutation."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from tests.trust.correct_projects import projects
from tests.trust.mutants import Judgement, Subject, Verdict, broken
from tests.trust.mutations import MUTATIONS


@dataclass
class Tally:
    """What became of the mutants of one kind: `missed` with their origins, why others are none."""

    counts: Counter[Judgement] = field(default_factory=Counter)
    missed: list[tuple[str, Verdict]] = field(default_factory=list)
    reasons: Counter[str] = field(default_factory=Counter)

    def caught(self) -> int:
        return self.counts["caught"]

    def faults(self) -> int:
        """The mutants that have a fault."""
        return self.counts["caught"] + self.counts["missed"]


def mutants(
    subjects: list[tuple[str, Subject]], each: int, names: Iterable[str] = tuple(MUTATIONS)
) -> Iterator[tuple[str, str, Verdict]]:
    """`each` mutants of each mutation of `names`, or as many as there are: its name, the origin,
    the verdict.

    The subjects are taken in turn, starting with a different one for each mutation. Equivalent
    mutants are extra, at most `each` of them.
    """
    wanted = frozenset(names)
    for offset, name in enumerate(MUTATIONS):
        if name not in wanted:
            continue
        faults = equal = 0
        for turn in range(3 * len(subjects)):
            at = (turn + 7 * offset) % len(subjects)
            origin, subject = subjects[at]
            verdict = broken(subject, name, turn // len(subjects))
            if verdict is None:
                continue
            yield name, origin, verdict
            equal += verdict.judgement == "equivalent"
            faults += verdict.judgement != "equivalent"
            if faults >= each or equal >= 2 * each:
                break


def subjects_of(count: int) -> list[tuple[str, Subject]]:
    """The projects written by hand and `count` random ones."""
    found = [(name, Subject.of(project)) for name, project in projects(count)]
    return [(name, subject) for name, subject in found if subject is not None]


def tallied(results: Iterator[tuple[str, str, Verdict]]) -> dict[str, Tally]:
    tallies = {name: Tally() for name in MUTATIONS}
    for name, origin, verdict in results:
        tally = tallies[name]
        tally.counts[verdict.judgement] += 1
        if verdict.judgement == "missed":
            tally.missed.append((origin, verdict))
        if verdict.reason:
            tally.reasons[verdict.reason] += 1
    return tallies


def ratio(tallies: dict[str, Tally]) -> float:
    """The part of all mutants with a fault that is caught."""
    faults = sum(tally.faults() for tally in tallies.values())
    return sum(tally.caught() for tally in tallies.values()) / faults
