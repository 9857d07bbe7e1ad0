"""What the targets scxml, yasmin and flexbe accept: examples, cases of the tests, random machines.

    python bench/frameworks.py [COUNT]    # 500 random machines

Prints the share that each accepts, and each reason for the others.
"""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path

from hypothesis import HealthCheck, given, seed, settings

from smachac.diagnostics.diagnostic import Report
from smachac.driver import analyse_script
from smachac.ir.nodes import Machine
from smachac.targets.flexbe import names as flexbe
from smachac.targets.scxml import document
from smachac.targets.yasmin import structure as yasmin
from tests.strategies.full_machines import busy_machines
from tests.support.typed_machines import with_state_types

ROOT = Path(__file__).parents[1]


def refused_by_scxml(machine: Machine) -> list[str]:
    report: Report = []
    document(machine, report, traced=False)
    return [finding.message for finding in report]


def refused_by_yasmin(machine: Machine) -> list[str]:
    return [finding.message for finding in yasmin.refused(machine)]


def refused_by_flexbe(machine: Machine) -> list[str]:
    return [finding.message for finding in flexbe.refused(machine)]


TARGETS = {"scxml": refused_by_scxml, "yasmin": refused_by_yasmin, "flexbe": refused_by_flexbe}


def scripts(target: str, pattern: str) -> None:
    reasons: dict[str, list[str]] = {}
    count = 0
    for script in sorted(ROOT.glob(pattern)):
        machine = analyse_script(script).checked
        if machine is not None:
            count += 1
            if found := TARGETS[target](machine):
                reasons[script.parent.name] = found
    print(f"{target}, {pattern}: {count - len(reasons)} of {count} accepted")
    for name, found in reasons.items():
        print(f"  {name}: {found[0]}{f' and {len(found) - 1} more' if found[1:] else ''}")


def random_machines(target: str, count: int) -> None:
    reasons: Counter[str] = Counter()
    seen: list[bool] = []

    @seed(1)
    @settings(
        max_examples=count, database=None, deadline=None, suppress_health_check=list(HealthCheck)
    )
    @given(busy_machines())
    def draw(given: tuple[Machine, tuple[str, int]]) -> None:
        found = TARGETS[target](with_state_types(given[0]))
        seen.append(not found)
        reasons.update(found)

    draw()
    share = sum(seen) / len(seen)
    print(f"{target}, random machines: {sum(seen)} of {len(seen)} accepted ({share:.1%})")
    for reason, times in reasons.most_common():
        print(f"  {times} x {reason}")


if __name__ == "__main__":
    for name in TARGETS:
        scripts(name, "examples/*/main.yml")
        scripts(name, "tests/cases/**/main.yml")
        random_machines(name, int(sys.argv[1]) if sys.argv[1:] else 500)
