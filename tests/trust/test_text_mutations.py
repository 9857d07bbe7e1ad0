"""Damage to the text of a correct project: a finding, mostly one, that holds what was lost.

`python bench/repairs.py` runs more mutants, and prints a table.
"""

from __future__ import annotations

from collections.abc import Iterable

import pytest

from smachac.diagnostics.diagnostic import Diagnostic, Severity
from tests.trust.judged_repairs import JudgedRepair, judged
from tests.trust.text_mutations import TEXT_MUTATIONS
from tests.trust.unusual_projects import unusual_projects

QUICK, ALL = 10, 40
"""The mutants of a kind in `make test`, and in all tests."""

COUNTS = [QUICK, pytest.param(ALL, marks=pytest.mark.slow)]

LEAST_SINGLE, LEAST_NAMED = 0.80, 0.80
"""The parts of the mutants with a finding that have exactly one, and whose first finding names what
was lost. `python bench/repairs.py 100` measured 0.82 and 0.75."""


def found(kind: str, count: int) -> list[JudgedRepair]:
    """The findings about `count` mutants of a kind, of projects in turn."""
    projects = sorted(unusual_projects().items())
    offset = 7 * list(TEXT_MUTATIONS).index(kind)
    drawn = [projects[(turn * 3 + offset) % len(projects)] for turn in range(count)]
    made = [judged(files, kind, f"{kind} {name}") for name, files in drawn]
    return [repair for repair in made if repair is not None]


@pytest.mark.parametrize("count", COUNTS)
@pytest.mark.parametrize("kind", TEXT_MUTATIONS)
def test_damage_to_a_text_gives_findings_with_a_help_and_a_repair(kind: str, count: int) -> None:
    """The best repair of each finding removes it and adds no error; those of syntax errors and of
    unknown names may uncover other faults."""
    for judged_repair in found(kind, count):
        for item in judged_repair.findings:
            assert item.message
            assert item.help, (judged_repair.mutant, item.message)
            assert 0 <= item.span.start <= item.span.end <= len(item.span.source.text)
            assert_repaired(item, judged_repair)


UNCOVERING = {"SM101", "SM102", "SM302"}
"""While such a name is unknown, anything can be meant: its repair may uncover other faults."""


def place_of(item: Diagnostic) -> tuple[str, str, int, tuple[str, ...]]:
    span = item.finding.span
    return item.code, span.source.name, span.start, tuple(map(str, item.finding.arguments))


def assert_repaired(item: Diagnostic, found: JudgedRepair) -> None:
    for repair in item.finding.all_repairs[:1]:
        after = found.after(repair)
        if item.code == "SM021":  # a suppression may stand once for each caller
            continue
        if item.code in UNCOVERING:
            assert place_of(item) not in map(place_of, after), (found.mutant, item.message)
            continue
        assert equal_to(item, after) < equal_to(item, found.findings), (found.mutant, item.message)
        assert errors(after) <= errors(found.findings), found.mutant


def test_most_damage_gives_one_finding_that_names_what_was_lost() -> None:
    """All kinds in one test: of some, as of two swapped values, few can be decided."""
    reported = [item for kind in TEXT_MUTATIONS for item in found(kind, QUICK) if item.findings]
    assert len(reported) > 80
    single = sum(len(item.findings) == 1 for item in reported)
    named = sum(item.named for item in reported)
    assert single >= LEAST_SINGLE * len(reported)
    assert named >= LEAST_NAMED * len(reported)


def errors(report: Iterable[Diagnostic]) -> int:
    return sum(item.severity is Severity.ERROR for item in report)


def equal_to(item: Diagnostic, report: Iterable[Diagnostic]) -> int:
    """The number of findings with the code and the arguments of one."""
    key = (item.code, item.finding.arguments)
    return sum((other.code, other.finding.arguments) == key for other in report)
