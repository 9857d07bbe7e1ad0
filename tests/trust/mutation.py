"""Mutation tests: many mutants of correct projects, and a table of what became of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field

from corpus import projects
from damage import Judgement, Verdict, Victim, broken
from damage_kinds import KINDS


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


def mutants(victims: list[tuple[str, Victim]], each: int) -> Iterator[tuple[str, str, Verdict]]:
    """For each kind so many mutants, where there are as many: kind, origin and what became of it.

    The victims are taken in turn, another one first for each kind; equivalent ones come on top,
    at most as many again.
    """
    for offset, name in enumerate(KINDS):
        faults = equal = 0
        for turn in range(3 * len(victims)):
            at = (turn + 7 * offset) % len(victims)
            origin, victim = victims[at]
            verdict = broken(victim, name, turn // len(victims))
            if verdict is None:
                continue
            yield name, origin, verdict
            equal += verdict.judgement == "equivalent"
            faults += verdict.judgement != "equivalent"
            if faults >= each or equal >= 2 * each:
                break


def victims_of(count: int) -> list[tuple[str, Victim]]:
    """Everything that can be damaged: by hand, and so many random projects."""
    found = [(name, Victim.of(project)) for name, project in projects(count)]
    return [(name, victim) for name, victim in found if victim is not None]


def tallied(results: Iterator[tuple[str, str, Verdict]]) -> dict[str, Tally]:
    tallies = {name: Tally() for name in KINDS}
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
