"""Behaviors of scripts: what is read of the generated code is the machine of the script."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import HealthCheck, Phase, given, seed, settings

from smachac.driver import analyse_script
from smachac.driver.python_machines import PythonProject
from smachac.frontend.files import Disk, disk_library
from smachac.frontend.loader import Library
from smachac.ir.nodes import Concurrence, Container, Iterator, Machine, Node
from smachac.ir.traversal import outcome_names
from smachac.pysource.machines.coverage import coverage_of
from smachac.targets.flexbe.names import RENAMED, Names, names_of
from tests.flexbe.programs import files_of
from tests.pipeline.test_differential import LIBRARY
from tests.strategies.full_machines import busy_machines
from tests.support.examples import seeds
from tests.support.executives import SCRIPTS

OWN = {to: name for name, to in RENAMED.items()}
"""The names of outcomes in the script, by those that FlexBE gets."""


def compare(written: Node, found: Node, path: str, names: Names) -> None:
    """Compares a state that is read with that of the script, at a path. The branches of a
    concurrence and the state of a loop have transitions in FlexBE only."""
    outcomes = {*outcome_names(written), *(step.outcome for step in written.transitions)}
    outcomes |= {written.catches} if written.catches else set()
    assert {OWN.get(name, name) for name in outcome_names(found)} == outcomes, path
    if not isinstance(written, Container):
        return
    assert isinstance(found, Container)
    children = {child.name: child for child in found.children}
    labels = {names.labels[f"{path}/{child.name}"]: child for child in written.children}
    assert children.keys() == labels.keys(), path
    first = found.children[0].name
    is_plain = not isinstance(written, Concurrence | Iterator)
    assert labels[first].name == (getattr(written, "initial", "") or written.children[0].name)
    for label, child in labels.items():
        compare(child, children[label], f"{path}/{child.name}", names)
        levels = ({OWN.get(one.outcome, one.outcome): one.level for one in node.autonomy}
                  for node in (child, children[label]))  # fmt: skip
        assert next(levels) == next(levels), path
        steps = {OWN.get(step.outcome, step.outcome): labels[step.target].name
                 if step.target in labels else OWN.get(step.target, step.target)
                 for step in children[label].transitions}  # fmt: skip
        if is_plain:
            assert steps == {step.outcome: step.target for step in child.transitions}, path
    if isinstance(written, Concurrence):
        assert isinstance(found, Concurrence)
        rules = {(OWN.get(rule.outcome, rule.outcome), frozenset(
            (labels[one.child].name, OWN.get(one.outcome, one.outcome)) for one in rule.when))
            for rule in found.rules}  # fmt: skip
        assert rules == {(rule.outcome, frozenset((one.child, one.outcome) for one in rule.when))
                         for rule in written.rules}, path  # fmt: skip


def read_back(machine: Machine, library: Library, folder: Path) -> set[str]:
    """Compares the machine of a behavior with that which was written; the codes of the findings."""
    files = files_of(machine, library)
    assert files is not None
    return compare_generated(machine, files, folder)


def compare_generated(machine: Machine, files: dict[str, str], folder: Path) -> set[str]:
    """The same for the files of a behavior."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")
    (folder / ".git").mkdir()  # all packages in one repository
    (behavior,) = folder.glob("*_flexbe_behaviors/*_flexbe_behaviors/*_sm.py")
    file = PythonProject(Disk()).read(behavior)
    (graph,) = file.graphs
    coverage = coverage_of([graph])
    assert coverage.states == coverage.exact, coverage
    compare(machine.root, graph.machine.root, machine.root.name, names_of(machine))
    return {item.code for item in file.report}


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.parent.name)
def test_examples(script: Path, tmp_path: Path) -> None:
    machine = analyse_script(script).checked
    assert machine is not None
    assert read_back(machine, disk_library(script, []), tmp_path) == set()


@pytest.mark.parametrize("number", seeds(1, 2, 12))
def test_random_machines(number: int) -> None:
    @seed(number)
    @settings(
        max_examples=15, database=None, deadline=None, phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )  # fmt: skip
    @given(busy_machines())
    def check(given: tuple[Machine, tuple[str, int]]) -> None:
        with TemporaryDirectory() as folder:
            read_back(given[0], LIBRARY, Path(folder))

    check()
