"""Values that a script gives to messages of ROS, compared with the types of their fields."""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import islice, permutations
from typing import NamedTuple

from smachac.analysis.message_code import nested_messages
from smachac.diagnostics.spelling import in_quotes, is_plain
from smachac.diagnostics.wording import both
from smachac.ir.message_types import (
    FLOATS,
    INTEGERS,
    TEXTS,
    Definitions,
    FieldType,
    Message,
    MessageConstant,
)
from smachac.ir.nodes import Data, Expression, Struct, is_number

BYTES = frozenset(["uint8", "byte", "char"])
"""The types of numbers whose lists can be written as text."""


EXAMPLES: Mapping[str, str] = {
    **dict.fromkeys(INTEGERS, "3"),
    **dict.fromkeys(FLOATS, "1.5"),
    **dict.fromkeys(TEXTS, "text"),
    "bool": "true",
}
"""A value of each primitive type, as a script writes it."""

UNITS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0, "sec": 1.0, "min": 60.0, "h": 3600.0}
"""The seconds of each unit of time."""

MOST_ORDERED = 5
"""Limit on the values of a list whose other orders are tried."""

MOST_CONSTANTS = 8
"""Limit on the constants of a message that a help names."""

LARGEST_FLOATS = {"float32": (2 - 2**-23) * 2.0**127, "float64": sys.float_info.max}
"""The largest finite number of each type."""

_TIME = re.compile(r"(\d{1,9}(?:\.\d{1,9})?)\s*([a-z]+)")
_SECONDS = ("/Time", "/Duration")


class ValueFault(NamedTuple):
    """A fault in a value: the names of the fields that lead to it, and the message that has it.

    `wanted` is the type of the last field; None: the message does not have that field.
    """

    names: tuple[str, ...]
    message: Message
    wanted: FieldType | None
    value: Data = None


def value_faults(
    data: Data, message: Message, found: Definitions, names: tuple[str, ...] = ()
) -> Iterator[ValueFault]:
    """The faults of a value for a message: a mapping of its fields, or a list of all of them."""
    if isinstance(data, Struct):
        pairs = data.entries
    elif isinstance(data, tuple) and len(data) == len(message.fields):
        pairs = tuple((field.name, item) for field, item in zip(message.fields, data, strict=True))
    else:
        return
    for name, item in pairs:
        known = message.field(name)
        if known is None:
            yield ValueFault((*names, name), message, None)
        elif not _fits(item, known.type):
            yield ValueFault((*names, name), message, known.type, item)
        else:
            yield from _nested_faults(item, known.type, found, (*names, name))


def _nested_faults(
    data: Data, wanted: FieldType, found: Definitions, names: tuple[str, ...]
) -> Iterator[ValueFault]:
    """The faults of the messages in a field. Of several definitions one may fit."""
    items = data if wanted.array and isinstance(data, tuple) else (data,)
    for item in items:
        messages = nested_messages([FieldType(name=wanted.name)], found)
        faults = [list(value_faults(item, message, found, names)) for message in messages]
        if faults and all(faults):
            yield from faults[0]


def _fits(data: Data, wanted: FieldType) -> bool:
    """Whether a field can accept a value; code and nothing are not judged."""
    if data is None or isinstance(data, Expression) or (isinstance(data, str) and "`" in data):
        return True
    if not wanted.array:
        return _fits_item(data, wanted)
    if isinstance(data, str):
        return wanted.name in BYTES
    if not isinstance(data, tuple):
        return False
    limit = wanted.size if wanted.size is not None else wanted.most
    if limit is not None and len(data) > limit:
        return False
    if wanted.size is not None and len(data) < wanted.size:
        return False
    return all(_fits(value, item_type(wanted)) for value in data)


def item_type(wanted: FieldType) -> FieldType:
    """The type of the values of a list."""
    return FieldType(name=wanted.name, longest=wanted.longest)


def _fits_item(data: Data, wanted: FieldType) -> bool:
    """Whether a value fits a type that is no list. A truth value can be written as 0 or 1; a number
    of seconds can be a time, and a list can be a message."""
    name = wanted.name
    if name == "bool":
        return isinstance(data, bool) or (isinstance(data, int) and data in (0, 1))
    if name in INTEGERS:
        least, most = _bounds(name)
        return isinstance(data, int) and not isinstance(data, bool) and least <= data <= most
    if name in FLOATS:
        is_infinity_or_nan = isinstance(data, float) and not math.isfinite(data)
        return is_number(data) and (abs(data) <= LARGEST_FLOATS[name] or is_infinity_or_nan)
    if name in TEXTS:
        return isinstance(data, str) and (wanted.longest is None or len(data) <= wanted.longest)
    if "/" not in name or name.endswith(_SECONDS):
        return not isinstance(data, bool | str)
    return isinstance(data, Struct | tuple)


def is_time(name: str) -> bool:
    """Whether values of a type are times or durations, which can be numbers of seconds."""
    return name in ("time", "duration") or name.endswith(_SECONDS)


def _bounds(name: str) -> tuple[int, int]:
    """The smallest and the largest number of a type. Versions of ROS differ in `byte`, `char`."""
    if name in ("byte", "char"):
        return -128, 255
    bits = int(name.lstrip("uint"))
    return (0, 2**bits - 1) if name.startswith("u") else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)


