"""Random machines and scripts do on YASMIN what the interpreter does, event by event."""

from __future__ import annotations

import logging
from pathlib import Path

import pytest

from tests.support.examples import seeds
from tests.support.executives import SCRIPTS, compare_random_machines, compare_script
from tests.yasmin.programs import files_of, trace


@pytest.fixture(autouse=True)
def _no_log(silent_smach: None) -> None:
    logging.getLogger("yasmin").setLevel(logging.CRITICAL)


@pytest.mark.parametrize("number", seeds(1, 3, 12))
def test_machines_do_what_the_interpreter_does(number: int) -> None:
    compare_random_machines(number, files_of, trace)


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.parent.name)
def test_examples(script: Path) -> None:
    compare_script(script, files_of, trace)
