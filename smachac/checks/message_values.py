"""Values that a script gives to messages of ROS, compared with the types of their fields."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from smachac.analysis.message_code import nested_messages
from smachac.ir.message_types import FLOATS, INTEGERS, TEXTS, Definitions, FieldType, Message
from smachac.ir.nodes import Data, Expression, Struct, is_number

BYTES = frozenset(["uint8", "byte", "char"])
"""The types of numbers whose lists can be written as text."""


class ValueFault(NamedTuple):
    """A fault in a value: the names of the fields that lead to it, and the message that has it.

    `wanted` is the type of the last field; None: the message does not have that field.
    """

    names: tuple[str, ...]
    message: Message
    wanted: FieldType | None


def value_faults(
    data: Data, message: Message, found: Definitions, names: tuple[str, ...] = ()
) -> Iterator[ValueFault]:
    """The faults of a value for a message: a mapping of its fields, or a list of all of them."""
    if isinstance(data, Struct):
        pairs = data.entries
    elif isinstance(data, tuple) and len(data) == len(message.fields):
        pairs = tuple((each.name, item) for each, item in zip(message.fields, data, strict=True))
    else:
        return
    for name, item in pairs:
        known = message.field(name)
        if known is None:
            yield ValueFault((*names, name), message, None)
        elif not _fits(item, known.type):
            yield ValueFault((*names, name), message, known.type)
        else:
            yield from _nested_faults(item, known.type, found, (*names, name))


def _nested_faults(
    data: Data, wanted: FieldType, found: Definitions, names: tuple[str, ...]
) -> Iterator[ValueFault]:
    """The faults of the messages in a field. Of several definitions one may fit."""
    items = data if wanted.array and isinstance(data, tuple) else (data,)
    for item in items:
        messages = nested_messages([FieldType(name=wanted.name)], found)
        faults = [list(value_faults(item, each, found, names)) for each in messages]
        if faults and all(faults):
            yield from faults[0]


def _fits(data: Data, wanted: FieldType) -> bool:
    """Whether a field can accept a value; code and nothing are not judged."""
    if data is None or isinstance(data, Expression) or (isinstance(data, str) and "`" in data):
        return True
    if not wanted.array:
        return _fits_item(data, wanted.name)
    if isinstance(data, str):
        return wanted.name in BYTES
    if not isinstance(data, tuple):
        return False
    limit = wanted.size if wanted.size is not None else wanted.most
    if limit is not None and len(data) > limit:
        return False
    if wanted.size is not None and len(data) < wanted.size:
        return False
    return all(_fits(each, FieldType(name=wanted.name)) for each in data)


def _fits_item(data: Data, name: str) -> bool:
    """Whether a value fits a type that is no list. A truth value can be written as 0 or 1; a number
    of seconds can be a time, and a list can be a message."""
    if name == "bool":
        return isinstance(data, bool) or (isinstance(data, int) and data in (0, 1))
    if name in INTEGERS:
        least, most = _bounds(name)
        return isinstance(data, int) and not isinstance(data, bool) and least <= data <= most
    if name in FLOATS:
        return is_number(data)
    if name in TEXTS:
        return isinstance(data, str)
    if "/" not in name or name.endswith(("/Time", "/Duration")):
        return not isinstance(data, bool | str)
    return isinstance(data, Struct | tuple)


def _bounds(name: str) -> tuple[int, int]:
    """The smallest and the largest number of a type. Versions of ROS differ in `byte`, `char`."""
    if name in ("byte", "char"):
        return -128, 255
    bits = int(name.lstrip("uint"))
    return (0, 2**bits - 1) if name.startswith("u") else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
