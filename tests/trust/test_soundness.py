"""Soundness: a machine without an error does not fail, whatever its leaves do by their interfaces.

The machines are random: projects that are correct or slightly damaged, and small graphs over a few
keys of which most are wrong. Those without an error are run many times, with leaves, turns of
branches and requests to stop by chance.
"""

from __future__ import annotations

from dataclasses import replace
from typing import cast

import pytest
from hypothesis import HealthCheck, Phase, event, given, settings

from smachac.analysis.accesses import scripted_steps
from smachac.checks import check_machine
from smachac.diagnostics.diagnostic import Report, Severity
from smachac.diagnostics.source import NOWHERE
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run
from smachac.interpreter.result import Event, InterpreterResult
from smachac.ir.nodes import Key, Leaf, Machine, Node, StateMachine
from smachac.ir.traversal import walk
from tests.conformance_ir.ir_vectors import machine_of
from tests.conformance_ir.test_ir_vectors import CASES
from tests.strategies.full_machines import busy_machines
from tests.strategies.userdata_machines import data_machines
from tests.support.examples import examples, seeds
from tests.trust.mutants import Subject
from tests.trust.mutations import MUTATIONS
from tests.trust.project_text import judged
from tests.trust.random_projects import correct_project
from tests.trust.random_runs import contradictions, runs

PROJECTS = seeds(2, 5, 14)
DAMAGED = 6
RUNS = 9


def fault(machine: Machine, report: Report, result: InterpreterResult, asked: bool) -> str | None:
    """How a run failed that must not fail; None where all is well.

    A key that is perhaps missing has been told, as such or as a race; one that goes round is cut
    short. An iterator that is asked to stop ends as its state does (docs/semantics.md, Iterator),
    perhaps with an outcome that it does not have: that has been told as well.
    """
    if result.error is None or result.error.kind == "no-end":
        return None
    kind, path = result.error.kind, result.error.path
    codes = {item.code for item in report}
    if kind == "missing-key" and codes & {"SM301", "SM405"}:
        return None
    if kind == "missing-key" and any(
        f"`{key}`" in str(result.error) for key in _cut_off(machine, report)
    ):
        return None
    told = {item.finding.node for item in report if item.code == "SM208"}
    if asked and kind == "undeclared-outcome" and path in told:
        return None
    return f"{kind}: {result.error}"


def _cut_off(machine: Machine, report: Report) -> set[str]:
    """The keys that states set which cannot be entered (SM201): a key that is unset without them is
    not reported as well."""
    paths = {item.finding.node for item in report if item.code == "SM201"}
    return {key.name for path, node in walk(machine.root) if path in paths for key in node.outputs}


def failures(machine: Machine, report: Report, count: int) -> list[str]:
    """What goes wrong in so many runs, and what of the report they contradict."""
    found: list[str | None] = []
    for result, events in runs(machine, count):
        asked = any(item["event"] == "preempt" for item in events)
        found.append(fault(machine, report, result, asked))
        found += contradictions(machine, report, events)
    return [item for item in found if item is not None]


def told_wrong(machine: Machine, report: Report, count: int = RUNS) -> list[str]:
    """What runs contradict of the report on a machine with errors."""
    return [
        contradiction
        for _, events in runs(machine, count)
        for contradiction in contradictions(machine, report, events)
    ]


@pytest.mark.parametrize("seed", PROJECTS)
def test_projects_without_an_error_run_without_a_fault(seed: int) -> None:
    subject = Subject.of(correct_project(seed))
    assert subject is not None
    assert failures(subject.machine, [], RUNS) == []
    names = sorted(MUTATIONS)
    for number in range(DAMAGED):
        damaged = subject.copied(f"sound/{seed}/{number}")
        for name in damaged.draw.sample(names, 2):
            MUTATIONS[name](damaged)
        analysis = judged(damaged.project)
        if analysis.machine is not None and analysis.checked is not None:
            found = failures(analysis.machine, analysis.report, RUNS)
            assert found == [], (seed, number)
        elif analysis.machine is not None:
            assert told_wrong(analysis.machine, analysis.report) == [], (seed, number)


