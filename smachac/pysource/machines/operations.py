"""Operations on known values, within bounds of size: numbers, texts and comparisons."""

from __future__ import annotations

import ast
import operator
import re
import string
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from smachac.diagnostics.source import Span
from smachac.pysource.machines.values import (
    UNKNOWN,
    Class,
    Const,
    LibraryClass,
    OneOf,
    OpenText,
    TupleValue,
    Unknown,
    Value,
    open_text,
)

LONGEST_TEXT, MOST_ITEMS, MOST_BITS = 100_000, 10_000, 1_000
"""The longest text, in characters, the most items of a collection, and the most bits of a number
that are known."""

ORDERS: Mapping[type[ast.cmpop], Callable[[Any, Any], object]] = {
    ast.Lt: operator.lt, ast.LtE: operator.le, ast.Gt: operator.gt, ast.GtE: operator.ge
}  # fmt: skip

_OPERATIONS: Mapping[type[ast.operator], Callable[[Any, Any], object]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Mod: operator.mod,
    ast.FloorDiv: operator.floordiv, ast.Div: operator.truediv, ast.BitAnd: operator.and_,
    ast.BitOr: operator.or_,
}  # fmt: skip

_WIDTH = re.compile(r"%[^a-zA-Z%]*(?:\d{3}|\*)")
"""A place of a text for `%` whose width can be large."""


_OTHER_PLACE = re.compile(r"%(?![sd%])")
"""A place of a text for `%` with more than a plain text or number."""


def same(left: Value, right: Value) -> bool | None:
    """Whether two values are equal; None: not known."""
    if isinstance(left, Const) and isinstance(right, Const):
        return left.value == right.value
    if isinstance(left, Unknown | OneOf) or isinstance(right, Unknown | OneOf):
        return None
    if left is right:
        return True
    classes = Class | LibraryClass
    if isinstance(left, classes) and isinstance(right, classes):
        return left == right
    none = isinstance(left, Const) and left.value is None
    if none or (isinstance(right, Const) and right.value is None):
        return False
    return None


def calculated(left: Const, op: ast.operator, right: Const, span: Span | None) -> Value:
    """The result of an operation on two numbers or two texts, or of a repeated text."""
    one, other = left.value, right.value
    run = _OPERATIONS.get(type(op))
    numbers = isinstance(one, int | float) and isinstance(other, int | float)
    texts = isinstance(one, str) and isinstance(other, str) and isinstance(op, ast.Add)
    if isinstance(one, str) and isinstance(other, int) and isinstance(op, ast.Mult):
        texts = len(one) * max(other, 0) <= LONGEST_TEXT
    if run is None or not (numbers or texts):
        return UNKNOWN
    try:
        found = run(one, other)
    except (TypeError, ValueError, ArithmeticError):
        return UNKNOWN
    return bounded(found, span)


def bounded(data: object, span: Span | None) -> Value:
    """A number or text, if it is not too large."""
    match data:
        case str():
            return Const(data, span) if len(data) <= LONGEST_TEXT else UNKNOWN
        case bool() | float():
            return Const(data, span)
        case int():
            return Const(data, span) if data.bit_length() <= MOST_BITS else UNKNOWN
    return UNKNOWN


def filled_in(text: str, right: Value, span: Span | None) -> Value:
    """A text that `%` fills in."""
    items = right.items if isinstance(right, TupleValue) else (right,)
    is_open = any(isinstance(item, OpenText) for item in items)
    if is_open:
        if _OTHER_PLACE.search(text):
            return UNKNOWN
        text = text.replace("%d", "%s")
    values = tuple(part for item in items if (part := _data(item)) is not None)
    size = len(text) + sum(len(str(value)) for value in values)
    if len(values) != len(items) or size > LONGEST_TEXT or _WIDTH.search(text):
        return UNKNOWN
    try:
        found = text % values
    except (TypeError, ValueError, OverflowError):
        return UNKNOWN
    return open_text(found) if is_open else bounded(found, span)


def _data(value: Value) -> object:
    """A number or text, also one with an open part; None: not known."""
    return value.text if isinstance(value, OpenText) else getattr(value, "value", None)


def formatted(parts: Iterable[Value], span: Span | None) -> Value:
    """The text of an f-string without formats."""
    texts: list[str] = []
    size, is_open = 0, False
    for part in parts:
        if not isinstance(part, Const | OpenText):
            return UNKNOWN
        is_open = is_open or isinstance(part, OpenText)
        texts.append(part.text if isinstance(part, OpenText) else str(part.value))
        size += len(texts[-1])
        if size > LONGEST_TEXT:
            return UNKNOWN
    whole = "".join(texts)
    return open_text(whole) if is_open else Const(whole, span)


def has_width(text: str) -> bool:
    """Whether `format` can make a long text of a short one. Raises ValueError for a wrong text."""
    specs = [spec or "" for _, _, spec, _ in string.Formatter().parse(text)]
    return any("{" in spec or re.search(r"\d{3}", spec) for spec in specs)
