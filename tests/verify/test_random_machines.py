"""`smachac verify` on random machines: no false alarm, no false word on what cannot be taken."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from hypothesis import HealthCheck, given, seed, settings

from smachac.driver import build
from smachac.frontend.files import disk_library
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run
from smachac.ir.nodes import Checked, Machine
from smachac.targets.python import TARGET
from smachac.verify import verify
from smachac.verify.coverage import Coverage
from smachac.verify.players.python import player
from tests.strategies.full_machines import busy_machines
from tests.support.examples import examples
from tests.support.typed_machines import with_state_types

ROOT = Path(__file__).parents[2]
SLOW = list(HealthCheck)
LIBRARY = disk_library(ROOT / "main.yml", [])


@seed(0)
@settings(max_examples=examples(30), database=None, deadline=None, suppress_health_check=SLOW)
@given(busy_machines())
def test_random_machines_agree(drawn: tuple[Machine, tuple[str, int]]) -> None:
    machine, _ = drawn
    typed = with_state_types(machine, LIBRARY)
    report: list[Any] = []
    ((name, text),) = build(Checked(typed), TARGET, LIBRARY, report).items()
    played = player(name, text, machine, folders=[ROOT])
    verdict = verify(machine, {"python": played}, script="main.yml", most=40)
    assert verdict.disagreements == []
    taken = Coverage(machine)
    for number in range(5):
        run(machine, builtin_behaviour(number), taken.record, seed=number, max_steps=300)
    never = {way for way, _, why in verdict.missing if why.never}
    assert not never & taken.covered
