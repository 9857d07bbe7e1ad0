"""Stepped C++ machines against what SMACH itself did, machine by recorded machine.

Every fifth machine is one of a quick program; at night each compiler and the sanitizers get all.
"""

from __future__ import annotations

import functools
from collections.abc import Iterable
from pathlib import Path

import pytest

from tests.conformance_ir import test_ir_vectors as recorded
from tests.cpp.compilers import BARE, COMPILERS, SANITIZED, Compiler, compilers, last_with
from tests.cpp.test_vectors import DEVIATIONS, told, without_shared
from tests.cpp.vector_programs import Part, part, replay

CHUNK = 100


@functools.cache
def made(name: str) -> Part | list[str]:
    return part(recorded.CASES[name], f"v{recorded.RUN.index(name)}", stepped=True)


@functools.cache
def expressible() -> tuple[str, ...]:
    """The machines whose keys all have a bound, or can be given one."""
    return tuple(name for name in recorded.RUN if isinstance(made(name), Part))


def differences(names: Iterable[str], compiler: Compiler, folder: Path, *flags: str) -> set[str]:
    """The machines that do not do what the interpreter does, branch by branch."""
    parts = {name: found for name in names if isinstance(found := made(name), Part)}
    runs = replay([*parts.values()], compiler, folder, *BARE, *flags, stepped=True)
    different: set[str] = set()
    for name, own in parts.items():
        case = recorded.CASES[name]
        ours = [without_shared(run, own) for run in recorded.replay(case)]
        if [told(case, ran) for ran in runs[name]] != ours:
            different.add(name)
    return different


def test_machines_do_what_smach_did(tmp_path: Path) -> None:
    if not compilers():
        pytest.skip("no C++ compiler")
    names = expressible()[::5]
    assert differences(names, compilers()[-1], tmp_path) == DEVIATIONS.keys() & set(names)


def test_most_machines_can_be_stepped() -> None:
    assert len(expressible()) == 307


@pytest.mark.nightly
@pytest.mark.parametrize("start", range(0, 307, CHUNK))
@COMPILERS
def test_all_machines_do_what_smach_did(compiler: Compiler, start: int, tmp_path: Path) -> None:
    names = expressible()[start : start + CHUNK]
    assert differences(names, compiler, tmp_path) == DEVIATIONS.keys() & set(names)


@pytest.mark.nightly
@pytest.mark.parametrize("start", range(0, 307, CHUNK))
def test_sanitizers_find_nothing(start: int, tmp_path: Path) -> None:
    names = expressible()[start : start + CHUNK]
    compiler = last_with(*SANITIZED)
    assert differences(names, compiler, tmp_path, *SANITIZED) == DEVIATIONS.keys() & set(names)
