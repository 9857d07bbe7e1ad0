"""Requests to stop in generated programs, which SMACH does not always pass on (docs/semantics.md,
Preemption)."""

from __future__ import annotations

from smachac.ir.nodes import Concurrence, Leaf, Machine
from smachac.ir.nodes import Iterator as IteratorNode
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import containers


def passes_requests_on(machine: Machine) -> bool:
    """Whether a program has to pass on requests to stop that SMACH loses.

    SMACH does not pass on one that comes before an Iterator or a Concurrence runs (rules P9, P10),
    and a second one (rule P2). In a container in which no state answers a request, it makes no
    difference who receives it.
    """
    answering: set[str] = set()
    for path, node in reversed(list(containers(machine.root))):
        if isinstance(node, Concurrence | IteratorNode):
            return True
        if any(f"{path}/{child.name}" in answering for child in node.children):
            return True
        if any(_answers(child, machine) for child in node.children):
            answering.add(path)
    return False


def _answers(node: object, machine: Machine) -> bool:
    """Whether a leaf may answer a request to stop: the code of the user may, a built-in state does
    if its type has the outcome for it."""
    if not isinstance(node, Leaf):
        return False
    type_ = machine.state_types.get(node.type)
    declared = type_.outcomes if type_ is not None else ()
    names = [outcome.name for outcome in (*node.outcomes, *declared)]
    return not node.built_in or PREEMPTED in names
