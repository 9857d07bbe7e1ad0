"""The tables of codes: complete, in order, and each code once."""

from __future__ import annotations

import re
from pathlib import Path

from smachac import checks
from smachac.checks.classes import template_blocks
from smachac.driver import CODES
from smachac.frontend.errors import python_machines, references, script, suppressions
from smachac.targets import errors

PROBLEMS = (
    script.PROBLEMS,
    references.PROBLEMS,
    suppressions.PROBLEMS,
    python_machines.PROBLEMS,
    checks.problems(),
    errors.PROBLEMS,
)
ALL = [
    *(problem.code.code for problems in PROBLEMS for problem in problems),
    *(rule.code.code for rule in checks.rules() if rule is not template_blocks.unprinted_parts),
]
"""The codes of all problems and rules. `unprinted_parts` finds faults of a problem, SM605."""

DECLARED = re.compile(r"^@(?:rule|problem)\(\s*\"(SM\d+)\"", re.M)


def test_every_rule_and_problem_in_the_source_is_in_one_tuple() -> None:
    files = Path(checks.__file__).parents[1].rglob("*.py")
    declared = [code for file in files for code in DECLARED.findall(file.read_text("utf-8"))]
    assert sorted(declared) == sorted(ALL)


def test_each_code_is_given_once_and_is_in_the_table() -> None:
    assert len(set(ALL)) == len(ALL)
    assert list(CODES) == sorted(ALL)
    assert all(name == code.code for name, code in CODES.items())


def test_the_tuples_are_in_the_order_of_their_codes() -> None:
    tuples = [[problem.code.code for problem in problems] for problems in PROBLEMS]
    about_code = checks.code_rules()
    *over_machines, last = (rule for rule in checks.rules() if rule not in about_code)
    assert last.code.code == "SM019"
    for rules in (over_machines, about_code):
        tuples.append([rule.code.code for rule in rules])
    assert tuples == [sorted(codes) for codes in tuples]
