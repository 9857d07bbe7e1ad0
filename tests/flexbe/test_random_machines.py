"""Random machines with every construct do on FlexBE what the interpreter does, event by event."""

from __future__ import annotations

import logging
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, seed, settings

from smachac.driver import analyse_script
from smachac.frontend.files import disk_library
from smachac.ir.nodes import Machine
from smachac.runtime.tracing.compare import compare
from tests.flexbe.programs import files_of, trace
from tests.pipeline.test_differential import LIBRARY, of_interpreter
from tests.strategies.full_machines import busy_machines
from tests.support.examples import seeds

ROOT = Path(__file__).parents[2]
SCRIPTS = [
    *sorted(ROOT.glob("examples/0[1-7]*/main.yml")),
    *(ROOT / "tests" / "cases" / name / "main.yml"
      for name in ("containers", "deep_nesting", "on_error", "sugar", "concurrence_any")),
]  # fmt: skip


def without_requests(events: list[dict[str, object]]) -> list[dict[str, object]]:
    return [event for event in events if event["event"] != "preempt"]


@pytest.fixture(autouse=True)
def _no_log(silent_smach: None) -> None:
    logging.getLogger("flexbe").setLevel(logging.CRITICAL)


@pytest.mark.parametrize("number", seeds(1, 3, 12))
def test_machines_do_what_the_interpreter_does(number: int) -> None:
    compared = 0

    @seed(number)
    @settings(
        max_examples=40, database=None, deadline=None, suppress_health_check=list(HealthCheck)
    )
    @given(busy_machines())
    def check(given: tuple[Machine, tuple[str, int]]) -> None:
        nonlocal compared
        machine, asked = given
        ours = of_interpreter(machine, asked)
        if ours is None:
            return
        files = files_of(machine, LIBRARY)
        assert files is not None
        theirs = trace(files, asked)
        assert compare(without_requests(ours), without_requests(theirs)) is None
        compared += 1

    check()
    assert compared > 20


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.parent.name)
def test_examples(script: Path) -> None:
    machine = analyse_script(script).checked
    assert machine is not None
    ours = of_interpreter(machine)
    assert ours is not None
    files = files_of(machine, disk_library(script, []))
    assert files is not None
    assert compare(without_requests(ours), without_requests(trace(files))) is None
