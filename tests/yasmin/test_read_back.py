"""Machines of scripts as plain Python for YASMIN: what is read is the machine."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest
from hypothesis import assume, given, settings

from smachac.driver import analyse_script
from smachac.driver.python_machines import PythonProject
from smachac.frontend.files import Disk
from smachac.ir.nodes import Concurrence, Container, Leaf, Machine, Node, StateMachine
from smachac.ir.traversal import outcome_names, walk
from smachac.pysource.coverage import coverage_of
from tests.strategies.machines import valid_machines
from tests.support.examples import examples
from tests.support.executives import SCRIPTS

HEAD = "from yasmin import Concurrence, State, StateMachine\n"


def lines(node: Node, name: str, numbers: Iterator[int]) -> Iterator[str]:
    """The statements that build a state in the variable `name`."""
    outcomes = [*outcome_names(node)]
    if not isinstance(node, Container):
        yield f"{name} = State({outcomes!r})"
        return
    children = {child.name: f"s{next(numbers)}" for child in node.children}
    if isinstance(node, Concurrence):
        for child in node.children:
            yield from lines(child, children[child.name], numbers)
        states = ", ".join(f"{key!r}: {variable}" for key, variable in children.items())
        rules = {rule.outcome: {one.child: one.outcome for one in rule.when} for rule in node.rules}
        yield f"{name} = Concurrence({{{states}}}, {node.default_outcome!r}, {rules!r})"
        return
    assert isinstance(node, StateMachine)
    yield f"{name} = StateMachine(outcomes={outcomes!r})"
    for child in node.children:
        yield from lines(child, children[child.name], numbers)
        table = {step.outcome: step.target for step in child.transitions
                 if step.origin == "written"}  # fmt: skip
        yield f"{name}.add_state({child.name!r}, {children[child.name]}, transitions={table!r})"
    yield f"{name}.set_start_state({node.initial!r})"


def shape(node: Node) -> Any:
    """What a machine for YASMIN has of a state: names, targets, outcomes and rules, without
    order."""
    steps = {step.outcome: step.target for step in node.transitions}
    found: dict[str, Any] = {"name": node.name, "steps": steps}
    found["outcomes"] = {*outcome_names(node)}
    if isinstance(node, Container):
        found["children"] = [shape(child) for child in node.children]
    if isinstance(node, StateMachine):
        found["initial"] = node.initial
    if isinstance(node, Concurrence):
        rules = {rule.outcome: {(one.child, one.outcome) for one in rule.when}
                 for rule in node.rules}  # fmt: skip
        found |= {"default": node.default_outcome, "rules": rules}
    return found


def is_plain(root: Node) -> bool:
    """Whether YASMIN has all that a machine consists of: no loops over items, no branches that stop
    others, one rule for each outcome of a concurrence, no name for a state and for an outcome."""
    for _, node in walk(root):
        if isinstance(node, Concurrence):
            names = [rule.outcome for rule in node.rules]
            known = {*names, node.default_outcome}
            if node.join == "any" or len({*names}) < len(names) or known != {*outcome_names(node)}:
                return False
        elif not isinstance(node, StateMachine | Leaf):
            return False
        if isinstance(node, Container):
            states = {child.name for child in node.children}
            if not states or states & {*outcome_names(node)}:
                return False
    return True


def without_others(node: Node) -> Node:
    """A machine in which a container that YASMIN does not have is a state with its outcomes."""
    if not isinstance(node, Container):
        return node
    plain = replace(node, children=tuple(map(without_others, node.children)))
    if is_plain(plain):
        return plain
    return Leaf(
        name=node.name, type="Other", outcomes=node.outcomes, transitions=node.transitions,
        span=node.span,
    )  # fmt: skip


def compare(root: StateMachine, folder: Path) -> set[str]:
    """Compares the machine that is read with that which was written; the codes of the findings."""
    path = folder / "machine.py"
    text = "\n".join(lines(root, "sm", count()))
    path.write_text(f"{HEAD}{text}\n", "utf-8")
    file = PythonProject(Disk()).read(path)
    (graph,) = file.graphs
    coverage = coverage_of([graph])
    assert coverage.states == coverage.exact
    assert shape(graph.machine.root) == {**shape(root), "name": "sm"}
    return {item.code for item in file.report}


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.parent.name)
def test_examples(script: Path, tmp_path: Path) -> None:
    machine = analyse_script(script).machine
    assert machine is not None
    root = without_others(machine.root)
    assert isinstance(root, StateMachine)
    assert compare(root, tmp_path) == set()


@settings(max_examples=examples(40))
@given(valid_machines())
def test_random_machines(machine: Machine) -> None:
    root = without_others(machine.root)
    assume(isinstance(root, StateMachine))
    assert isinstance(root, StateMachine)
    with TemporaryDirectory() as folder:
        compare(root, Path(folder))
