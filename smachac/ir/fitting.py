"""What fits what: the order of types, and the types of literals.

An int fits a float, a `T` a `T?`, an enumeration a larger one or a `str`; a list of unknown length
fits an array, a number without a unit every unit; `any` fits everything and everything fits `any`.
Nothing else converts. Three forms that no script can write stand for what is known of a literal:
`Type("literal", (1, "a"))` is one of these constants, `Type("tuple", (T, U))` a list of two items,
`Type("record", ("x", T))` a mapping with these names. They fit whatever they can be written for.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import lru_cache
from typing import Literal, NamedTuple, TypeAlias

from smachac.ir.types import ANY, STRUCTS, WORDS, Type

Kind: TypeAlias = Literal["type", "length", "unit"]

BOOL, INT, FLOAT, STR, NONE = map(Type, ("bool", "int", "float", "str", "none"))
LIST, DICT = Type("list"), Type("dict")
POINT, QUATERNION = Type("Point"), Type("Quaternion")


class Misfit(NamedTuple):
    """Why one type does not fit another: the innermost parts that clash, and how."""

    kind: Kind
    given: Type
    wanted: Type


def is_open(type_: Type) -> bool:
    """Whether nothing is known of a type: `any`, `any?`, a word that names none."""
    if type_.name == "optional":
        return is_open(inside(type_))
    return type_.name == "any" or (not type_.args and _is_unknown(type_.name))


@lru_cache(maxsize=1000)
def _is_unknown(name: str) -> bool:
    return name not in WORDS and name not in ("tuple", "record") and not re.search("[./]", name)


def inside(type_: Type) -> Type:
    """The type of the items of a list, array, dict or optional; `any` of a bare one."""
    first = type_.args[0] if type_.args else ANY
    return first if isinstance(first, Type) else ANY


def items(type_: Type) -> tuple[Type, ...]:
    """The types of the items of a tuple."""
    return tuple(item for item in type_.args if isinstance(item, Type))


def fields(type_: Type) -> dict[str, Type]:
    """The types of a record by name."""
    pairs = zip(type_.args[::2], type_.args[1::2], strict=True)
    return {str(name): item for name, item in pairs if isinstance(item, Type)}


def record(of: Iterable[tuple[str, Type]]) -> Type:
    """The type of a mapping with these names."""
    return Type("record", tuple(part for pair in of for part in pair))


def present(type_: Type) -> Type:
    """The type without nothing."""
    while type_.name == "optional":
        type_ = inside(type_)
    return type_


def unit_of(type_: Type) -> str:
    """The unit of a number, or nothing where it has none."""
    return str(type_.args[0]) if type_.name in ("int", "float") and type_.args else ""


@lru_cache(maxsize=10_000)
def misfit(given: Type, wanted: Type) -> Misfit | None:
    """Why a value of one type may not be read as another; None where it may."""
    if given == wanted or is_open(given) or is_open(wanted):
        return None
    clash = Misfit("type", given, wanted)
    match given.name, wanted.name:
        case _, "optional":
            return None if given == NONE else misfit(present(given), inside(wanted))
        case "optional", _:
            return clash
        case "literal" | "one_of", "one_of" | "literal":
            return None if set(given.args) <= set(wanted.args) else clash
        case "literal" | "one_of", "str" | "int" | "float":
            return _first(_misfit_choice(choice, wanted) for choice in given.args)
        case "int" | "float", "int" | "float":
            return _misfit_numbers(given, wanted)
        case "tuple" | "list" | "array", "list" | "array":
            return _misfit_lists(given, wanted)
        case "record", "dict":
            return _first(misfit(item, inside(wanted)) for item in fields(given).values())
        case "dict", "dict":
            return misfit(inside(given), inside(wanted))
        case ("tuple", "tuple") | ("record", "record") if len(given.args) == len(wanted.args):
            parts = zip(items(given), items(wanted), strict=False)
            return _first(misfit(item, part) for item, part in parts)
        case "tuple", _:
            return _misfit_struct(given, wanted)
        case "record", "PoseStamped" | "JointState":
            return None
        case "list" | "array" | "dict", name if name in STRUCTS and is_open(inside(given)):
            return None
    if "/" in wanted.name or "." in wanted.name:
        literal = given.name in ("tuple", "record")
        return None if literal or _message(given.name) == _message(wanted.name) else clash
    return clash


def fits(given: Type, wanted: Type) -> bool:
    """Whether a value of one type may be read as another."""
    return misfit(given, wanted) is None


def _first(found: Iterable[Misfit | None]) -> Misfit | None:
    return next(filter(None, found), None)


def _misfit_choice(choice: Type | int | str, wanted: Type) -> Misfit | None:
    if isinstance(choice, Type) or isinstance(choice, str) == (wanted == STR):
        return None
    return Misfit("type", Type("literal", (choice,)), wanted)


@lru_cache(maxsize=1000)
def _message(name: str) -> tuple[str, ...]:
    """A type of ROS without regard to how it is spelt: `a/B`, `a/msg/B`, `a.msg.B`."""
    return tuple(part for part in re.split("[./]", name) if part != "msg")


def _misfit_numbers(given: Type, wanted: Type) -> Misfit | None:
    if given.name == "float" and wanted.name == "int":
        return Misfit("type", given, wanted)
    one, other = unit_of(given), unit_of(wanted)
    if one and other and _powers(one) != _powers(other):
        return Misfit("unit", given, wanted)
    return None


_FACTOR = re.compile(r"([*/]?)([^*/^]+)(?:\^(-?\d+))?")


@lru_cache(maxsize=1000)
def _powers(unit: str) -> tuple[tuple[str, int], ...]:
    """A unit as its factors: `m/s^2` and `s^-2*m` are one."""
    powers: dict[str, int] = {}
    for sign, name, power in _FACTOR.findall(unit):
        if name != "1":
            exponent = int(power or 1) * (-1 if sign == "/" else 1)
            powers[name] = powers.get(name, 0) + exponent
    return tuple(sorted(pair for pair in powers.items() if pair[1]))


def _misfit_lists(given: Type, wanted: Type) -> Misfit | None:
    own, due = length_of(given), length_of(wanted)
    if own is not None and due is not None and own != due:
        return Misfit("length", given, wanted)
    item = inside(wanted)
    if given.name == "tuple":
        return _first(misfit(each, item) for each in dict.fromkeys(items(given)))
    return misfit(inside(given), item)


def length_of(type_: Type) -> int | None:
    """How many items a list has, where that is known."""
    if type_.name == "tuple":
        return len(type_.args)
    size = type_.args[1] if type_.name == "array" else None
    return size if isinstance(size, int) else None


def _misfit_struct(given: Type, wanted: Type) -> Misfit | None:
    """Whether a list literal can be read as a struct."""
    found = items(given)
    match wanted.name:
        case "Point" | "Quaternion":
            size = 3 if wanted == POINT else 4
            if len(found) != size:
                return Misfit("length", given, wanted)
            return _first(misfit(item, FLOAT) for item in found)
        case "Pose" | "Transform" if len(found) == 2:
            parts = zip(found, (POINT, QUATERNION), strict=True)
            return _first(misfit(item, part) for item, part in parts)
        case "Pose" | "Transform" if len(found) == 3:
            # As in the simulation: without a rotation.
            return misfit(given, POINT) and Misfit("type", given, wanted)
        case "PoseStamped" | "JointState":
            return None
        case name if "/" in name or "." in name:
            return None
    return Misfit("type", given, wanted)
