"""Verdicts on properties, compared with those of SPIN on the same machines and properties."""

from __future__ import annotations

import random
import shutil
from collections.abc import Iterable
from pathlib import Path

import pytest

from smachac.analysis.context import Context
from smachac.analysis.properties import judge
from smachac.ir.nodes import Machine
from smachac.ir.properties import Property
from smachac.ir.traversal import walk
from tests.support.promela import spin_verdicts
from tests.support.property_machines import random_machine, random_property

pytestmark = pytest.mark.skipif(
    shutil.which("spin") is None or shutil.which("tcc") is None, reason="needs SPIN and tcc"
)

BATCH = 15
"""Machines in one model: SPIN and the C compiler take as long for one machine as for a few."""

LARGEST = 60
"""States of the largest machine: the search takes long for more."""


def disagreements(seeds: Iterable[int], wanted: int, folder: Path) -> tuple[list[int], int]:
    """The seeds on which SPIN and the checker differ, and the number of properties that hold."""
    batch: list[tuple[int, Machine, Property, bool]] = []
    found, holding, judged = [], 0, 0
    for seed in seeds:
        rng = random.Random(seed)
        machine = random_machine(rng, depth=rng.choice([1, 2, 3]))
        given = random_property(rng, machine)
        if len([*walk(machine.root)]) > LARGEST:
            continue
        (judgement,) = judge([given], machine.root, Context(machine).claims)
        if judgement.verdict == "undecided":
            continue
        batch.append((seed, machine, given, judgement.verdict != "fails"))
        if len(batch) == min(BATCH, wanted - judged):
            verdicts = spin_verdicts([(item[1], item[2]) for item in batch], folder)
            found += [b[0] for b, held in zip(batch, verdicts, strict=True) if b[3] != held]
            holding += sum(verdicts)
            judged += len(batch)
            batch = []
        if judged == wanted:
            return found, holding
    raise AssertionError("not enough seeds")


def test_spin_agrees(tmp_path: Path) -> None:
    different, holding = disagreements(range(100), 8, tmp_path)
    assert different == []
    assert 0 < holding < 8


@pytest.mark.nightly
@pytest.mark.parametrize("part", range(10))
def test_spin_agrees_on_five_hundred_machines(part: int, tmp_path: Path) -> None:
    start = 10_000 + 1000 * part
    different, _ = disagreements(range(start, start + 1000), 50, tmp_path)
    assert different == []
