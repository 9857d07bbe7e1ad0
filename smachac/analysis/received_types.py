"""The types of the keys that receive fields of a message of ROS, from the definition of it."""

from __future__ import annotations

from collections.abc import Mapping

from smachac.ir.leaf import type_text, variable_of
from smachac.ir.message_types import DefinitionKind, Definitions, userdata_type
from smachac.ir.nodes import Leaf, VariableRole
from smachac.ir.types import Type

SOURCES: tuple[tuple[VariableRole, VariableRole], ...] = (
    ("action_type", "result"),
    ("service_type", "response"),
)
"""The roles of the variable that names a type, and of the one that lists keys for its fields."""

SCALARS = frozenset(["bool", "int", "float", "str"])
"""The types whose values are the same in every version of ROS."""


def received_types(leaf: Leaf, found: Definitions) -> Mapping[str, Type]:
    """The types of the output keys that receive fields of the result of an action or the response
    of a service: numbers, texts and truth values. None where a function of the script gets the
    message too, because it can set the key."""
    types: dict[str, Type] = {}
    for type_role, role in SOURCES:
        named, slots = variable_of(leaf, type_role), variable_of(leaf, role)
        if named is None or slots is None or not isinstance(slots.value.data, tuple):
            continue
        if any(
            variable.name == f"{role}_cb" and variable.value.data is not None
            for variable in leaf.variables
        ):
            continue
        kind: DefinitionKind = "action" if type_role == "action_type" else "srv"
        for name in slots.value.data:
            fields = [
                definition.part(role).field(name)
                for definition in found.get((kind, type_text(named)), ())
                if isinstance(name, str)
            ]
            held = {userdata_type(field.type) for field in fields if field is not None}
            if len(held) == 1 and None not in fields and {type_.name for type_ in held} <= SCALARS:
                types[str(name)] = held.pop()
    return types
