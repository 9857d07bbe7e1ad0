"""What SMACHA gave to the templates of its users: plain data under the names they expect."""

from __future__ import annotations

from smachac.ir.nodes import Container, Data, Expression, Leaf, Struct
from smachac.ir.walk import own_outcomes


def plain(data: Data) -> object:
    """A value as Python data; an expression is its text."""
    match data:
        case Expression(text=text):
            return text
        case Struct(entries=entries):
            return {key: plain(value) for key, value in entries}
        case tuple():
            return [plain(item) for item in data]
    return data


def state_variables(leaf: Leaf, parent: Container, parent_sm_name: str) -> dict[str, object]:
    """The variables of a leaf's template: its own, and where it stands."""
    variables: dict[str, object] = {
        variable.name: plain(variable.value.data) for variable in leaf.variables
    }
    optional: dict[str, object] = {
        "outcomes": list(own_outcomes(leaf)),
        "input_keys": [key.name for key in leaf.inputs],
        "output_keys": [key.name for key in leaf.outputs],
        "transitions": {edge.outcome: edge.target for edge in leaf.transitions},
        "remapping": {remap.key: remap.to for remap in leaf.remaps},
    }
    variables.update({name: value for name, value in optional.items() if value})
    return variables | {
        "name": leaf.name,
        "class_name": leaf.type,
        "parent_name": parent.name,
        "parent_sm_name": parent_sm_name,
        "parent_type": type(parent).__name__,
        "parent_template": parent.type,
    }
