"""Keys of branches of concurrences."""

from __future__ import annotations

from smachac.analysis.accesses import callback_names
from smachac.ir.leaf import functions
from smachac.ir.nodes import Leaf, Node
from smachac.ir.traversal import outputs_to


def is_never_set(writer: Node, key: str) -> bool:
    """Whether a state declares an output that its callbacks set, and none of them sets it."""
    if not isinstance(writer, Leaf) or not functions(writer, "callbacks"):
        return False
    own = own_key(writer, key)
    results = {output.name for output in writer.outputs if output.role == "result"}
    return own in results - callback_names(writer)


def own_key(writer: Node, key: str) -> str:
    """The name that a branch has for a key that it writes."""
    return next((output.name for output in outputs_to(writer, key)), key)
