"""The modules of Python's library that the evaluator models."""

from __future__ import annotations

from typing import Any

from smachac.diagnostics.source import Span
from smachac.pysource.machines.framework import Run, classes
from smachac.pysource.machines.values import (
    NONE,
    UNKNOWN,
    Arguments,
    Const,
    DictValue,
    Instance,
    Interpreter,
    LibraryClass,
    ListValue,
    Native,
    TupleValue,
    Value,
    sequence,
)


def _from_keys(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    names, value = sequence(arguments.get(0, "iterable")), arguments.get(1, "value", NONE)
    if names is None or not all(isinstance(name, Const) for name in names):
        return DictValue({"items": UNKNOWN}, span)
    pairs = {name.value: (name, value) for name in names if isinstance(name, Const)}
    return DictValue({"items": pairs}, span)


METHODS: dict[str, dict[str, Run]] = {"builtins.dict": {"fromkeys": _from_keys}}
"""The methods of classes of Python."""


def _partial(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    if not arguments.positional:
        return UNKNOWN
    function, more = arguments.positional[0], arguments.without_first()
    return evaluator.partial(function, more)


def _copy(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    match arguments.get(0, "x", UNKNOWN):
        case ListValue() as value:
            return ListValue({"items": value.items}, value.span, value.kind)
        case DictValue() as value:
            return DictValue({"items": value.items}, value.span, value.repeated)
        case Const() | TupleValue() as plain:
            return plain
    return UNKNOWN


def _same(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    return arguments.get(0, "x", UNKNOWN) or UNKNOWN


def _wraps(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    return Native("wraps", _same)


def _named_tuple(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    """`collections.namedtuple`: a function that makes objects with these attributes."""
    fields = arguments.get(1, "field_names", UNKNOWN)
    names: list[str] | None = None
    if isinstance(fields, Const) and isinstance(fields.value, str):
        names = fields.value.replace(",", " ").split()
    elif (items := sequence(fields)) is not None:
        names = [str(item.value) for item in items if isinstance(item, Const)]

    def make(evaluator: Interpreter, given: Arguments, span: Span | None) -> Value:
        if names is None or given.open:
            return UNKNOWN
        slots: dict[Any, Any] = {
            name: given.get(at, name, UNKNOWN) for at, name in enumerate(names)
        }
        return Instance(LibraryClass("builtins.object"), slots, span)

    return Native("namedtuple", make)


MODULES: dict[str, dict[str, Value]] = {
    "functools": {"partial": Native("partial", _partial), "wraps": Native("wraps", _wraps)},
    "copy": {"copy": Native("copy", _copy), "deepcopy": Native("copy", _copy)},
    "enum": {
        **classes("enum", "Enum IntEnum StrEnum Flag IntFlag"),
        "unique": Native("unique", _same),
        "auto": Native("auto", lambda e, a, s: UNKNOWN),
    },
    "collections": {
        **classes("collections", "OrderedDict defaultdict deque"),
        "namedtuple": Native("namedtuple", _named_tuple),
    },
    "sys": {"version_info": TupleValue(tuple(Const(number) for number in (3, 12, 0)))},
}
"""The modules, each with the names in it."""

UNREAD = ("dataclasses", "typing", "__future__")
"""Modules whose values are not known, and which are no packages that are missing."""
