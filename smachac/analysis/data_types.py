"""Types of the values of a script. Those of literals are exact (see type_lattice.py)."""

from __future__ import annotations

from smachac.analysis.type_lattice import DEEPEST, mapping_type, tuple_type, type_of_literal
from smachac.diagnostics.source import assert_never
from smachac.ir.nodes import Data, Expression, Struct
from smachac.ir.script_code import script_code
from smachac.ir.types import ANY, Type


def type_of_data(data: Data, depth: int = DEEPEST) -> Type:
    """The type of a value of the script."""
    match data:
        case bool() | int() | float() | str() | None:
            return type_of_literal(data)
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
