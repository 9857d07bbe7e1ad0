"""Arguments name a fault: equal findings have equal arguments, different ones have different ones.

Identity and fingerprints use the arguments of a finding and never its message. So the findings of
one code at one place are compared here: equal messages have equal arguments, and the reverse.
"""

from __future__ import annotations

import re
from collections import defaultdict
from pathlib import Path
from typing import TypeAlias

import pytest

from smachac.checks.robot.workspace import unreachable
from smachac.diagnostics.diagnostic import Finding, Report, Severity, diagnostic
from smachac.diagnostics.source import Source, Span
from smachac.driver import CODES, analyse, code_faults
from smachac.driver.python_machines import PythonProject
from smachac.frontend.files import Disk, disk_library, read_source
from smachac.frontend.loader import Library, memory_library
from smachac.report.explain_code import MAIN, MAIN_IN_PYTHON, explanation
from smachac.targets import BuildContext, load_target
from tests.support.examples import every, seeds
from tests.trust.mutants import Subject, files_of
from tests.trust.mutations import MUTATIONS
from tests.trust.project_text import BUILT_IN
from tests.trust.random_projects import correct_project

ROOT = Path(__file__).parents[2]
SCRIPTS = [
    *sorted((ROOT / "tests" / "cases").rglob("main.yml")),
    *sorted((ROOT / "tests" / "reports").glob("*.yml")),
    *sorted((ROOT / "tests" / "explained").glob("*.yml")),
    *sorted((ROOT / "examples").glob("*/main.yml")),
]
QUICK, MORE = 1, 12
"""The random projects of the corpus; each kind of mutation is applied to each of them."""

Place: TypeAlias = tuple[str, Severity, Span]
"""Code, severity and span of a finding."""

_QUOTED = re.compile("`([^`]*)`")


def words(finding: Finding) -> str:
    """The message; in a sub-script without the names of states, which may come from its caller."""
    if all(item.span.source is finding.span.source for item in finding.related):
        return finding.message
    names = set((finding.node or "").split("/"))
    return _QUOTED.sub(lambda found: "``" if found[1] in names else found[0], finding.message)


def faulty_codes(report: Report) -> set[str]:
    """The codes with a finding without arguments, or with two findings at one place that differ in
    their message only or in their arguments only."""
    messages: dict[tuple[Place, tuple[str, ...]], set[str]] = defaultdict(set)
    arguments: dict[tuple[Place, str], set[tuple[str, ...]]] = defaultdict(set)
    for item in report:
        place, text = (item.code, item.severity, item.span), words(item.finding)
        messages[place, item.finding.arguments].add(text)
        arguments[place, text].add(item.finding.arguments)
    same_arguments = {place[0] for (place, _), each in messages.items() if len(each) > 1}
    same_message = {place[0] for (place, _), each in arguments.items() if len(each) > 1}
    without = {item.code for item in report if not item.finding.arguments}
    return same_arguments | same_message | without


def check_arguments(report: Report) -> None:
    assert faulty_codes(report) == set()


def every_finding(source: Source, library: Library, report: Report) -> Report:
    """All findings of a script and of its Python and C++ code, repeated ones as well."""
    analysis = analyse(source, library, report, unreachable)
    for name in ("python", "cpp") if analysis.checked is not None else ():
        target = load_target(name)
        assert target is not None
        assert analysis.checked is not None
        report.extend(code_faults(analysis.checked, target, library))
        target.emit(analysis.checked, BuildContext(library=library), report)
    return report


@pytest.mark.parametrize(
    "path", every(3, SCRIPTS), ids=lambda path: f"{path.parent.name}/{path.stem}"
)
def test_arguments_in_scripts(path: Path) -> None:
    report: Report = []
    source = read_source(path, report)
    assert source is not None
    library = disk_library(path, report, codes=CODES)
    check_arguments(every_finding(source, library, report))


@pytest.mark.parametrize(
    "code",
    [
        pytest.param(code, marks=pytest.mark.slow if number % 3 else ())
        for number, code in enumerate(sorted(CODES))
    ],
)
@pytest.mark.slow
def test_arguments_in_the_examples_of_a_code(code: str, tmp_path: Path) -> None:
    for files in (explanation(CODES[code]).wrong, explanation(CODES[code]).right):
        if MAIN_IN_PYTHON in files:
            for name, text in files.items():
                (tmp_path / name).write_text(text)
            check_arguments(PythonProject(Disk()).read(tmp_path / MAIN_IN_PYTHON).report)
            continue
        library = memory_library(files, BUILT_IN)
        check_arguments(every_finding(Source(MAIN, files[MAIN]), library, []))


SEEDS = seeds(QUICK, QUICK + 1, MORE)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.slow
def test_arguments_in_random_projects_with_one_fault(seed: int) -> None:
    subject = Subject.of(correct_project(seed))
    assert subject is not None
    for name, mutate in MUTATIONS.items():
        changed = subject.copied(f"{name}/{seed}")
        mutant = mutate(changed)
        if mutant is not None:
            files, report = files_of(changed, mutant), Report()
            analyse(Source(MAIN, files[MAIN]), memory_library(files, BUILT_IN), report)
            assert (name, faulty_codes(report)) == (name, set())


def test_faulty_arguments_are_found() -> None:
    source = Source("x.yml", "x")
    at = Span(source, 0, 1)
    code = CODES["SM004"]

    def found(*findings: Finding) -> set[str]:
        return faulty_codes([diagnostic(code, finding) for finding in findings])

    one = Finding(span=at, message="`a` is wrong", arguments=("a",))
    assert found(one, one) == set()
    assert found(one, Finding(span=at, message="`b` is wrong", arguments=("b",))) == set()
    assert found(Finding(span=at, message="`a` is wrong")) == {"SM004"}
    assert found(one, Finding(span=at, message="`b` is wrong", arguments=("a",))) == {"SM004"}
    assert found(one, Finding(span=at, message="`a` is wrong", arguments=("b",))) == {"SM004"}
