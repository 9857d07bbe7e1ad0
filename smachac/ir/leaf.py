"""Leaves: the values of their variables, their default outcome, and the state types with
callbacks."""

from __future__ import annotations

from smachac.ir.nodes import Data, Leaf
from smachac.ir.outcome_names import GOOD_OUTCOMES
from smachac.ir.traversal import own_outcomes

CALLING = frozenset(
    [
        "CallbacksState",
        "DeleteFileState",
        "PublishMsgState",
        "PublishObserverMsgState",
        "RandomOutcomeState",
        "ReadTopicState",
        "RecordROSBagState",
        "TransformMsgState",
        "WriteCSVFileState",
    ]
)
"""The state types that call the functions of `callbacks` first, each for the key of its name."""


def default_outcome(leaf: Leaf) -> str:
    """The usual outcome of a leaf: the first declared one with the name of a success, else the
    first one."""
    declared = own_outcomes(leaf) or tuple(edge.outcome for edge in leaf.transitions)
    good = [name for name in declared if name in GOOD_OUTCOMES]
    return [*good, *declared, GOOD_OUTCOMES[0]][0]


def variable(leaf: Leaf, name: str) -> Data:
    """The value of a leaf's variable in the script; None if it has none."""
    for candidate in leaf.variables:
        if candidate.name == name:
            return candidate.value.data
    return None
