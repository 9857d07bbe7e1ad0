"""Keys of states that read messages: the key with the type, and keys named after fields."""

from __future__ import annotations

import re
from collections.abc import Set as AbstractSet

from smachac.analysis.message_code import leaf_definitions
from smachac.ir.leaf import key_names
from smachac.ir.message_types import PARTS, Definitions
from smachac.ir.nodes import Container, Leaf, Node, Variable
from smachac.ir.traversal import outer_inputs, outer_outputs

TYPE_KEY = "msg_type"
"""The input key that gives the type of a message."""


_TYPE_NAME = re.compile(r"[a-z]\w*[/.](msg[/.])?[A-Z]\w*")
"""The name of a message type with its package: `std_msgs/Bool`."""


def lacks_type_key(node: Node) -> bool:
    """Whether a state reads a message, and not its type."""
    names = key_names(node.inputs, "message") if isinstance(node, Leaf) else ()
    return bool(names) and TYPE_KEY not in [key.name for key in node.inputs]


def suggested_type_key(container: Node | None) -> str | None:
    """The only key in the userdata of a container that holds the name of a message type and that
    none of its states reads."""
    if not isinstance(container, Container):
        return None
    held = [
        preset.key
        for preset in container.userdata
        if isinstance(preset.value.data, str) and _TYPE_NAME.fullmatch(preset.value.data)
    ]
    if not held:
        return None
    read = {key for child in container.children for key in outer_inputs(child)}
    unread = [key for key in held if key not in read.union(outer_outputs(container))]
    return unread[0] if len(unread) == 1 else None


def remapped_field(leaf: Leaf, held: Variable, names: AbstractSet[str]) -> str | None:
    """The field of a message that the remapping of a state has, and that its list of fields has
    under an unknown name; None if there is not exactly one of each. `names` are all fields."""
    listed_names = held.value.data
    if not leaf.remaps or not isinstance(listed_names, tuple):
        return None
    used = {name for name in listed_names if isinstance(name, str)}
    known = {key.name for key in (*leaf.inputs, *leaf.outputs)} - (used - names)
    found = [remap.key for remap in leaf.remaps if remap.key in names and remap.key not in known]
    return found[0] if len(found) == len(used - names) == 1 else None


def remapped_fields(leaf: Leaf, found: Definitions) -> set[str]:
    """The unknown keys in the remapping of a state for which SM512 has a finding: fields that its
    list has under another name."""
    fields: set[str] = set()
    for kind, definitions in leaf_definitions(leaf, found):
        for held in leaf.variables:
            if held.role in PARTS[kind]:
                parts = [definition.part(held.role) for definition in definitions]
                names = {field.name for part in parts for field in part.fields}
                field = remapped_field(leaf, held, names)
                fields.update([field] if field is not None else [])
    return fields
