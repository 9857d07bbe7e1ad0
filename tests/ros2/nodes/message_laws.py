"""Laws of the values of messages, tried with random values of every type of some packages.

A value that fits is in the message as it was meant, rclpy with its own checks accepts the message,
and a second check changes nothing. One value that does not fit is refused with its path.
"""

import array
import importlib
import inspect
import math
import random
from typing import Any

import numpy
from rosidl_parser import definition

from smachac.runtime.smach_ros2.message_fields import CODES, FLOATS, FieldError, checked, filled

PACKAGES = ("test_msgs", "std_msgs", "geometry_msgs", "nav_msgs", "smachac_test_interfaces")

EXAMPLES = 8
"""Messages of each type that are tried."""

NUMPY = {"float": "float32", "double": "float64"}
"""The names of types in numpy that differ from those of the definitions."""

LARGEST = {"float": math.ldexp(1.0, 127)}
"""A large number of a type: the limit in the checks of rclpy is below the largest float32."""

WRONG: dict[str, list[Any]] = {
    "boolean": [2, "x", 1.0, None],
    "octet": [256, -1, b"ab", "a", 1.0],
    "float": ["1", None, True, 1e39, 1j],
    "double": ["1", None, True, 10**400],
}

chosen = random.Random(5)


def number(name: str) -> Any:
    """A number of a type: a limit, or any."""
    if name in FLOATS:
        most = LARGEST.get(name, FLOATS[name])
        limits = [0.0, -0.0, most, -most, math.inf, -math.inf, math.nan]
        return chosen.choice([chosen.choice(limits), chosen.randint(-1000, 1000), 1.5])
    bits = int(name.lstrip("uint"))
    least = 0 if name.startswith("u") else -(2 ** (bits - 1))
    return chosen.choice([least, least + 2**bits - 1, chosen.randint(0, 100)])


def basic(name: str) -> tuple[Any, Any]:
    """A value in one of its forms in Python, and the value that the field gets."""
    if name == "boolean":
        truth = chosen.random() < 0.5
        return chosen.choice([truth, int(truth), numpy.bool_(truth)]), truth
    if name == "octet":
        byte = chosen.randint(0, 255)
        return chosen.choice([byte, bytes([byte]), numpy.uint8(byte)]), bytes([byte])
    value = number(name)
    if name in FLOATS:
        return chosen.choice([value, numpy.float64(value)]), float(value)
    return chosen.choice([value, getattr(numpy, name)(value)]), value


def text(kind: Any) -> str:
    """A text, at most as long as its type allows."""
    length = chosen.randint(0, kind.maximum_size if kind.has_maximum_size() else 5)
    return "".join(chosen.choice("aü€😀 ") for _ in range(length))


def limit(kind: Any) -> int | None:
    """The most values that a list can have; None: any number."""
    if isinstance(kind, definition.Array):
        return int(kind.size)
    return int(kind.maximum_size) if kind.has_maximum_size() else None


def valid(kind: Any) -> tuple[Any, Any]:
    """A value that fits a type, and what the field then contains as plain values."""
    if isinstance(kind, definition.BasicType):
        return basic(kind.typename)
    if isinstance(kind, definition.AbstractGenericString):
        value = text(kind)
        return value, value
    if isinstance(kind, definition.NamespacedType):
        return message(named(kind))
    most = limit(kind)
    is_fixed = isinstance(kind, definition.Array)
    length = kind.size if is_fixed else chosen.randint(0, 4 if most is None else most)
    pairs = [valid(kind.value_type) for _ in range(length)]
    values, wanted = [value for value, _ in pairs], [want for _, want in pairs]
    name = getattr(kind.value_type, "typename", "")
    if name in CODES and chosen.random() < 0.3:
        return numpy.array(wanted, dtype=getattr(numpy, NUMPY.get(name, name))), wanted
    if name in CODES and chosen.random() < 0.3:
        return array.array(CODES[name], wanted), wanted
    return chosen.choice([values, tuple(values)]), wanted


def named(kind: Any) -> Any:
    """The class of a message."""
    return getattr(importlib.import_module(".".join(kind.namespaces)), kind.name)


