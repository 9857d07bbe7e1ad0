"""Plain values from a pickle that came over a network, without unpickling it.

Unpickling runs code that the sender chooses. `plain_value` reads the opcodes itself and has none
that names a class or calls a function. Its limits bound time and memory too: the values are at most
100,000, 50 levels deep; the keys of dictionaries and the members of sets have no parts.
"""

from __future__ import annotations

import pickletools
from typing import Any

MOST_BYTES = 1_000_000
MOST_VALUES = 100_000
MOST_LEVELS = 50

_CONSTANTS = {"NONE": None, "NEWTRUE": True, "NEWFALSE": False}
_SCALARS = frozenset(
    ["BININT", "BININT1", "BININT2", "LONG1", "BINFLOAT", "BINUNICODE", "SHORT_BINUNICODE",
     "BINBYTES", "SHORT_BINBYTES"]
)  # fmt: skip
_EMPTY = {"EMPTY_LIST": list, "EMPTY_DICT": dict, "EMPTY_TUPLE": tuple, "EMPTY_SET": set}
_TUPLES = {"TUPLE1": 1, "TUPLE2": 2, "TUPLE3": 3}


def plain_value(data: bytes) -> Any:
    """The value of a pickle of protocol 2 to 5 made of None, bool, int, float, str, bytes, list,
    tuple, dict, set and frozenset (bytes and sets from protocol 4 on).

    Raises ValueError for anything else, and beyond the limits.
    """
    if len(data) > MOST_BYTES:
        raise ValueError(f"it has more than {MOST_BYTES:,} bytes")
    try:
        value = _interpreted(data)
    except (IndexError, KeyError, TypeError, AttributeError):
        raise ValueError("it is no valid pickle") from None
    _check_size(value)
    return value


def _interpreted(data: bytes) -> Any:
    """The value that the opcodes build; the limits on its size are not checked."""
    stack: list[Any] = []
    marks: list[int] = []
    memo: dict[Any, Any] = {}

    def since_mark() -> list[Any]:
        start = marks.pop()
        items = stack[start:]
        del stack[start:]
        return items

    for opcode, argument, _ in pickletools.genops(data):
        match opcode.name:
            case "STOP":
                return stack[-1]
            case "PROTO" | "FRAME":
                pass
            case name if name in _CONSTANTS:
                stack.append(_CONSTANTS[name])
            case name if name in _SCALARS:
                stack.append(argument)
            case name if name in _EMPTY:
                stack.append(_EMPTY[name]())
            case name if name in _TUPLES:
                items = [stack.pop() for _ in range(_TUPLES[name])]
                stack.append(tuple(reversed(items)))
            case "MARK":
                marks.append(len(stack))
            case "TUPLE":
                stack.append(tuple(since_mark()))
            case "FROZENSET":
                stack.append(frozenset(map(_hashable, since_mark())))
            case "APPEND":
                value = stack.pop()
                stack[-1].append(value)
            case "APPENDS":
                items = since_mark()
                stack[-1].extend(items)
            case "SETITEM":
                value, key = stack.pop(), stack.pop()
                stack[-1][_hashable(key)] = value
            case "SETITEMS":
                items = since_mark()
                stack[-1].update(zip(map(_hashable, items[::2]), items[1::2], strict=True))
            case "ADDITEMS":
                items = since_mark()
                stack[-1].update(map(_hashable, items))
            case "BINPUT" | "LONG_BINPUT":
                memo[argument] = stack[-1]
            case "MEMOIZE":
                memo[len(memo)] = stack[-1]
            case "BINGET" | "LONG_BINGET":
                stack.append(memo[argument])
            case name:
                raise ValueError(f"it has more than plain values (opcode {name})")
    raise ValueError("it is no valid pickle")


def _hashable(key: Any) -> Any:
    """A key without parts. The hash of tuples that share parts can take exponential time."""
    if isinstance(key, (tuple, frozenset)):
        raise ValueError("it has a tuple or a set as a key")
    return key


def _check_size(value: Any) -> None:
    """Raise ValueError for too many values, which shared ones count for each place that they have,
    and for too many levels; a value that contains itself has both."""
    pending, seen = [(value, 0)], 0
    while pending:
        item, level = pending.pop()
        seen += 1
        if isinstance(item, dict):
            pending.extend((part, level + 1) for part in item.values())
        elif isinstance(item, (list, tuple, set, frozenset)):
            pending.extend((part, level + 1) for part in item)
        if level > MOST_LEVELS or seen + len(pending) > MOST_VALUES:
            raise ValueError(f"it has more than {MOST_VALUES:,} values or {MOST_LEVELS} levels")
