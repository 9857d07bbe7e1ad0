"""Keys that a branch of a concurrence writes for another branch (SM405)."""

from __future__ import annotations

from smachac.analysis.accesses import callback_names
from smachac.analysis.context import Context
from smachac.analysis.raced_outputs import raced_output
from smachac.ir.leaf import functions
from smachac.ir.nodes import Concurrence, Leaf, Node
from smachac.ir.traversal import outputs_to, remapping


def raced_keys(context: Context) -> set[tuple[str, str]]:
    """The keys that are unset because a branch of a concurrence writes the key of another branch
    (SM405), each with the path of the container that has it."""
    found = set[tuple[str, str]]()
    for path, container in context.containers:
        raced = None
        if isinstance(container, Concurrence):
            raced = raced_output(path, container, context.accesses)
        if raced is not None and not any(
            is_never_set(child, raced.key) for child in container.children
        ):
            outer = remapping(container)[raced.meant]
            found.add((path.rpartition("/")[0], outer))
    return found


def is_never_set(writer: Node, key: str) -> bool:
    """Whether a state declares an output that its callbacks set, and none of them sets it."""
    if not isinstance(writer, Leaf) or not functions(writer, "callbacks"):
        return False
    own = own_key(writer, key)
    results = {each.name for each in writer.outputs if each.role == "result"}
    return own in results - callback_names(writer)


def own_key(writer: Node, key: str) -> str:
    """The name that a branch has for a key that it writes."""
    return next((each.name for each in outputs_to(writer, key)), key)
