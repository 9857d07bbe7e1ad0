"""Messages of ROS 2 whose values fit the types of their fields.

rclpy checks no field of a message: `Float64(data=1)` is sent with the bits of the integer. For this
reason each sender of this package sends what `checked` returns. A value that can be converted
without a loss is converted: a whole number in a field of floats, a number of numpy, a mapping by
the names of fields or a sequence in their order in a field of a message. Any other value that does
not fit is a FieldError with the path of the field: `goal.poses[3].position.x`.
"""

from __future__ import annotations

import array
import math
import reprlib
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence, Set
from contextlib import suppress
from numbers import Integral, Real
from typing import Any

from smachac.runtime.smach_ros2 import ros

definition: Any = ros.load("rosidl_parser.definition")
"""The classes of the types of fields, as the messages of rclpy describe themselves."""

CODES: Mapping[str, str] = {
    "int8": "b",
    "int16": "h",
    "int32": "i",
    "int64": "q",
    "uint8": "B",
    "uint16": "H",
    "uint32": "I",
    "uint64": "Q",
    "float": "f",
    "double": "d",
}
"""The type code of `array.array` for each type of numbers whose lists are arrays."""

FLOATS: Mapping[str, float] = {
    "float": (2 - 2**-23) * 2.0**127,
    "double": sys.float_info.max,
    "long double": sys.float_info.max,
}
"""The largest finite number of each type of floats."""

NAMES: Mapping[str, str] = {
    "boolean": "bool",
    "octet": "byte",
    "float": "float32",
    "double": "float64",
}
"""The names of types in .msg files, where they differ from those of the IDL."""


class FieldError(ValueError):
    """A value that does not fit the type of its field. `path`: names and indices, outermost first;
    `reason`: what follows the path in the message."""

    def __init__(self, reason: str, path: tuple[str | int, ...] = ()) -> None:
        super().__init__(reason, path)
        self.reason = reason
        self.path = path

    def inside(self, place: str | int) -> FieldError:
        """The same error, seen from the message or the list that has the field."""
        return FieldError(self.reason, (place, *self.path))

    def __str__(self) -> str:
        parts = (f"[{value}]" if isinstance(value, int) else f".{value}" for value in self.path)
        return f"`{''.join(parts).removeprefix('.')}` {self.reason}"


def checked(message: Any, kind: type[Any], name: str) -> Any:
    """The message `kind` to send: `message` itself, whose values are converted where necessary, or
    a new one with the values of a mapping or a sequence.

    `name` is the root of the path in errors. Raises FieldError for a value that does not fit.
    """
    try:
        return _message(kind, message)
    except FieldError as error:
        raise error.inside(name) from None


def filled(message: Any, values: Any, name: str | None = None) -> Any:
    """The message, with its fields set from a mapping, a sequence in their order, a number of
    seconds (for a time or a duration), or another message of its type, which is returned.

    `name` is the root of the path in errors (default: the name of the type). Raises FieldError for
    a value that does not fit.
    """
    try:
        if type(values) is type(message):
            return _message(type(message), values)
        _set_fields(message, _by_name(message, values))
        return message
    except FieldError as error:
        raise error.inside(name or type(message).__name__) from None


def checking(kind: type[Any], callback: Callable[..., Any] | None = None) -> Callable[..., Any]:
    """A callback for a goal or a request of the class `kind`, for states that check no field.

    It calls `callback`, whose outcomes and keys it has, and returns the message to send. FieldError
    for a value that does not fit ends a state of smach_ros as aborted.
    """

    def call(userdata: Any, message: Any, *args: Any, **kwargs: Any) -> Any:
        changed = None if callback is None else callback(userdata, message, *args, **kwargs)
        name = kind.__name__.rpartition("_")[2].lower()
        return checked(message if changed is None else changed, kind, name)

    for getter in ("outcomes", "input_keys", "output_keys"):
        name = f"get_registered_{getter}"
        if hasattr(callback, name):
            setattr(call, name, getattr(callback, name))
    return call


def is_message(value: Any) -> bool:
    """Whether a value is a message of ROS 2."""
    return hasattr(value, "get_fields_and_field_types")


def _message(kind: type[Any], value: Any) -> Any:
    """A message of the class `kind` from a value; a message of this class stays the same object."""
    if type(value) is not kind:
        message = kind()
        _set_fields(message, _by_name(message, value))
        return message
    for name, field in zip(ros.fields(value), value.SLOT_TYPES, strict=True):
        present = getattr(value, name)
        try:
            fitting = _fitting(field, present)
        except FieldError as error:
            raise error.inside(name) from None
        if fitting is not present:
            setattr(value, name, fitting)
    return value


