"""Types and constants of the script as C++.

| script                | C++                           |
| `bool` `int` `float`  | `bool` `std::int64_t` `double`|
| `str`, `one_of` words | `std::string`, in UTF-8       |
| `list[T]`             | `std::vector<T>`              |
| `T[N]`                | `std::array<T, N>`            |
| `dict[str, T]`        | `std::map<std::string, T>`    |
| `T?`                  | `std::optional<T>`            |
| records with a name   | structs, see records.py       |
| `Pose` and its like   | structs of smachac/values.hpp |
| `any`                 | `std::any`                    |
| `none`                | `smachac::None`               |

An enumeration is a string, not an enum class: expressions compare it with strings, join it to
strings and print it, it fits a `str` key, and its choices need not be identifiers. Units have no
equivalent.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping

from smachac.ir.nodes import Data, Expression, Struct
from smachac.ir.types import STRUCTS, Type

SMALLEST, LARGEST = -(2**63), 2**63 - 1
"""The range of `std::int64_t`."""

BIG = f"write a number from {SMALLEST} to {LARGEST}"

EXACT = 2**53
"""Up to this size a `double` represents every integer."""

NONE, INT, FLOAT, STR, ANY = map(Type, ("none", "int", "float", "str", "any"))
POINT, QUATERNION = Type("Point"), Type("Quaternion")
FLOATS = Type("list", (FLOAT,))

FIELDS: Mapping[str, Mapping[str, Type]] = {
    "Point": dict.fromkeys("xyz", FLOAT),
    "Quaternion": dict.fromkeys("xyzw", FLOAT),
    "Pose": {"position": POINT, "orientation": QUATERNION},
    "Transform": {"translation": POINT, "rotation": QUATERNION},
    "PoseStamped": {"frame_id": STR, "stamp": FLOAT, "pose": Type("Pose")},
    "JointState": {
        "name": Type("list", (STR,)),
        "position": FLOATS,
        "velocity": FLOATS,
        "effort": FLOATS,
    },
}
"""The members of the structs, in their order. Scripts write the first four as lists, the others as
mappings."""

LISTED = ("Point", "Quaternion", "Pose", "Transform")

OTHER_TYPES = (
    "name its class in C++ under `[cpp_types]` of smachac.toml; or declare the key as `any`, which"
    " is a `std::any` in C++"
)
"""The help for a type that C++ lacks, such as a message of ROS."""

SCALARS = {
    "bool": "bool",
    "int": "std::int64_t",
    "float": "double",
    "str": "std::string",
    "any": "std::any",
    "none": "smachac::None",
}


class UnportableError(Exception):
    """A part of the script that C++ cannot express; the message is the reason.

    `names` are those in the message: the part of an expression that is refused, if there is one.
    `help` is an instruction to the user.
    """

    def __init__(self, message: str, *names: str, help: str | None = None) -> None:
        super().__init__(message)
        self.names, self.help = names, help


def cpp_type(type_: Type) -> str:
    """The C++ type for a type. Raises UnportableError if there is none."""
    type_ = plain(type_)
    match type_.name, type_.args:
        case name, () if name in STRUCTS:
            return f"smachac::{name}"
        case name, () if name in SCALARS:
            return SCALARS[name]
        case "list", (Type() as item,):
            return f"std::vector<{cpp_type(item)}>"
        case "array", (Type() as item, int(size)):
            return f"std::array<{cpp_type(item)}, {size}>"
        case "dict", (Type() as item,):
            return f"std::map<std::string, {cpp_type(item)}>"
        case "optional", (Type() as item,):
            return f"std::optional<{cpp_type(item)}>"
        case "text", (int(size),):
            return f"smachac::step::TextOf<{size}>"
        case "bounded", (Type() as item, int(size)):
            return f"smachac::step::ListOf<{cpp_type(item)}, {size}>"
        case "stamped", (int(size),):
            return f"smachac::step::PoseStampedOf<{size}>"
        case (("struct" | "class"), (str(class_), *_)):
            return class_
    if type_.name == "record":
        raise UnportableError(f"C++ needs a name for the record `{type_}`")
    message = f"the members of the type `{type_}` are unknown"
    raise UnportableError(message, help=OTHER_TYPES)


def fields_of(struct: Type) -> dict[str, Type]:
    """The fields of a struct of a record and their types."""
    _, *parts = struct.args
    return dict(
        zip(map(str, parts[::2]), (p for p in parts[1::2] if isinstance(p, Type)), strict=True)
    )


def without_classes(type_: Type) -> Type:
    """A type with records in place of their structs."""
    args = [without_classes(arg) if isinstance(arg, Type) else arg for arg in type_.args]
    return Type("record", (*args[1:],)) if type_.name == "struct" else Type(type_.name, (*args,))


def plain(type_: Type) -> Type:
    """A type without units, choices and bounds, which C++ lacks; unknown names become `any`."""
    match type_.name, type_.args:
        case "int" | "float" | "str", _:
            return Type(type_.name)
        case "list", (Type() as item, int()):
            return Type("list", (plain(item),))
        case "one_of" | "literal", choices:
            kinds = {STR if isinstance(choice, str) else INT for choice in choices}
            return kinds.pop() if len(kinds) == 1 else ANY
        case "list" | "dict", ():
            return Type(type_.name, (ANY,))
        case "optional", (Type() as item,):
            inner = plain(item)
            return (
                inner if inner.name in ("optional", "any", "none") else Type("optional", (inner,))
            )
        case name, () if (
            name not in STRUCTS and name not in SCALARS and not re.search("[./]", name)
        ):
            return ANY
    args = tuple(plain(arg) if isinstance(arg, Type) else arg for arg in type_.args)
    return Type(type_.name, args)


def cpp_value(data: Data, type_: Type) -> str:
    """C++ text of a constant as a value of a type. Raises UnportableError if it is none."""
    return _value(data, plain(type_))


def _value(data: Data, type_: Type) -> str:
    match type_.name, data:
        case _, Expression():
            return _value(_computed(data), type_)
        case "any", _:
            return _any(data)
        case "optional", None:
            return f"{cpp_type(type_)}{{}}"
        case "optional", _:
            return f"{cpp_type(type_)}{{{_value(data, _inside(type_))}}}"
        case "class", None:  # an object of the user's class, as traces show it
            return f"{cpp_type(type_)}{{}}"
        case "none", None:
            return "smachac::None{}"
        case "bool", bool():
            return cpp_bool(data)
        case _, bool():
            pass
        case "int", int():
            return cpp_int(data)
        case "float", int() | float():
            return cpp_float(data)
        case "str", str():
            return cpp_string(data)
        case "list" | "array" | "dict" | "bounded", tuple() | Struct():
            return _items(data, type_)
        case "text", str():
            _within(len(data.encode("utf-8", "surrogatepass")), type_, "bytes")
            return f"std::string_view{cpp_string(data).removeprefix('std::string')}"
        case "stamped", tuple() | Struct():
            frame = Type("text", type_.args)
            fields = {**FIELDS["PoseStamped"], "frame_id": frame}
            return f"{cpp_type(type_)}{{{', '.join(_members(data, 'PoseStamped', fields))}}}"
        case name, tuple() | Struct() if name in FIELDS:
            return f"{cpp_type(type_)}{{{', '.join(_members(data, name))}}}"
        case "struct", Struct():
            return _record(data, type_)
    raise UnportableError(f"{_shown(data)} is not of the type `{type_}`")


def _inside(type_: Type) -> Type:
    first = type_.args[0]
    return first if isinstance(first, Type) else ANY


def _any(data: Data) -> str:
    """A constant of a key of unknown type, in the simplest type that holds it."""
    match data:
        case None:
            return "std::any{}"
        case bool() | int() | float() | str():
            name = {bool: "bool", int: "int", float: "float", str: "str"}[type(data)]
            text = _value(data, Type(name))
            return f"std::any{{{f'std::int64_t{{{text}}}' if name == 'int' else text}}}"
        case tuple():
            return f"std::any{{{_value(data, Type('list', (ANY,)))}}}"
        case Struct():
            return f"std::any{{{_value(data, Type('dict', (ANY,)))}}}"
    raise UnportableError(f"{_shown(data)} has no C++ type")


def _items(data: tuple[Data, ...] | Struct, type_: Type) -> str:
    inner = _inside(type_)
    match type_.args, data:
        case (_, int(size)), tuple() if type_.name == "bounded":
            _within(len(data), type_, "items")
            return braced(cpp_type(type_), [_value(item, inner) for item in data])
        case (_, int(size)), tuple() if len(data) != size:
            raise UnportableError(f"{_shown(data)} has {len(data)} items, but `{type_}` has {size}")
        case _, tuple() if type_.name != "dict":
            items = [_value(item, inner) for item in data]
            return braced(cpp_type(type_), items, array=type_.name == "array")
        case _, Struct(entries=entries) if type_.name == "dict":
            pairs = [f"{{{cpp_string(key)}, {_value(item, inner)}}}" for key, item in entries]
            return braced(cpp_type(type_), pairs)
    raise UnportableError(f"{_shown(data)} is not of the type `{type_}`")


def braced(name: str, items: list[str], *, array: bool = False) -> str:
    """A value of a container. `array`: of a std::array, whose items have braces of their own."""
    inner = ", ".join(items)
    return f"{name}{{{{{inner}}}}}" if array and items else f"{name}{{{inner}}}"


def _within(size: int, type_: Type, unit: str) -> None:
    """Refuses a constant that is larger than the bound of its type."""
    bound = type_.args[-1]
    if isinstance(bound, int) and size > bound:
        raise UnportableError(f"the value has {size} {unit}; the bound is {bound}")


def _members(
    data: tuple[Data, ...] | Struct, name: str, fields: Mapping[str, Type] | None = None
) -> list[str]:
    """The members of a struct from the list or the mapping that scripts write for it."""
    fields = fields or FIELDS[name]
    if isinstance(data, tuple):
        if name not in LISTED:
            raise UnportableError(f"`{name}` must be a mapping with the fields {', '.join(fields)}")
        if len(data) == 3 and name in ("Pose", "Transform"):
            # As in the simulation: without a rotation.
            return [_value(data, POINT), "smachac::Quaternion{}"]
        if len(data) != len(fields):
            raise UnportableError(
                f"{_shown(data)} has {len(data)} items, but `{name}` has {len(fields)} parts"
            )
        return [_value(item, part) for item, part in zip(data, fields.values(), strict=True)]
    given = dict(data.entries)
    unknown = [key for key in given if key not in fields]
    if unknown:
        raise UnportableError(f"`{name}` has no field `{unknown[0]}`, only {', '.join(fields)}")
    return [
        _value(given[key], part) if key in given else f"{cpp_type(part)}{{}}"
        for key, part in fields.items()
    ]


def _record(data: Struct, type_: Type) -> str:
    """A struct of a record from the mapping in the script."""
    given, fields = dict(data.entries), fields_of(type_)
    check_fields(given, type_)
    for name, value in given.items():
        if value is None and fields[name].name == "optional":
            raise UnportableError(
                f"C++ does not tell null from an absent field: leave out `{name}`"
            )
    values = [
        _value(given[name], fields[name]) if name in given else f"{cpp_type(fields[name])}{{}}"
        for name in sorted(fields)
    ]
    return f"smachac::constant<{cpp_type(type_)}>({', '.join(values)})"


def check_fields(given: Iterable[str], struct: Type) -> None:
    """Refuses a record with other fields than a struct has, or without one that it needs."""
    fields, given = fields_of(struct), list(given)
    unknown = [name for name in given if name not in fields]
    if unknown:
        raise UnportableError(f"`{struct}` has no field `{unknown[0]}`, only {', '.join(fields)}")
    for name, part in fields.items():
        if name not in given and part.name != "optional":
            raise UnportableError(f"the field `{name}` of `{struct}` is missing")


def _computed(expression: Expression) -> Data:
    """The value of an expression without names. Raises UnportableError if it has none."""
    from smachac.interpreter.evaluator import EvaluationError, evaluate
    from smachac.ir.expressions import parse_expression

    tree = parse_expression(expression.text)
    if tree is None:
        raise UnportableError(f"`{expression.text}` is Python code, not a portable expression")
    try:
        return script_data(evaluate(tree, {}))
    except EvaluationError as error:
        message = f"`{expression.text}` is not a constant: {error}"
        raise UnportableError(
            message, help="write the value, such as a number or a list"
        ) from error


def script_data(value: object) -> Data:
    """A value of Python as data of a script. Raises UnportableError if a script cannot have it."""
    match value:
        case None | bool() | int() | float() | str():
            return value
        case list() | tuple() | range():
            return tuple(script_data(item) for item in value)
        case dict() if all(isinstance(key, str) for key in value):
            return Struct(entries=tuple((key, script_data(item)) for key, item in value.items()))
    raise UnportableError(f"`{value!r}` is not a value in C++")


def _shown(data: Data) -> str:
    """A constant in a message."""
    match data:
        case tuple():
            return "a list"
        case Struct():
            return "a mapping"
    return f"`{data!r}`"


def cpp_bool(value: bool) -> str:
    return "true" if value else "false"


def cpp_int(value: int) -> str:
    """C++ text of an integer. Raises UnportableError beyond 64 bits."""
    if not SMALLEST <= value <= LARGEST:
        raise UnportableError(f"{value} does not fit into an integer of 64 bits", help=BIG)
    return str(value) if value != SMALLEST else f"({SMALLEST + 1} - 1)"


def cpp_float(value: float) -> str:
    """C++ text of a float. Raises UnportableError for an integer that no float equals."""
    if isinstance(value, int):
        if abs(value) > EXACT and not (abs(value) < 2**1000 and float(value) == value):
            raise UnportableError(f"{value} has no exact value as a float")
        value = float(value)
    if math.isnan(value):
        return "std::numeric_limits<double>::quiet_NaN()"
    if math.isinf(value):
        return f"{'-' if value < 0 else ''}std::numeric_limits<double>::infinity()"
    return repr(value)


_ESCAPES = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\r": "\\r", "\t": "\\t"}


def cpp_literal(value: str) -> str:
    """A string literal of C++ in ASCII, its bytes those of UTF-8.

    Raises UnportableError for a surrogate, which UTF-8 cannot encode.
    """
    try:
        data = value.encode("utf-8")
    except UnicodeEncodeError as error:
        raise UnportableError(
            f"{value!r} contains a surrogate, which UTF-8 cannot encode"
        ) from error
    text = "".join(
        _ESCAPES.get(chr(byte)) or (chr(byte) if 32 <= byte < 127 else f"\\{byte:03o}")
        for byte in data
    )
    # Two question marks start a trigraph.
    return '"' + re.sub(r"(?<=\?)\?", r"\\?", text) + '"'


def cpp_string(value: str) -> str:
    """C++ text of a std::string."""
    literal = cpp_literal(value)
    if "\0" in value:
        return f"std::string({literal}, {len(value.encode())})"
    return f"std::string({literal})" if value else "std::string()"
