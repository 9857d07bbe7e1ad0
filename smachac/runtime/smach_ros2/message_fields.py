"""Messages of ROS 2 from plain values: mappings by field name, sequences in their order.

A value that is already a message is taken as it is. A number of seconds makes a time or a duration.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from smachac.runtime.smach_ros2 import ros

_SEQUENCE = re.compile(r"sequence<(.+?)(?:, *\d+)?>|(.+)\[\d+\]")

_FLOATS = ("float", "double", "long double")


def filled(message: Any, values: Any) -> Any:
    """The message, with its fields set from a mapping, a sequence or another message.

    Raises TypeError or ValueError that names the field if the values do not fit.
    """
    if is_message(values):
        if type(values) is not type(message):
            raise TypeError(f"this must be a {_name(message)}, not a {_name(values)}")
        return values
    kinds = message.get_fields_and_field_types()
    if isinstance(values, (int, float)) and set(kinds) == {"sec", "nanosec"}:
        whole = int(values // 1)
        values = {"sec": whole, "nanosec": round((values - whole) * 1e9) % 1_000_000_000}
    if not isinstance(values, Mapping):
        values = _by_name(message, kinds, values)
    for name, value in values.items():
        if name not in kinds:
            raise ValueError(f"{_name(message)} has no field `{name}`: it has {', '.join(kinds)}")
        try:
            _set(message, name, _value(kinds[name], value, getattr(message, name)))
        except AssertionError:  # messages check the types of fields with `assert`
            raise TypeError(_misfit(message, name, kinds[name], value)) from None
        except (TypeError, ValueError) as error:
            raise type(error)(f"{_misfit(message, name, kinds[name], value)}: {error}") from None
    return message


def _set(message: Any, name: str, value: Any) -> None:
    """Set a field. The message checks the type, which newer messages do on request only."""
    checks = getattr(message, "_check_fields", None)
    if checks is False:
        message._check_fields = True
    try:
        setattr(message, name, value)
    finally:
        if checks is False:
            message._check_fields = False


def filled_field(message: Any, name: str, value: Any) -> None:
    """Set one field of a message, as `filled` does."""
    filled(message, {name: value})


def is_message(value: Any) -> bool:
    """Whether a value is a message of ROS 2."""
    return hasattr(value, "get_fields_and_field_types")


def _by_name(message: Any, kinds: Mapping[str, str], values: Any) -> dict[str, Any]:
    """The values of a sequence by the names of the fields, which are in the same order."""
    is_sequence = isinstance(values, Sequence) and not isinstance(values, (str, bytes))
    if not is_sequence or len(values) != len(kinds):
        wanted = f"a mapping, or a list of {len(kinds)} values: {', '.join(kinds)}"
        raise TypeError(f"{_name(message)} is made from {wanted}")
    return dict(zip(kinds, values, strict=True))


def _value(kind: str, value: Any, present: Any) -> Any:
    """The value of a field of a type; `present` is the value that the field has now."""
    items = _SEQUENCE.fullmatch(kind)
    if items is not None:
        item = items[1] or items[2]
        if "/" in item and not isinstance(value, (str, bytes)):
            return [filled(_message_class(item)(), each) for each in value]
        if item in _FLOATS and not isinstance(value, (str, bytes)):
            return [float(each) for each in value]
        return value if isinstance(value, (str, bytes)) else list(value)
    if is_message(present):
        return filled(present, value)
    if kind in _FLOATS and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if kind == "octet" and isinstance(value, int):
        return bytes([value])
    return value


def _message_class(kind: str) -> Any:
    package, _, name = kind.partition("/")
    return getattr(ros.load(f"{package}.msg"), name.rpartition("/")[2])


def _name(message: Any) -> str:
    return type(message).__name__


def _misfit(message: Any, name: str, kind: str, value: Any) -> str:
    return f"the field `{name}` of {_name(message)} is {kind}, not {value!r:.80}"
