"""Values that the Python class of a state type writes, and parts of values that it reads, against
the types in its interface."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from smachac.analysis.context import Context
from smachac.analysis.expression_types import type_of_data
from smachac.analysis.type_lattice import (
    BOOL,
    FLOAT,
    STR,
    is_open,
    length_of,
    misfit,
    present,
    widened,
)
from smachac.checks.class_code import leaves_by_type
from smachac.checks.messages import other_place
from smachac.checks.type_words import HELP, example, in_words
from smachac.diagnostics.diagnostic import Finding, Severity
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


COORDINATES = {"x": 0, "y": 1, "z": 2, "w": 3}
"""The index in a list for the fields of a message with coordinates."""

FIELDS = frozenset([*COORDINATES, "position", "orientation", "pose", "data"])
"""Fields of messages that neither lists nor numbers have, whatever library they are from."""


def wrong_parts(context: Context) -> Iterator[Finding]:
    """The attributes and indexes of an input key that its type does not have (SM311)."""
    for path, leaf, facts in leaves_by_type(context, declared=True):
        type_ = context.machine.state_types.get(leaf.type)
        if type_ is None or type_.built_in or type_.open:
            continue
        keys = {key.name: key for key in type_.input_keys}
        for name, part, read in facts.parts:
            key = keys.get(name)
            fault = _wrong_part(key.type, part, read.text) if key is not None else None
            if key is None or fault is None:
                continue
            what, help = fault
            yield Finding(
                span=read.span,
                message=f"`{leaf.type}` reads `{read.text}`, but its interface declares `{name}` as"
                f" `{key.type}`, {what}",
                arguments=(name, str(part), str(key.type), "class"),
                help=help,
                related=(
                    *other_place(key.span, f"the interface declares `{name}`"),
                    *other_place(leaf.span, f"`{leaf.name}` is of the type `{leaf.type}`"),
                ),
                severity=Severity.WARNING,
                node=path,
            )


def _wrong_part(type_: Type, part: str | int, text: str) -> tuple[str, str] | None:
    """What is wrong with a part of a value of a type, and what to write."""
    if isinstance(part, str):
        if type_.name not in ("list", "array", "int", "float", "bool", "str") or part not in FIELDS:
            return None
        owner = text.removesuffix(f".{part}")
        help = f"correct the type of the key in the interface, or write `{owner}`"
        if type_.name in ("list", "array") and part in COORDINATES:
            help = f"write `{owner}[{COORDINATES[part]}]`, or correct the type in the interface"
        return f"which has no attribute `{part}`", help
    size = length_of(type_)
    if size is None or -size <= part < size:
        return None
    return (
        f"whose last index is {size - 1}",
        f"use an index from 0 to {size - 1}, or correct the type in the interface",
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
