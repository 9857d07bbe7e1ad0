"""The recorded machines of SMACH on FlexBE: the traces are those of the interpreter, with the
inputs that each leaf finds."""

from __future__ import annotations

import contextlib
import copy
import logging
from collections import Counter
from typing import Any

import pytest

from smachac.ir.nodes import Machine
from tests.conformance_ir.test_ir_vectors import RUN
from tests.flexbe.programs import files_of, loaded, ready
from tests.support.examples import every
from tests.support.executives import (
    LEAVES_MACHINE,
    RECORDED,
    REFUSED,
    UNDECLARED,
    recorded_difference,
)
from tests.support.recorded_leaf import PERFORMED


def played(machine: Machine, case: Any) -> list[Any] | None:
    files = files_of(machine, RECORDED)
    if files is None:
        return None
    events: list[Any] = []
    with loaded(files) as made:
        behavior = ready(made)
        engine = behavior._state_machine
        for key, value in case.get("userdata", {}).items():
            engine.userdata[key] = copy.deepcopy(value)
        PERFORMED.update(events=events, request=engine.request_preempt)
        engine.observe(events.append)
        if case.get("preempt_before"):
            engine.request_preempt()
        with contextlib.suppress(Exception):
            behavior.execute()
    return events


@pytest.fixture(autouse=True)
def _no_log(silent_smach: None) -> None:
    logging.getLogger("flexbe").setLevel(logging.CRITICAL)


PARTS = 8


@pytest.mark.parametrize("part", every(4, range(PARTS)))
def test_machines_do_what_the_interpreter_does(part: int) -> None:
    found = {name: recorded_difference(name, played) for name in RUN[part::PARTS]}
    reasons = Counter(found.values())
    assert set(reasons) <= {None, REFUSED, UNDECLARED, LEAVES_MACHINE}, found
    assert reasons[None] > 40
