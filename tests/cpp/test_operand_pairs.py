"""Operators and built-in functions over every pair of kinds: C++ gives the values of Python."""

from __future__ import annotations

from itertools import islice
from pathlib import Path

import pytest

from smachac.ir.expressions import parse_expression
from smachac.targets.cpp.types import UnportableError
from tests.cpp.compilers import COMPILERS, SANITIZED, Compiler
from tests.cpp.expression_programs import Tally, differences, portable, program
from tests.cpp.operand_pairs import INPUTS, cases

FOUND = (
    "ud.note in ud.table",
    "ud.note not in ud.table",
    "ud.note in ud.scores",
    "ud.note in ud.s",
    "[] < [None]",
    "[None] < []",
    "[] < ud.gaps",
    "ud.gaps < []",
    "[ud.gaps] < [[]]",
    "1 ** 62",
    "(-1) ** 10001",
    "0 ** 10001",
)
"""Expressions whose values, or whose programs, were wrong."""


@COMPILERS
def test_kinds_that_were_wrong(compiler: Compiler, tmp_path: Path) -> None:
    batch = []
    for code in FOUND:
        tree = parse_expression(code)
        assert tree is not None
        batch.append(portable(tree))
    lines = compiler.run(program(batch, INPUTS), tmp_path, "-O0", *SANITIZED).splitlines()
    assert list(differences(batch, INPUTS, lines, Tally())) == []


@pytest.mark.nightly
@COMPILERS
def test_every_pair_of_kinds(compiler: Compiler, tmp_path: Path) -> None:
    tally = Tally()
    batch = list(islice(cases(), 0, None, 20))
    for start in range(0, len(batch), 400):
        part = batch[start : start + 400]
        lines = compiler.run(program(part, INPUTS), tmp_path, "-O0").splitlines()
        assert list(differences(part, INPUTS, lines, tally)) == []
    assert tally.equal > 1_000


@pytest.mark.parametrize(
    ("code", "reason"),
    [
        ("sum(ud.reals, ud.maybe)", "the start value may be None"),
        ("sum(ud.flags, ud.speed)", "the start value may be None"),
        ("sum(ud.flags, ud.flag)", "the start value is a truth value"),
    ],
)
def test_start_values_of_another_type_than_the_sum_are_refused(code: str, reason: str) -> None:
    tree = parse_expression(code)
    assert tree is not None
    with pytest.raises(UnportableError, match=reason):
        portable(tree)
