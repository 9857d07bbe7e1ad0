"""The guarantees of the strategies, on which other tests rely."""

from __future__ import annotations

import pytest
from hypothesis import given, settings

from smachac.checks import check_machine
from smachac.diagnostics.diagnostic import Severity
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run
from smachac.ir.graph import can_end, reachable
from smachac.ir.nodes import Concurrence, Iterator, Leaf, Machine, Node, Sequence, StateMachine
from smachac.ir.traversal import containers, outcome_names, walk
from tests.strategies.full_machines import busy_machines
from tests.strategies.machines import valid_machines
from tests.support.examples import examples


@given(valid_machines())
@settings(max_examples=examples(60))
def test_no_rule_finds_an_error_in_a_valid_machine(machine: Machine) -> None:
    errors = [item for item in check_machine(machine) if item.severity is Severity.ERROR]
    assert errors == []


@given(valid_machines())
@settings(max_examples=examples(60))
def test_every_state_of_a_valid_machine_is_reachable_and_can_end(machine: Machine) -> None:
    for _, container in containers(machine.root):
        names = {child.name for child in container.children}
        assert names == reachable(container) == can_end(container)


@given(valid_machines())
@settings(max_examples=examples(60))
def test_every_run_of_a_valid_machine_ends(machine: Machine) -> None:
    assert run(machine, builtin_behaviour()).outcome in outcome_names(machine.root)


def test_valid_machines_have_all_there_is() -> None:
    nodes: list[Node] = []

    @given(valid_machines())
    @settings(max_examples=examples(60))
    def collect(machine: Machine) -> None:
        nodes.extend(node for _, node in walk(machine.root))

    collect()
    assert {type(node) for node in nodes} == {Leaf, StateMachine, Sequence, Concurrence, Iterator}
    origins = {step.origin for node in nodes for step in node.transitions}
    assert origins == {"written", "implicit", "connector"}
    assert any(node.remaps for node in nodes)
    assert any(node.outputs for node in nodes if not isinstance(node, Leaf))
    assert any(node.rules for node in nodes if isinstance(node, Concurrence))


@pytest.mark.nightly
def test_busy_machines_have_all_there_is() -> None:
    found: set[str] = set()

    @given(busy_machines())
    @settings(max_examples=examples(400))
    def collect(drawn: tuple[Machine, tuple[str, int]]) -> None:
        machine, asked = drawn
        found.add("asked" if asked[0] else "not asked")
        result = run(machine, builtin_behaviour(), max_steps=300)
        found.add(result.error.kind if result.error else "ended")
        for _, node in walk(machine.root):
            found.add(node.type)
            if isinstance(node, Concurrence):
                outcomes = [rule.outcome for rule in node.rules]
                found.add(f"join {node.join}")
                found.add("same outcome" if len(set(outcomes)) < len(outcomes) else "")
            if isinstance(node, Iterator):
                found.add("items by key" if node.items_key else "items")

    collect()
    assert found >= {
        *("StateMachine", "Sequence", "Concurrence", "Iterator"),
        *("ScriptedState", "CallbacksState", "ConditionalOutcomeState", "SleepState"),
        *("asked", "not asked", "ended", "behaviour", "missing-key", "no-items"),
        *("join all", "join any", "same outcome", "items", "items by key"),
    }
