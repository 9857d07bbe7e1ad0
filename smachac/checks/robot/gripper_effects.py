"""Effects of states on a gripper and on the pose of the tool."""

from __future__ import annotations

from typing import Literal

from smachac.ir.leaf import variable_of
from smachac.ir.nodes import Leaf, Node

MOST_VISITS = 200_000
"""The most events that the searches of one machine visit; beyond them nothing more is found."""


Effect = Literal["open", "close", "unknown"]


def grip_of(leaf: Leaf) -> Effect | None:
    """What a state does to its gripper, by the value of its variable."""
    held = variable_of(leaf, "grip")
    if held is None:
        return None
    return (
        "open"
        if held.value.data == "open"
        else "close"
        if held.value.data == "close"
        else "unknown"
    )


def keeps_gripper(leaf: Leaf) -> bool:
    """Whether a state surely leaves the gripper as it is."""
    return bool(leaf.built_in) and not leaf.stand_in and not leaf.open


def comes_to_body(node: Node) -> bool:
    """Whether a state moves the tool to the pose of a body."""
    if not isinstance(node, Leaf) or not node.claims:
        return False
    held = variable_of(node, "grasp")
    offset = any(
        key.role == "goal_offset" and any(remap.key == key.name for remap in node.remaps)
        for key in node.inputs
    )
    return held is not None and held.value.data is True and not offset
