"""Types of the values of a script. Those of literals are exact (see type_lattice.py)."""

from __future__ import annotations

from collections.abc import Iterable

from smachac.analysis.type_lattice import BOOL, FLOAT, NONE, joined, mapping, widened
from smachac.diagnostics.source import assert_never
from smachac.ir.nodes import Data, Expression, Struct
from smachac.ir.script_code import script_code
from smachac.ir.types import ANY, Type

LONGEST_TUPLE = 64
"""The longest list whose items have separate types; the items of a longer one have one type."""

DEEPEST = 12
"""Levels of one type; what is deeper is `any`."""


def type_of_data(data: Data, depth: int = DEEPEST) -> Type:
    """The type of a value of the script."""
    match data:
        case bool():
            return BOOL
        case int() | str():
            return Type("literal", (data,))
        case float():
            return FLOAT
        case None:
            return NONE
        case Expression(text=text):
            from smachac.analysis.expression_types import type_of

            tree = script_code(text).portable
            return ANY if tree is None else type_of(tree, {})
        case _ if depth == 0:
            return ANY
        case tuple():
            return tuple_type((type_of_data(item, depth - 1) for item in data), len(data))
        case Struct(entries=entries):
            return mapping_type((name, type_of_data(item, depth - 1)) for name, item in entries)
    return assert_never(data)


def tuple_type(of: Iterable[Type], size: int) -> Type:
    """The type of a list of so many items; those of a long list are not kept one by one."""
    if size <= LONGEST_TUPLE:
        return Type("tuple", tuple(of))
    return Type("array", (widened(joined(of)), size))


def mapping_type(of: Iterable[tuple[str, Type]]) -> Type:
    """The type of a mapping with these keys; those of a large mapping are not kept one by one."""
    found = dict(of)
    if len(found) <= LONGEST_TUPLE:
        return mapping(found.items())
    return Type("dict", (widened(joined(found.values())),))