def _set_fields(message: Any, values: Iterable[tuple[str, Any]]) -> None:
    """Set fields of a message to values, which are converted to their types."""
    kinds = dict(zip(ros.fields(message), message.SLOT_TYPES, strict=True))
    for name, value in values:
        if name not in kinds:
            known = ", ".join(kinds) or "none"
            reason = f"does not exist: the fields of {_type_name(type(message))} are {known}"
            raise FieldError(reason, (name,))
        try:
            setattr(message, name, _fitting(kinds[name], value))
        except FieldError as error:
            raise error.inside(name) from None


def _by_name(message: Any, values: Any) -> Iterable[tuple[str, Any]]:
    """The names of the fields of a message, each with its value."""
    names = ros.fields(message)
    if isinstance(values, Mapping):
        return values.items()
    if is_message(values):
        raise _misfit(_type_name(type(message)), values)
    seconds = _float(values, FLOATS["double"]) if names == ["sec", "nanosec"] else None
    if seconds is not None and math.isfinite(seconds):
        return zip(names, divmod(ros.nanoseconds(seconds), ros.NANOSECONDS), strict=True)
    is_list = isinstance(values, Sequence) and not isinstance(values, str | bytes)
    if not (is_list or _is_array(values)) or len(values) != len(names):
        made_of = f"a mapping or a list of {', '.join(names) or 'nothing'}"
        raise _misfit(f"{_type_name(type(message))} ({made_of})", values)
    return zip(names, values, strict=True)


def _fitting(kind: Any, value: Any) -> Any:
    """A value for a field of a type: the same object if it fits as it is."""
    match kind:
        case definition.BasicType():
            return _basic(kind.typename, value)
        case definition.AbstractGenericString():
            return _text(kind, value)
        case definition.NamespacedType():
            return _message(getattr(ros.load(".".join(kind.namespaces)), kind.name), value)
    return _items(kind, value)


def _basic(name: str, value: Any) -> Any:
    """A value of a type of numbers, truth values or bytes."""
    if type(value) is _SAME.get(name):
        return value
    fitting = value
    if name in FLOATS:
        fitting = _float(value, FLOATS[name])
    elif name == "boolean":
        fitting = bool(value) if _is_bool(value) else None
    elif name == "octet":
        if isinstance(value, Integral):
            fitting = bytes([int(value)]) if 0 <= int(value) <= 255 else None
        elif not isinstance(value, bytes) or len(value) != 1:
            fitting = None
    elif name in CODES:
        is_whole = isinstance(value, Integral)
        fitting = int(value) if is_whole and _is_in_range(name, int(value)) else None
    elif not isinstance(value, str) or len(value) != 1 or ord(value) > _MOST_CHARACTER[name]:
        fitting = None
    if fitting is None:
        raise _misfit(NAMES.get(name, name), value)
    return fitting


_SAME = {"double": float, "boolean": bool}
"""The class of Python whose values are all values of a type."""

_MOST_CHARACTER = {"char": 0x7F, "wchar": 0xFFFF}
"""The largest code point of each type of characters, which only interfaces in IDL have."""


def _float(value: Any, most: float) -> float | None:
    """A finite number up to `most`, an infinity or nan; None for other values."""
    if not isinstance(value, Real) or isinstance(value, bool):
        return None
    try:
        number = float(value)
    except OverflowError:
        return None
    is_infinity = math.isinf(number) and number == value
    return None if abs(number) > most and not is_infinity else number


def _is_in_range(name: str, number: int) -> bool:
    """Whether a number is one of a type of integers."""
    bits = int(name.removeprefix("u").removeprefix("int"))
    least = 0 if name.startswith("u") else -1 << (bits - 1)
    return least <= number < least + (1 << bits)


def _is_bool(value: Any) -> bool:
    """Whether a value is a truth value, also one of numpy, or 0 or 1."""
    if isinstance(value, Integral):
        return value in (0, 1)
    return bool(getattr(value, "dtype", None) == "bool" and value.ndim == 0)


