"""Origins of types in messages: the value of a key, and the state that provides it."""

from __future__ import annotations

from smachac.analysis.type_inference import Cell, TypeFlow
from smachac.checks.findings.type_words import in_words
from smachac.ir import nodes


def cell_owner(cell: Cell) -> str:
    """The state that has a key or variable, in a message."""
    return f"`{cell.node.name}`" if cell.node is not None else "the base"


def written(flow: TypeFlow) -> str:
    """A value and its origin, as part of a message."""
    cell = flow.cell
    if flow.how == "declared":
        match cell.role:
            case "output":
                return f"{cell_owner(cell)} writes `{cell.key}` as `{flow.type}`"
            case "scope" if is_promised(cell):
                return f"the caller of {cell_owner(cell)} provides `{cell.key}` as `{flow.type}`"
            case "scope":
                return f"{cell_owner(cell)} declares `{cell.key}` as `{flow.type}`"
    what = in_words(flow.type)
    if flow.how == "value" and isinstance(flow.value, bool | float):
        import json

        return f"`{cell.key}` is `{json.dumps(flow.value)}`"
    if flow.how == "computed" and isinstance(cell.node, nodes.Iterator):
        return f"{cell_owner(cell)} provides `{cell.key}` as {what}"
    if flow.how == "computed":
        return f"{cell_owner(cell)} computes `{cell.key}` as {what}"
    return f"`{cell.key}` is {what}"


def is_promised(cell: Cell) -> bool:
    """Whether a key is an input of the outermost machine: its caller provides the value."""
    node = cell.node
    outermost = node is not None and cell.path == node.name
    return outermost and node is not None and any(key.name == cell.key for key in node.inputs)
