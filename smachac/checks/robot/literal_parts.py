"""Parts of literals that a robot reads: numbers, names and frames; and the roles of their keys."""

from __future__ import annotations

import math
from collections.abc import Iterator

from smachac.analysis.type_inference import Cell, TypeFlow
from smachac.analysis.type_lattice import inside, present, unit_of
from smachac.checks.findings.value_places import WHOLE, Part
from smachac.ir.nodes import Data, Leaf, Struct


def moves_arm(flow: TypeFlow) -> bool:
    """Whether a literal holds angles, in a list or by joint name, that a state with a claim on an
    arm reads."""
    node, wanted = flow.cell.node, present(flow.cell.declared)
    if flow.cell.role != "input" or not isinstance(node, Leaf):
        return False
    held = any(claim == "arm" or claim.startswith("arm.") for claim in node.claims)
    if not held or unit_of(inside(wanted)) != "rad":
        return False
    shape = {"list": tuple, "array": tuple, "dict": Struct}.get(wanted.name)
    return shape is not None and isinstance(flow.value, shape)


def as_float(data: Data) -> float:
    """A number as a float; one that is too large for it is infinite."""
    try:
        return float(data) if isinstance(data, int | float) else math.nan
    except OverflowError:
        return math.inf


def frame_of(pose: Data) -> str | None:
    """The frame in a literal that is read as a PoseStamped."""
    held = dict(pose.entries) if isinstance(pose, Struct) else {}
    header = held.get("header")
    inner = dict(header.entries) if isinstance(header, Struct) else held
    name = inner.get("frame_id")
    return name if isinstance(name, str) else None


def role_of(cell: Cell) -> str:
    """The role of the key or variable of a cell."""
    if not isinstance(cell.node, Leaf):
        return ""
    held = cell.node.inputs if cell.role == "input" else cell.node.variables
    return next((item.role for item in held if item.name == cell.key), "")


def names_in(data: Data) -> Iterator[str]:
    """The names in a literal: itself, the items of a list, the keys of a mapping."""
    if isinstance(data, str):
        yield data
    elif isinstance(data, tuple):
        yield from (item for item in data if isinstance(item, str))
    elif isinstance(data, Struct):
        yield from (name for name, _ in data.entries)


def part_named(data: Data, name: str) -> Part:
    """The part of a literal that is a name (`names_in`)."""
    if isinstance(data, tuple):
        return Part((data.index(name),))
    return Part((name,), key=True) if isinstance(data, Struct) else WHOLE