SWITCHES = {"on": "true", "yes": "true", "off": "false", "no": "false"}
"""Words for the values of a `bool`, which are texts in YAML 1.2."""


def value_help(value: Data, wanted: FieldType) -> str:
    """The help for a value that does not fit a field."""
    if is_time(wanted.name):
        found = _TIME.fullmatch(value) if isinstance(value, str) and not wanted.array else None
        if found is not None and found[2] in UNITS:
            seconds = f"{float(found[1]) * UNITS[found[2]]:g}"
            return f"write the seconds as a number: `{seconds}`"
    meant = SWITCHES.get(value.lower()) if isinstance(value, str) else None
    if wanted.name == "bool" and not wanted.array and meant is not None:
        return f"write `{meant}`: in YAML 1.2, `{value}` is a text"
    if isinstance(value, tuple) and wanted.most is not None and len(value) > wanted.most:
        return f"shorten the list: it has {len(value)} values, the limit is {wanted.most}"
    if isinstance(value, str) and wanted.longest is not None and not wanted.array:
        return f"shorten the text: it has {len(value)} characters, the limit is {wanted.longest}"
    item = item_type(wanted)
    if wanted.array and wanted.size in (None, 1) and value is not None and _fits(value, item):
        text = written(value)
        if text:
            return f"write a list: `[{text}]`"
    return f"write a value of the type `{wanted}`{an_example(wanted)}"


def an_example(wanted: FieldType) -> str:
    """A value of a primitive type, as the end of a help line; empty for a message or a list."""
    if wanted.array or wanted.name not in EXAMPLES:
        return ""
    return f", such as `{EXAMPLES[wanted.name]}`"


def constants_for(name: str, type: FieldType, messages: Iterable[Message]) -> list[MessageConstant]:
    """The constants of the type of a field in its messages: those whose names begin with the name
    of the field, if there are some."""
    known = [
        constant
        for message in messages
        for constant in message.constants
        if constant.type.name == type.name and not type.array
    ]
    own = [constant for constant in known if constant.name.lower().startswith(name.lower())]
    return own or known


def named_constants(constants: Sequence[MessageConstant]) -> str:
    """The names of constants with their values, as in the definition."""
    first = ", ".join(
        f"`{constant.name}={constant.value}`" for constant in constants[:MOST_CONSTANTS]
    )
    return f"{first}, ..." if len(constants) > MOST_CONSTANTS else first


def written(value: Data) -> str:
    """A text, a number or a truth value as a list of a script has it; empty for other values."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return value if is_plain(value) else in_quotes(value)
    return repr(value) if is_number(value) else ""


def written_mapping(entries: Iterable[tuple[str, Data]]) -> str:
    """A mapping of fields as a script has it, with `...` for values that are not short."""
    parts = []
    for name, value in entries:
        text = written_mapping(value.entries) if isinstance(value, Struct) else written(value)
        parts.append(f"{name}: {text or '...'}")
    return f"{{{', '.join(parts)}}}"


def with_levels(
    data: Data, faults: Iterable[ValueFault], found: Definitions
) -> Iterator[tuple[ValueFault, str | None]]:
    """The faults of a value, those of fields that belong to a field of the message with a help:
    `x` of a Twist is one of its field `linear`. Of several fields that belong to the same one, only
    the first is a fault. The first field of a message that the value does not set is meant."""
    levels: dict[tuple[str, ...], list[ValueFault]] = {}
    every = list(faults)
    for fault in every:
        if fault.wanted is None:
            levels.setdefault(fault.names[:-1], []).append(fault)
    for fault in every:
        level = levels[fault.names[:-1]] if fault.wanted is None else [fault]
        help = _level_help(data, level, found) if fault.wanted is None else None
        if help is None or fault is level[0]:
            yield fault, help


def _level_help(data: Data, level: Sequence[ValueFault], found: Definitions) -> str | None:
    """The help for unknown fields of one message that are fields of one of its own fields."""
    *first, _ = level[0].names
    for step in first:
        data = dict(data.entries).get(step) if isinstance(data, Struct) else None
    if not isinstance(data, Struct):
        return None
    given = dict(data.entries)
    names = [fault.names[-1] for fault in level]
    moved = Struct(entries=tuple((name, given.get(name)) for name in names))
    for field in level[0].message.fields:
        if field.name not in given and not field.type.array:
            inner = nested_messages([field.type], found)
            if inner and not any([*value_faults(moved, message, found)] for message in inner):
                help = f"write `{field.name}: {written_mapping(moved.entries)}`"
                return f"{help} in place of {both(names)}" if len(names) > 1 else help
    return None


def in_field_order(data: Data, message: Message) -> str | None:
    """A list of the values of all fields in the only order in which they fit; None if there are
    several, or none."""
    if not isinstance(data, tuple) or not 2 <= len(data) <= MOST_ORDERED:
        return None
    if len(data) != len(message.fields) or not all(written(value) for value in data):
        return None
    types = [field.type for field in message.fields]
    fitting = (
        order
        for order in permutations(data)
        if all(_fits(item, type_) for item, type_ in zip(order, types, strict=True))
    )
    found = list(islice(fitting, 2))
    return f"[{', '.join(written(value) for value in found[0])}]" if len(found) == 1 else None
