"""Machines of the bundled SMACH runtime, built from the IR, and their traces."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.scenario import Scenario, ScenarioStep, scenario_behaviour
from smachac.interpreter.userdata import python_data
from smachac.ir import nodes
from smachac.ir.nodes import Concurrence, Iterator, Leaf, Machine, Node, StateMachine
from smachac.ir.traversal import outcome_names
from smachac.runtime import smach
from smachac.runtime.tracing.trace import attach, script
from smachac.runtime.tracing.writer import Event
from tests.support.ir_machines import ran

Steps = Mapping[str, Sequence[tuple[str, Mapping[str, object]]]]
"""Rows of (outcome, keys to write) by path."""


class Idle(smach.State):
    """A leaf that must be told what to do."""

    def execute(self, ud: Any, /) -> str | None:
        raise RuntimeError("nobody said what to do")


def _interface(node: Node) -> dict[str, Any]:
    return {
        "input_keys": [key.name for key in node.inputs],
        "output_keys": [key.name for key in node.outputs],
    }


def built(machine: Machine) -> smach.StateMachine:
    """The machine, ready to run."""
    root = _state(machine.root)
    assert isinstance(root, smach.StateMachine)
    return root


def _state(node: Node) -> Any:
    outcomes = list(outcome_names(node))
    if isinstance(node, Leaf):
        return Idle(outcomes, **_interface(node))
    container: Any
    match node:
        case Concurrence():
            container = smach.Concurrence(
                outcomes,
                node.default_outcome,
                outcome_cb=lambda ended: _decided(node, ended),
                child_termination_cb=(lambda ended: True) if node.join == "any" else None,
                **_interface(node),
            )
        case Iterator():
            container = smach.Iterator(
                outcomes,
                it=python_data(node.items.data) if node.items else [],  # type: ignore[arg-type]
                it_label=node.item_key,
                exhausted_outcome=node.exhausted_outcome,
                **_interface(node),
            )
            if node.items_key:
                with container:
                    smach.Iterator.set_iteritems(
                        lambda: container.userdata[node.items_key], node.item_key
                    )
        case nodes.Sequence():
            container = smach.Sequence(outcomes, node.connector_outcome, **_interface(node))
        case nodes.StateMachine():
            container = smach.StateMachine(outcomes, **_interface(node))
    _fill(container, node)
    return container


def _fill(container: Any, node: nodes.Container) -> None:
    with container:
        for child in node.children:
            remapping = {remap.key: remap.to for remap in child.remaps}
            if isinstance(node, Concurrence):
                smach.Concurrence.add(child.name, _state(child), remapping)
            elif isinstance(node, Iterator):
                smach.Iterator.set_contained_state(
                    child.name,
                    _state(child),
                    loop_outcomes=list(node.loop_outcomes),
                    final_outcome_map=dict(node.final_map),
                )
            else:
                transitions = {edge.outcome: edge.target for edge in child.transitions}
                smach.StateMachine.add(child.name, _state(child), transitions, remapping)
    for preset in node.userdata:
        container.userdata[preset.key] = python_data(preset.value.data)
    if isinstance(node, nodes.StateMachine | nodes.Sequence) and node.initial:
        container.set_initial_state([node.initial])


def _decided(node: Concurrence, ended: Mapping[str, str | None]) -> str | None:
    """What the rules say, the one with most conditions winning; None if none holds."""
    holding = [
        rule
        for rule in node.rules
        if all(ended[condition.child] == condition.outcome for condition in rule.when)
    ]
    return max(reversed(holding), key=lambda rule: len(rule.when)).outcome if holding else None


def traced(root: StateMachine, steps: Steps, **options: Any) -> tuple[Any, list[Event]]:
    """The outcome or exception, and the events, of the machine built with the runtime."""
    made = built(Machine(root=root))
    events: list[Event] = []
    script(made, root.name, steps)
    attach(made, root.name, events.append, **options)
    try:
        return made.execute(), events
    except Exception as error:
        return error, events


def interpreted(root: StateMachine, steps: Steps) -> list[Event]:
    rows = {
        path: tuple(
            ScenarioStep(outcome=outcome, writes=tuple(writes.items())) for outcome, writes in row
        )
        for path, row in steps.items()
    }
    given_machine = Machine(root=root)
    return ran(root, scenario_behaviour(Scenario(steps=rows), given_machine, builtin_behaviour()))[
        1
    ]
