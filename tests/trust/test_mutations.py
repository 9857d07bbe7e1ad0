"""Damage is found: the right code at the right line. `python bench/mutants.py` does more of it."""

from __future__ import annotations

from dataclasses import replace

from correct import correct_project
from damage import Victim, judge
from damage_kinds import KINDS
from mutation import mutants, ratio, tallied, victims_of

PROJECTS = 30
EACH = 5
LEAST = 0.95
"""The part of all mutants with a fault that has to be caught."""

LEAST_OF_A_KIND = 0.8


def test_nearly_all_damage_is_caught() -> None:
    """All in one test, as all have one run in common."""
    tallies = tallied(mutants(victims_of(PROJECTS), EACH))
    assert len(tallies) >= 25
    told = "\n".join(
        f"{name} ({origin}): wanted {verdict.wanted}; said {', '.join(verdict.said)}"
        for name, tally in tallies.items()
        for origin, verdict in tally.missed
    )
    assert ratio(tallies) >= LEAST, told
    assert [name for name, tally in tallies.items() if tally.faults() < EACH / 2] == []
    worse = {
        name: tally.caught() / tally.faults()
        for name, tally in tallies.items()
        if tally.caught() < LEAST_OF_A_KIND * tally.faults()
    }
    assert worse == {}, told


def test_a_finding_elsewhere_or_of_another_code_would_not_do() -> None:
    """What is judged: the place and the code, not that something is said."""
    victim = Victim.of(correct_project(0))
    assert victim is not None
    damaged = victim.copied("elsewhere")
    mutant = KINDS["rename a target"](damaged)
    assert mutant is not None
    assert judge(damaged, mutant).judgement == "caught"
    assert judge(damaged, replace(mutant, codes=("SM104",))).judgement == "missed"
    assert judge(damaged, replace(mutant, places=(("main.yml", ()),))).judgement == "missed"
    assert judge(victim.copied("whole"), mutant).judgement == "equivalent"