def _text(kind: Any, value: Any) -> str:
    """A text: with at most as many characters as its type allows, and without characters that
    cannot be sent. The null character would end the text at the receiver."""
    if not isinstance(value, str):
        raise _misfit(_written(kind), value)
    most = kind.maximum_size if kind.has_maximum_size() else None
    if most is not None and len(value) > most:
        raise FieldError(f"is {_written(kind)}, and the text has {len(value)} characters")
    if "\0" in value and isinstance(kind, definition.AbstractString):
        raise FieldError(f"is {_written(kind)}, which cannot contain the null character")
    if not value.isascii():
        try:
            value.encode()
        except UnicodeEncodeError as error:
            reason = f"is {_written(kind)}, and the character {value[error.start]!a} is no Unicode"
            raise FieldError(reason) from None
    return value


def _items(kind: Any, value: Any) -> Any:
    """The values of a list, with the length that its type allows."""
    item = kind.value_type
    code = CODES.get(item.typename) if isinstance(item, definition.BasicType) else None
    is_bytes = code == "B" or (code is None and _written(item) == "byte")
    if isinstance(value, str | Set) or not (_is_array(value) or isinstance(value, Sequence)):
        raise _misfit(_written(kind), value)
    if isinstance(value, bytes | bytearray | memoryview) and not is_bytes:
        raise _misfit(_written(kind), value)
    shape = getattr(value, "shape", (len(value),))
    if len(shape) != 1:
        raise FieldError(f"is {_written(kind)}, and the array has the shape {shape}")
    if kind.has_maximum_size() and not _allows(kind, len(value)):
        raise FieldError(f"is {_written(kind)}, and the list has {len(value)} values")
    if code is not None:
        return _numbers(kind, item.typename, value)
    fitting = []
    for index, other in enumerate(value):
        try:
            fitting.append(_fitting(item, other))
        except FieldError as error:
            raise error.inside(index) from None
    is_same = all(old is new for old, new in zip(value, fitting, strict=True))
    return value if is_same and isinstance(value, list) else fitting


def _numbers(kind: Any, name: str, value: Any) -> Any:
    """The numbers of a list: an array of numpy for a type with a fixed length, otherwise an
    `array.array`. An array that has this type of numbers is not read."""
    code, is_fixed = CODES[name], isinstance(kind, definition.Array)
    # The subclasses of numpy's array, such as masked arrays, are read value by value.
    is_numpy = (type(value).__module__, type(value).__name__) == ("numpy", "ndarray")
    if is_numpy and value.dtype == code:
        return value if is_fixed else array.array(code, value.tobytes())
    if isinstance(value, array.array) and value.typecode == code and not is_fixed:
        return value
    items = value.tolist() if hasattr(value, "tolist") else list(value)
    if set(map(type, items)) <= ({int, float} if name in FLOATS else {int}):
        with suppress(OverflowError):  # array.array checks the range of its numbers
            numbers = array.array(code, items)
            if name != "float" or not any(map(math.isinf, numbers)):
                return items if is_fixed else numbers
    fitting = []
    for index, item in enumerate(items):
        try:
            fitting.append(_basic(name, item))
        except FieldError as error:
            raise error.inside(index) from None
    return fitting if is_fixed else array.array(code, fitting)


def _is_array(value: Any) -> bool:
    """Whether a value is an array of the standard library or of numpy."""
    return isinstance(value, array.array) or (hasattr(value, "dtype") and hasattr(value, "tolist"))


def _allows(kind: Any, length: int) -> bool:
    """Whether a type with a limit allows a length."""
    is_fixed = isinstance(kind, definition.Array)
    return bool(length == kind.size if is_fixed else length <= kind.maximum_size)


def _misfit(wanted: str, value: Any) -> FieldError:
    shown = _type_name(type(value)) if is_message(value) else reprlib.repr(value)
    return FieldError(f"is {wanted}, not {shown}")


def _type_name(kind: type[Any]) -> str:
    """The name of the class of a message: `std_msgs/msg/Bool`."""
    return "/".join((*kind.__module__.split(".")[:2], kind.__name__))


def _written(kind: Any) -> str:
    """A type as a .msg file has it: `float64[<=3]`."""
    match kind:
        case definition.BasicType():
            return NAMES.get(kind.typename, str(kind.typename))
        case definition.AbstractGenericString():
            word = "string" if isinstance(kind, definition.AbstractString) else "wstring"
            return f"{word}<={kind.maximum_size}" if kind.has_maximum_size() else word
        case definition.NamespacedType():
            return "/".join((*kind.namespaces, kind.name))
        case definition.Array():
            return f"{_written(kind.value_type)}[{kind.size}]"
    most = f"<={kind.maximum_size}" if kind.has_maximum_size() else ""
    return f"{_written(kind.value_type)}[{most}]"
