"""Stepped machines on a Cortex-M4 in QEMU, without operating system, C library and heap."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.conformance_ir import test_ir_vectors as recorded
from tests.cpp import cortex
from tests.cpp.step_programs import Played, disagreements, played, random_path, text
from tests.cpp.test_vectors import DECLARED
from tests.cpp.vector_programs import BOUNDS, typed_machine

OUTPUT = """
extern "C" void board_print(const char *text, std::size_t size);
void verify::print(const char *text, std::size_t size) { board_print(text, size); }
"""
SEEDS = range(3)
"""The seeds of the paths that are tried on each machine."""


def machines(count: int) -> list[Played]:
    found: list[Played] = []
    for at, name in enumerate(recorded.RUN[::-1]):
        if name in DECLARED:
            continue
        machine = typed_machine(recorded.CASES[name], f"v{at}")
        paths = [path for seed in SEEDS if (path := random_path(machine, seed)) is not None]
        each = played(machine, f"machine_{at}", BOUNDS, paths) if len(paths) > 1 else None
        if each is not None:
            found.append(each)
        if len(found) == count:
            break
    return found


@pytest.mark.parametrize("count", [6, pytest.param(60, marks=pytest.mark.slow)], ids=["6", "60"])
def test_machines_do_what_the_interpreter_does(count: int, tmp_path: Path) -> None:
    every = machines(count)
    assert len(every) == count
    program = cortex.compiled(text(every, OUTPUT), tmp_path)
    assert [*disagreements(every, cortex.run(program))] == []
    flash, ram = cortex.sizes(program)
    print(f"{count} machines with their paths: flash {flash} bytes, RAM {ram} bytes")