def message(kind: Any) -> tuple[Any, dict[str, Any]]:
    """A message or its values, as a mapping or as a list, and what it then contains."""
    names = list(kind.get_fields_and_field_types())
    pairs = [valid(field) for field in kind.SLOT_TYPES]
    values = dict(zip(names, [value for value, _ in pairs], strict=True))
    wanted = dict(zip(names, [want for _, want in pairs], strict=True))
    forms = [values, list(values.values()), filled(kind(), values)]
    return chosen.choice(forms), wanted


def plain(value: Any) -> Any:
    """The content of a message as plain values."""
    if hasattr(value, "SLOT_TYPES"):
        return {name: plain(getattr(value, name)) for name in value.get_fields_and_field_types()}
    if isinstance(value, list | tuple | array.array | numpy.ndarray):
        return [plain(item) for item in value]
    return value.item() if isinstance(value, numpy.generic) else value


def equal(got: Any, wanted: Any) -> bool:
    """Whether plain values are equal, also in their classes; nan is equal to nan."""
    if isinstance(wanted, dict):
        return all(equal(got[name], value) for name, value in wanted.items())
    if isinstance(wanted, list):
        return len(got) == len(wanted) and all(map(equal, got, wanted))
    is_nan = isinstance(wanted, float) and math.isnan(wanted)
    return type(got) is type(wanted) and (math.isnan(got) if is_nan else got == wanted)


def assert_accepted(made: Any) -> None:
    """rclpy accepts a message with its own checks, which raise AssertionError."""
    fields = {name: getattr(made, name) for name in made.get_fields_and_field_types()}
    type(made)(**fields, check_fields=True)
    for value in fields.values():
        for item in value if isinstance(value, list) else [value]:
            if hasattr(item, "SLOT_TYPES"):
                assert_accepted(item)


def wrong(kind: Any) -> tuple[Any, str]:
    """A value that does not fit a type, and the path inside it to the part that does not fit."""
    if isinstance(kind, definition.BasicType):
        name = kind.typename
        if name in WRONG:
            return chosen.choice(WRONG[name]), ""
        bits = int(name.lstrip("uint"))
        return chosen.choice([2**bits, -(2**bits), 1.0, "1", None, b"1"]), ""
    if isinstance(kind, definition.AbstractGenericString):
        longer = ["x" * (kind.maximum_size + 1)] if kind.has_maximum_size() else []
        return chosen.choice([5, None, b"x", ["x"], "\udc80", *longer]), ""
    if isinstance(kind, definition.NamespacedType):
        return wrong_message(named(kind)) or ("no message", "")
    most, size = limit(kind), kind.size if isinstance(kind, definition.Array) else 2
    if most is not None and chosen.random() < 0.3:
        return [valid(kind.value_type)[0] for _ in range(most + 1)], ""
    if chosen.random() < 0.3:
        return chosen.choice([5, None, "text", {1, 2}]), ""
    values = [valid(kind.value_type)[0] for _ in range(size)]
    place = chosen.randrange(size)
    values[place], path = wrong(kind.value_type)
    return values, f"[{place}]{path}"


def wrong_message(kind: Any) -> tuple[dict[str, Any], str] | None:
    """The values of a message of which one does not fit, and its path; None without fields."""
    names = list(kind.get_fields_and_field_types())
    if not names:
        return None
    values = {name: valid(field)[0] for name, field in zip(names, kind.SLOT_TYPES, strict=True)}
    place = chosen.randrange(len(names))
    values[names[place]], path = wrong(kind.SLOT_TYPES[place])
    return values, f".{names[place]}{path}"


def try_message(kind: Any) -> None:
    """The laws for one message of a type."""
    values, wanted = message(kind)
    made = checked(values, kind, "msg")
    assert equal(plain(made), wanted), (values, plain(made), wanted)
    assert_accepted(made)
    before = plain(made)
    assert checked(made, kind, "msg") is made
    assert equal(plain(made), before)
    values, path = wrong_message(kind) or ("no message", "")
    refusal = ""
    try:
        checked(values, kind, "msg")
    except FieldError as error:
        refusal = str(error)
    assert refusal.startswith(f"`msg{path}` "), (kind, refusal, path, values)


kinds = [
    kind
    for package in PACKAGES
    for _, kind in inspect.getmembers(importlib.import_module(f"{package}.msg"), inspect.isclass)
]
print("ready", flush=True)
for kind in kinds:
    for _ in range(EXAMPLES):
        try_message(kind)
print(f"sent: {EXAMPLES} messages of each of {len(kinds)} types")
