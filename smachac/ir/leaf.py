"""Variables and default outcomes of the built-in state types."""

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
"""The state types that first call the functions of `callbacks`, each for the key of its name."""


def default_outcome(leaf: Leaf) -> str:
    """The declared outcome by which a state usually ends: a good one, else the first."""
    declared = own_outcomes(leaf) or tuple(edge.outcome for edge in leaf.transitions)
    good = [name for name in declared if name in GOOD_OUTCOMES]
    return [*good, *declared, GOOD_OUTCOMES[0]][0]


def variable(leaf: Leaf, name: str) -> Data:
    """What the script sets a variable of a leaf to, or None."""
    for candidate in leaf.variables:
        if candidate.name == name:
            return candidate.value.data
    return None
