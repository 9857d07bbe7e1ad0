"""Values of userdata for the view: copies of limited size, made in the thread of the machine."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from itertools import islice

LONGEST_TEXT = 400
"""The most characters of one text."""

MOST_PARTS = 100
"""The most parts of one value, with those of its parts."""

MOST_INNER = 20
"""The most items of a list inside another value."""

DEEPEST = 6
"""The most levels of one value."""

EXACT = 2**53
"""The first integer that is cut: a page has no greater ones."""


def shown_value(value: object) -> object:
    """A value as JSON, cut to a size that does not depend on the value's own.

    An ellipsis stands for what is left out, with its number where that is known. Objects that JSON
    does not have are shown by their fields, else by their type: `repr` may be slow.
    """
    kind = type(value)
    if kind is bool or (kind is int and -EXACT < value < EXACT):  # type: ignore[operator]
        return value
    return _copy(value, [MOST_PARTS], DEEPEST)


def _copy(value: object, budget: list[int], depth: int) -> object:
    budget[0] -= 1
    if value is None or isinstance(value, bool):
        return value
    if isinstance(value, int):
        return value if abs(value) < EXACT else _cut(str(value) if value < 10**300 else "<int>")
    if isinstance(value, float):
        return value if math.isfinite(value) else str(value)
    if isinstance(value, str):
        return _cut(value)
    if depth == 0:
        return "…"
    try:
        if isinstance(value, (bytes, bytearray, memoryview)):
            return f"<{len(value)} bytes>"
        if isinstance(value, Mapping):
            return _fields(value.items(), len(value), budget, depth)
        if isinstance(value, (list, tuple, set, frozenset)):
            return _items(value, budget, depth)
        return _object(value, budget, depth)
    except Exception:  # methods of the user's classes: a view must not stop a machine
        return f"<{type(value).__name__}>"


def _fields(
    pairs: Iterable[tuple[object, object]], number: int, budget: list[int], depth: int
) -> dict[str, object]:
    shown: dict[str, object] = {}
    for name, part in pairs:
        if budget[0] <= 0:
            shown["…"] = f"{number - len(shown)} more"
            break
        label = _cut(str(name)) if isinstance(name, (str, int)) else type(name).__name__
        shown[label] = _copy(part, budget, depth - 1)
    return shown


def _items(
    value: list[object] | tuple[object, ...] | set[object] | frozenset[object],
    budget: list[int],
    depth: int,
) -> list[object]:
    shown: list[object] = []
    for part in islice(value, MOST_PARTS if depth == DEEPEST else MOST_INNER):
        if budget[0] <= 0:
            break
        shown.append(_copy(part, budget, depth - 1))
    if len(shown) < len(value):
        shown.append(f"… {len(value) - len(shown)} more")
    return shown


def _object(value: object, budget: list[int], depth: int) -> object:
    """An object by its fields: of a message of ROS, of a dataclass, of a plain class."""
    kind = type(value)
    shape, numbers = getattr(value, "shape", None), getattr(value, "dtype", None)
    if shape is not None and numbers is not None:
        return f"<{kind.__name__} {tuple(shape)} {numbers}>"
    names = getattr(value, "__slots__", None) or getattr(value, "__dict__", None)
    if isinstance(names, str) or not names or isinstance(value, type) or callable(value):
        return f"<{kind.__name__}>"
    names = [name for name in names if isinstance(name, str) and name != "_check_fields"]
    pairs = [(name.lstrip("_"), getattr(value, name)) for name in names if hasattr(value, name)]
    return _fields(pairs, len(pairs), budget, depth)


def _cut(text: str) -> str:
    more = len(text) - LONGEST_TEXT
    return text if more <= 0 else f"{text[:LONGEST_TEXT]}… {more} more"
