"""Mutation tests of the checker: correct projects, one kind of damage each, the right code at the
right line. A table by kind, and what was missed.

    python bench/mutants.py [mutants of each kind] [random projects]
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.trust.mutation_score import mutants, ratio, subjects_of, tallied

EACH, PROJECTS = 20, 100


def main(each: int = EACH, projects: int = PROJECTS) -> int:
    """Print the table as Markdown, then each mutant that was missed."""
    begun = time.process_time()
    subjects = subjects_of(projects)
    tallies = tallied(mutants(subjects, each))
    print("| what was changed | caught | missed | no fault | reason why it is no fault |")
    print("| --- | --- | --- | --- | --- |")
    for name, tally in tallies.items():
        counts = [tally.counts[word] for word in ("caught", "missed", "equivalent")]
        why = ", ".join(tally.reasons)
        print(f"| {name} | {' | '.join(map(str, counts))} | {why} |")
    total: Counter[str] = Counter()
    for tally in tallies.values():
        total.update(tally.counts)
    took = time.process_time() - begun
    print(f"\n{len(tallies)} kinds, {len(subjects)} projects: {dict(sorted(total.items()))};")
    print(f"{ratio(tallies):.2%} of the mutants with a fault caught; {took:.0f} s of CPU")
    for name, tally in tallies.items():
        for origin, verdict in tally.missed:
            print(f"missed: {name} in {origin}: wanted {verdict.wanted[:200]}")
            print(f"  said: {', '.join(verdict.said)[:300]}")
    return 0


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
