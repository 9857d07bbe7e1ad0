"""Machines of scripts in Python for YASMIN, plain and as the target prints them: what is read is
the machine."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest
from hypothesis import assume, given, settings

from smachac.driver import analyse_script, build
from smachac.driver.python_machines import PythonProject
from smachac.frontend.files import Disk, disk_library
from smachac.ir.nodes import (
    Concurrence,
    Container,
    Leaf,
    Machine,
    Node,
    Sequence,
    StateMachine,
    Transition,
)
from smachac.ir.nodes import Iterator as IteratorNode
from smachac.ir.traversal import leads_to_child, outcome_names, remapping, walk
from smachac.pysource.machines.coverage import coverage_of
from smachac.targets.yasmin import TARGET
from tests.pipeline.test_differential import LIBRARY
from tests.strategies.full_machines import busy_machines
from tests.strategies.machines import valid_machines
from tests.support.examples import examples
from tests.support.executives import SCRIPTS
from tests.yasmin.programs import RUNTIME, files_of

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


# --- the modules of the target


def target_of(container: Container, edge: Transition) -> str:
    """A target as the target for YASMIN names it."""
    names = frozenset(child.name for child in container.children)
    return state_name(container, edge.target) if leads_to_child(edge, names) else edge.target


def state_name(container: Container, name: str) -> str:
    in_machine = isinstance(container, StateMachine | Sequence)
    return f"{name} (state)" if in_machine and name in outcome_names(container) else name


def whole(node: Node, name: str, *, is_written: bool) -> Any:
    """All that a module of the target has of a state. `is_written`: it is that of the script; the
    keys of a state are in the program of the states."""
    found: dict[str, Any] = {"name": name}
    if not isinstance(node, Container):
        return found
    found["outcomes"] = {*outcome_names(node)}
    found["keys"] = [{key.name for key in keys} for keys in (node.inputs, node.outputs)]
    children = [*node.children]
    if isinstance(node, StateMachine | Sequence):
        if is_written:
            graph = {child.name: {edge.target for edge in child.transitions} for child in children}
            reached, todo = set(), [node.initial or children[0].name]
            while todo:
                if (at := todo.pop()) in graph and at not in reached:
                    reached.add(at)
                    todo += graph[at]
            children = [child for child in children if child.name in reached]
        found["initial"] = state_name(node, node.initial) if is_written else node.initial
        found["steps"] = [
            {edge.outcome: target_of(node, edge) if is_written else edge.target
             for edge in child.transitions} for child in children
        ]  # fmt: skip
    if not isinstance(node, IteratorNode):
        found["remaps"] = [remapping(child) for child in children]
    if isinstance(node, Concurrence):
        found["rules"] = {(rule.outcome, frozenset((one.child, one.outcome) for one in rule.when))
                          for rule in node.rules}  # fmt: skip
        found |= {"default": node.default_outcome, "join": node.join}
    if isinstance(node, IteratorNode):
        found |= {"item": node.item_key, "again": {*node.loop_outcomes},
                  "end": node.exhausted_outcome, "final": dict(node.final_map)}  # fmt: skip
    found["children"] = [
        whole(child, state_name(node, child.name) if is_written else child.name,
              is_written=is_written) for child in children
    ]  # fmt: skip
    return found


def compare_generated(machine: Machine, files: dict[str, str], folder: Path) -> None:
    """Compares the machine that is read from the files of the target with that of the script."""
    first, *_ = files
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")
    (folder / first).with_name(RUNTIME.name).write_text(RUNTIME.read_text("utf-8"), "utf-8")
    (graph,) = PythonProject(Disk()).read(folder / first).graphs
    read, root = graph.machine.root, machine.root
    found, wanted = (whole(node, node.name, is_written=node is root) for node in (read, root))
    inputs, own = found["keys"].pop(0), wanted["keys"].pop(0)
    assert inputs >= own  # with those of its userdata, which is in the program of the states
    assert found == wanted


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.parent.name)
@pytest.mark.parametrize("package", ["false", "robot"])
def test_modules_of_the_target(script: Path, package: str, tmp_path: Path) -> None:
    analysis = analyse_script(script)
    assert analysis.checked is not None
    library = disk_library(script, [])
    options = {"package": package}
    files = build(analysis.checked, TARGET, library, [], options)
    compare_generated(analysis.checked, files, tmp_path)


@settings(max_examples=examples(40))
@given(busy_machines())
def test_modules_of_random_machines(given: tuple[Machine, tuple[str, int]]) -> None:
    machine, _ = given
    files = files_of(machine, LIBRARY)
    assume(files is not None)
    assert files is not None
    with TemporaryDirectory() as folder:
        compare_generated(machine, files, Path(folder))
