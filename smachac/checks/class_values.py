"""Values that the Python class of a state type writes, against the types in its interface."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from smachac.analysis.context import Context
from smachac.analysis.expression_types import type_of_data
from smachac.analysis.type_lattice import BOOL, FLOAT, STR, is_open, misfit, present, widened
from smachac.checks.class_code import leaves_by_type
from smachac.checks.messages import other_place
from smachac.checks.type_words import HELP, example, in_words
from smachac.diagnostics.diagnostic import Finding
from smachac.ir.nodes import Data, Struct
from smachac.ir.types import Type

MADE = {"str": STR, "repr": STR, "float": FLOAT, "bool": BOOL, "len": Type("int")}
"""The types that functions of Python return."""


def wrong_writes(context: Context) -> Iterator[Finding]:
    """The literals that a class writes to an output key whose type they do not fit (SM304)."""
    for path, leaf, facts in leaves_by_type(context, declared=True):
        type_ = context.machine.state_types.get(leaf.type)
        if type_ is None or type_.built_in or type_.open:
            continue
        keys = {key.name: key for key in type_.output_keys}
        for name, written in facts.values:
            key = keys.get(name)
            given = type_of_code(written.text) if key is not None else None
            if key is None or given is None or misfit(given, key.type) is None:
                continue
            if misfit(given, Type("optional", (key.type,))) is None and given.name == "none":
                continue  # a key that is cleared
            found = example(key.type)
            such = f", such as `{found}`" if found else ""
            yield Finding(
                span=written.span,
                message=f"`{leaf.type}` writes {in_words(given)} to `{name}`, but its interface"
                f" declares `{name}` as `{key.type}`",
                arguments=(name, str(widened(given)), str(key.type), "class"),
                help=HELP.get(present(key.type).name)
                or f"write a value of the type `{key.type}`{such}, or correct the interface",
                related=(
                    *other_place(key.span, f"the interface declares `{name}`"),
                    *other_place(leaf.span, f"`{leaf.name}` is of the type `{leaf.type}`"),
                ),
                node=path,
            )


def type_of_code(text: str) -> Type | None:
    """The type of an expression of Python that is a literal, or obvious without its names; None
    for any other."""
    try:
        node = ast.parse(f"({text})", mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None
    match node:
        case ast.JoinedStr():
            return STR
        case ast.UnaryOp(op=ast.Not()):
            return BOOL
        case ast.Call(func=ast.Name(id=name)) if name in MADE:
            return MADE[name]
    try:
        data = _data(ast.literal_eval(node))
    except (ValueError, TypeError, RecursionError, MemoryError):
        return None
    type_ = type_of_data(data)
    return None if is_open(type_) else type_


def _data(value: object) -> Data:
    """A literal of Python as data of a script. Raises ValueError if a script cannot have it."""
    match value:
        case None | bool() | int() | float() | str():
            return value
        case list() | tuple():
            return tuple([_data(each) for each in value])
        case dict() if all(isinstance(key, str) for key in value):
            return Struct(entries=tuple([(key, _data(each)) for key, each in value.items()]))
    raise ValueError(value)
