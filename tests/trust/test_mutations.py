"""Mutants bring the right code at the right line. `python bench/mutants.py` runs more of them."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.trust.mutants import Subject, judge
from tests.trust.mutation_score import mutants, ratio, subjects_of, tallied
from tests.trust.mutations import MUTATIONS
from tests.trust.random_projects import correct_project

PROJECTS = 30
LEAST = 0.95
"""The part of all mutants with a fault that has to be caught."""

LEAST_OF_A_KIND, FEWEST = 0.8, 5
"""The same for one kind of damage of which there are at least so many."""


PARTS = 4
"""The parts of the mutations, so that the parts run at the same time."""


@pytest.mark.parametrize(
    ("each", "part"),
    [
        (2, 0),
        *(pytest.param(2, part, marks=pytest.mark.slow) for part in range(1, PARTS)),
        *(pytest.param(10, part, marks=pytest.mark.nightly) for part in range(PARTS)),
    ],
)
def test_nearly_all_damage_is_caught(each: int, part: int) -> None:
    names = [*MUTATIONS][part::PARTS]
    found = tallied(mutants(subjects_of(PROJECTS), each, names))
    tallies = {name: found[name] for name in names}
    assert len(tallies) >= 25
    told = "\n".join(
        f"{name} ({origin}): wanted {verdict.wanted}; said {', '.join(verdict.said)}"
        for name, tally in tallies.items()
        for origin, verdict in tally.missed
    )
    assert ratio(tallies) >= LEAST, told
    assert [name for name, tally in tallies.items() if tally.faults() == 0] == []
    worse = {
        name: tally.caught() / tally.faults()
        for name, tally in tallies.items()
        if tally.faults() >= FEWEST and tally.caught() < LEAST_OF_A_KIND * tally.faults()
    }
    assert worse == {}, told


def test_a_finding_elsewhere_or_of_another_code_would_not_do() -> None:
    """What is judged: the place and the code, not that something is said."""
    subject = Subject.of(correct_project(0))
    assert subject is not None
    damaged = subject.copied("elsewhere")
    mutant = MUTATIONS["rename a target"](damaged)
    assert mutant is not None
    assert judge(damaged, mutant).judgement == "caught"
    assert judge(damaged, replace(mutant, codes=("SM104",))).judgement == "missed"
    assert judge(damaged, replace(mutant, places=(("main.yml", ()),))).judgement == "missed"
    assert judge(subject.copied("whole"), mutant).judgement == "equivalent"
