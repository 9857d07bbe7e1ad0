"""Requests to stop, answered or not, over several runs: random machines, compiled, against the
interpreter."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.conformance_ir import test_ir_vectors as recorded
from tests.cpp.compilers import Compiler, last_with
from tests.cpp.test_vectors import told
from tests.cpp.vector_programs import Part, part, replay
from tests.support.stop_machines import cases, once

MACHINES = 40
MANY = 1_200


def differing(seed: int, start: int, stop: int, compiler: Compiler, folder: Path) -> list[str]:
    """Machines that do something else when compiled."""
    drawn = cases(seed, stop)[start:]
    parts = [part(case, f"r{number}") for number, case in enumerate(drawn)]
    assert all(isinstance(item, Part) for item in parts), parts
    runs = replay([item for item in parts if isinstance(item, Part)], compiler, folder)
    return [
        case["id"]
        for case in drawn
        if once([told(case, ran) for ran in runs[case["id"]]]) != once(recorded.replay(case))
    ]


@pytest.mark.slow
def test_requests_reach_the_same_states(tmp_path: Path) -> None:
    assert differing(1, 0, MACHINES, last_with(), tmp_path) == []


@pytest.mark.nightly
@pytest.mark.parametrize("start", range(0, MANY, 100))
def test_requests_reach_the_same_states_in_many_machines(tmp_path: Path, start: int) -> None:
    assert differing(2, start, start + 100, last_with(), tmp_path) == []


def test_machines_are_of_use() -> None:
    """In many a state is asked that keeps a request: it is asked, and its machine was not."""
    asked = [
        event
        for case in cases(1, MACHINES)
        for run in recorded.replay(case)
        for event in run["events"]
        if isinstance(event, list) and event[0] == "+" and event[-1] == "P"
    ]
    assert len(asked) > MACHINES
