"""The repairs that findings offer: correct projects whose text is damaged in one place, and whether
the first finding holds the text that was lost, and the repair restores the original text. A table
by kind, and examples where they do not. Then the same for the kinds that are kept for judging, and
texts with two faults.

    python bench/repairs.py [mutants of each kind] [examples of each kind] [kind ...]

Mutants without a finding may be correct projects too: another number, a key with another value.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.trust.judged_repairs import JudgedRepair, TwoFaults, judged, two_faults
from tests.trust.kept_mutations import KEPT_MUTATIONS
from tests.trust.text_mutations import TEXT_MUTATIONS
from tests.trust.unusual_projects import unusual_projects

MUTANTS, EXAMPLES = 150, 0

Found = Mapping[str, Sequence[tuple[str, JudgedRepair]]]
"""The judged mutants of each kind, with the names of their projects."""


def main(count: int = MUTANTS, examples: int = EXAMPLES, kinds: Sequence[str] = ()) -> int:
    """Print the tables as Markdown, then the examples."""
    begun = time.process_time()
    for title, mutations in (("", TEXT_MUTATIONS), ("Kept for judging", KEPT_MUTATIONS)):
        found = judged_mutants([kind for kind in mutations if not kinds or kind in kinds], count)
        if found:
            print_table(title, found)
            print_weak(found, examples)
    if not kinds:
        print_two_faults(twice(count))
    print(f"\n{len(unusual_projects())} projects; {time.process_time() - begun:.0f} s of CPU")
    return 0


def judged_mutants(kinds: Sequence[str], count: int) -> Found:
    """`count` mutants of each kind, of projects in turn."""
    projects = sorted(unusual_projects().items())
    found: dict[str, list[tuple[str, JudgedRepair]]] = {}
    for offset, kind in enumerate(kinds):
        for turn in range(count):
            name, files = projects[(turn + 31 * offset) % len(projects)]
            repair = judged(files, kind, f"{kind} {name} {turn}")
            if repair is not None:
                found.setdefault(kind, []).append((name, repair))
    return found


def print_table(title: str, found: Found) -> None:
    """A row for each kind, and a sum."""
    print(f"\n### {title}\n" if title else "")
    words = ("mutants", "with a finding", "with exactly one", "names what was lost")
    print(f"| what was changed | {' | '.join(words)} | repair | restores the text | wrong |")
    print(f"| --- |{' ---: |' * 7}")
    for kind, rows in found.items():
        print_row(kind, (repair for _, repair in rows))
    print_row("all", (repair for rows in found.values() for _, repair in rows))


def print_row(kind: str, repairs: Iterable[JudgedRepair]) -> None:
    every = [*repairs]
    reported = [repair for repair in every if repair.findings]
    counts = (
        len(every),
        len(reported),
        sum(len(repair.findings) == 1 for repair in reported),
        sum(repair.named for repair in reported),
        sum(repair.repair is not None for repair in reported),
        sum(repair.restored for repair in reported),
        sum(repair.wrong for repair in reported),
    )
    print(f"| {kind} | {' | '.join(map(str, counts))} |")


def print_weak(found: Found, examples: int) -> None:
    """Mutants whose lost text is not named, or that have several findings."""
    for kind, rows in found.items():
        weak = [row for row in rows if row[1].findings and not good(row[1])]
        for name, repair in weak[:examples]:
            print(f"\n{kind} in {name}, {repair.file}:{repair.mutant.line}: {repair.mutant.what}")
            for item in repair.findings:
                print(f"  {item.code} {item.span.line}: {item.message}\n    help: {item.help}")


def good(repair: JudgedRepair) -> bool:
    return repair.named and len(repair.findings) == 1


def twice(count: int) -> list[TwoFaults]:
    """Texts with two faults of kinds in turn, each of which has a finding alone."""
    projects = sorted(unusual_projects().items())
    kinds = [*TEXT_MUTATIONS, *KEPT_MUTATIONS]
    pairs = [(one, other) for at, one in enumerate(kinds) for other in kinds[at + 1 :]]
    found = []
    for turn in range(4 * count):
        name, files = projects[(7 * turn) % len(projects)]
        made = two_faults(files, pairs[turn % len(pairs)], f"two {name} {turn}")
        if made is not None:
            found.append(made)
    return found


def print_two_faults(found: Sequence[TwoFaults]) -> None:
    both = sum(all(case.named) for case in found)
    single = sum(sum(case.named) for case in found)
    print(
        f"\nTwo faults in one file: {len(found)} files; {both} with both named, {single} of"
        f" {2 * len(found)} faults named"
    )


if __name__ == "__main__":
    count, examples, *kinds = [*sys.argv[1:], *map(str, (MUTANTS, EXAMPLES)[len(sys.argv) - 1 :])]
    sys.exit(main(int(count), int(examples), kinds))