HARMLESS = ("SM201", "SM202", "SM405")
"""Errors that do not make a run fail, or, with a race, only perhaps."""


def corrected(machine: Machine) -> tuple[Machine, Report] | None:
    """A machine whose states that are at fault read and hand on nothing; None where that is not
    enough. What nobody found fault with stays."""
    machine = replace(machine, root=cast(StateMachine, _quiet(machine.root, "sm", set())))
    for _ in range(5):
        report = check_machine(machine)
        wrong = {
            item.finding.node
            for item in report
            if item.severity is Severity.ERROR and item.code not in HARMLESS
        }
        if not wrong:
            return machine, report
        machine = replace(machine, root=cast(StateMachine, _quiet(machine.root, "sm", wrong)))
    return None


def _quiet(node: Node, path: str, wrong: set[str | None]) -> Node:
    if path in wrong:
        node = replace(node, inputs=(), remaps=())
    if isinstance(node, Leaf):
        # What it sets it declares: another fault, and none of these.
        sets = {key for _, keys in scripted_steps(node) for key in keys}
        known = {key.name for key in node.outputs}
        extra = tuple(Key(name=key, span=NOWHERE) for key in sorted(sets - known))
        return replace(node, outputs=(*node.outputs, *extra))
    children = [_quiet(child, f"{path}/{child.name}", wrong) for child in node.children]
    return replace(node, children=tuple(children))


def expect_no_fault(machine: Machine) -> None:
    """The report on a machine is not contradicted, and without its errors it runs."""
    assert told_wrong(machine, check_machine(machine)) == []
    found = corrected(machine)
    event("error" if found is None else "clean")
    if found is not None:
        assert failures(*found, RUNS) == []


@settings(
    max_examples=examples(40), phases=[Phase.generate], suppress_health_check=list(HealthCheck)
)
@given(data_machines())
def test_graphs_without_an_error_run_without_a_fault(machine: Machine) -> None:
    expect_no_fault(machine)


@pytest.mark.nightly
@settings(max_examples=200, phases=[Phase.generate], suppress_health_check=list(HealthCheck))
@given(data_machines())
def test_many_graphs_without_an_error_run_without_a_fault(machine: Machine) -> None:
    expect_no_fault(machine)


@settings(max_examples=150, phases=[Phase.generate], suppress_health_check=list(HealthCheck))
@given(busy_machines())
@pytest.mark.slow
def test_what_is_said_holds_where_states_fail_and_catch(drawn: tuple[Machine, object]) -> None:
    """States that raise, with and without somebody who catches it (`Node.catches`)."""
    machine, _ = drawn
    report = check_machine(machine)
    events: list[Event] = []
    run(machine, builtin_behaviour(), events.append, max_steps=300)
    assert list(contradictions(machine, report, events)) == []
    missing = [one for one in events if "holds nothing" in one.get("message", "")]
    told = {item.code for item in report} & {"SM301", "SM303", "SM307"}
    event("caught" if any(one.get("outcome") == "error" for one in events) else "quiet")
    assert told or not missing


@pytest.mark.parametrize("name", CASES)
def test_errors_about_recorded_machines_are_none_that_a_run_contradicts(name: str) -> None:
    """These machines were made to compare runs, and most have faults; what is said must be so."""
    machine = machine_of(CASES[name])
    machine = replace(machine, root=replace(machine.root, name="sm"))
    assert told_wrong(machine, check_machine(machine), 3) == []


def test_a_fault_would_be_found() -> None:
    """Each kind of fault that is looked for, in a machine that is not clean."""
    wanted = {"missing-key", "no-transition", "no-target"}
    kinds: set[str] = set()
    for seed in range(40):
        if kinds >= wanted:
            return
        subject = Subject.of(correct_project(seed))
        assert subject is not None
        for name in ("drop a preset", "drop a transition", "rename a target"):
            damaged = subject.copied(f"fault/{seed}/{name}")
            MUTATIONS[name](damaged)
            machine = judged(damaged.project).machine
            if machine is not None:
                kinds |= {failure.split(":")[0] for failure in failures(machine, [], 3)}
    assert kinds >= wanted
