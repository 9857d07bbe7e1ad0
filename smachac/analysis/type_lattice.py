"""The lattice of types: subtyping, join and meet, and the types of literals.

An int fits a float, a `T` a `T?`, an enumeration a larger one or a `str`; a list of unknown length
fits an array, a number without a unit every unit, a text or list without a bound every bound, a
record one with fewer fields; `any` fits everything and everything fits `any`.
Nothing else converts. Three forms that no script can write stand for what is known of a literal:
`Type("literal", (1, "a"))` is one of these constants, `Type("tuple", (T, U))` a list of two items,
`Type("mapping", ("x", T))` a mapping with these names. They fit every type they can be written for.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import lru_cache, reduce
from typing import Literal, NamedTuple, TypeAlias

from smachac.ir.types import ANY, STRUCTS, WORDS, Type, bound_of, optional

MisfitKind: TypeAlias = Literal["type", "length", "unit"]

BOOL, INT, FLOAT, STR, NONE = map(Type, ("bool", "int", "float", "str", "none"))
LIST, DICT = Type("list"), Type("dict")
POINT, QUATERNION = Type("Point"), Type("Quaternion")


class Misfit(NamedTuple):
    """Why one type does not fit another: the innermost parts that clash, and how."""

    kind: MisfitKind
    given: Type
    wanted: Type


def is_unknown(type_: Type) -> bool:
    """Whether nothing is known of a type: `any`, `any?`, a word that names none."""
    if type_.name == "optional":
        return is_unknown(inside(type_))
    return type_.name == "any" or (not type_.args and _is_unknown(type_.name))


def _is_unknown(name: str) -> bool:
    return name not in WORDS and name not in ("tuple", "mapping") and not re.search("[./]", name)


def inside(type_: Type) -> Type:
    """The type of the items of a list, array, dict or optional; `any` of a bare one."""
    first = type_.args[0] if type_.args else ANY
    return first if isinstance(first, Type) else ANY


def items(type_: Type) -> tuple[Type, ...]:
    """The types of the items of a tuple."""
    return tuple(item for item in type_.args if isinstance(item, Type))


def fields(type_: Type) -> dict[str, Type]:
    """The types of the fields of a record or mapping by name."""
    pairs = zip(type_.args[::2], type_.args[1::2], strict=True)
    return {str(name): item for name, item in pairs if isinstance(item, Type)}


def mapping(of: Iterable[tuple[str, Type]]) -> Type:
    """The type of a mapping with these names."""
    return Type("mapping", tuple(part for pair in of for part in pair))


def present(type_: Type) -> Type:
    """The type without nothing."""
    while type_.name == "optional":
        type_ = inside(type_)
    return type_


def unit_of(type_: Type) -> str:
    """The unit of a number, or nothing where it has none."""
    return str(type_.args[0]) if type_.name in ("int", "float") and type_.args else ""


# Cached, because keys have few types: without, a check of 1,000 states whose keys have units takes
# 2 % more instructions.
@lru_cache(maxsize=10_000)
def misfit(given: Type, wanted: Type) -> Misfit | None:
    """Why a value of one type may not be read as another; None where it may."""
    if given == wanted or is_unknown(given) or is_unknown(wanted):
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
        case "str", "str":
            return None
        case "tuple" | "list" | "array", "list" | "array":
            return _misfit_lists(given, wanted)
        case "mapping" | "record", "dict":
            return _first(misfit(item, inside(wanted)) for item in fields(given).values())
        case "mapping" | "record", "record":
            return _misfit_records(given, wanted)
        case "dict", "record":
            return _first(misfit(inside(given), item) for item in fields(wanted).values())
        case "dict", "dict":
            return misfit(inside(given), inside(wanted))
        case ("tuple", "tuple") | ("mapping", "mapping") if len(given.args) == len(wanted.args):
            parts = zip(items(given), items(wanted), strict=False)
            return _first(misfit(item, part) for item, part in parts)
        case "tuple", _:
            return _misfit_struct(given, wanted)
        case "mapping" | "record", "PoseStamped" | "JointState":
            return None
        case "list" | "array" | "dict", name if name in STRUCTS and is_unknown(inside(given)):
            return None
    if "/" in wanted.name or "." in wanted.name:
        literal = given.name in ("tuple", "mapping", "record")
        return None if literal or _message(given.name) == _message(wanted.name) else clash
    return clash


def fits(given: Type, wanted: Type) -> bool:
    """Whether a value of one type may be read as another."""
    return misfit(given, wanted) is None


def _first(found: Iterable[Misfit | None]) -> Misfit | None:
    return next(filter(None, found), None)


def _misfit_choice(choice: Type | int | str, wanted: Type) -> Misfit | None:
    if isinstance(choice, Type) or isinstance(choice, str) == (wanted.name == "str"):
        return None
    return Misfit("type", Type("literal", (choice,)), wanted)


def _misfit_records(given: Type, wanted: Type) -> Misfit | None:
    """Fields that only the given record has are allowed; one that it lacks must be optional."""
    own = fields(given)
    for name, item in fields(wanted).items():
        if name not in own and item.name != "optional" and not is_unknown(item):
            return Misfit("type", given, wanted)
    return _first(misfit(own[name], item) for name, item in fields(wanted).items() if name in own)


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
        return _first(misfit(fromkey, item) for fromkey in dict.fromkeys(items(given)))
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


MOST_CHOICES = 16
"""The most constants of one literal type; with more, the type is `str` or `int`."""


def constants(choices: Iterable[int | str]) -> Type:
    """One of these constants."""
    found = tuple(sorted(set(choices), key=lambda choice: (str(choice), isinstance(choice, str))))
    type_ = Type("literal", found)
    return type_ if len(found) <= MOST_CHOICES else plain(type_)


def join(one: Type, other: Type) -> Type:
    """The least type that both fit; `any` where there is none."""
    if one == other:
        return one
    if is_unknown(one) or is_unknown(other):
        return ANY
    if "none" in (one.name, other.name):
        return optional(other if one == NONE else one)
    if "optional" in (one.name, other.name):
        return optional(join(present(one), present(other)))
    match sorted((one, other), key=lambda type_: type_.name):
        case [Type("literal") | Type("one_of"), Type("literal") | Type("one_of")]:
            return _join_choices(one, other)
        case [Type("int" | "float"), Type("int" | "float")]:
            return _join_numbers(one, other)
        case [Type("str"), Type("str")]:
            return _bounded(STR, one, other)
        case [Type("tuple"), Type("tuple")] if len(one.args) == len(other.args):
            return Type("tuple", tuple(map(join, items(one), items(other))))
        case [Type("mapping"), Type("mapping")] if one.args[::2] == other.args[::2]:
            return _join_fields(one, other)
        case [Type("record"), Type("record")] if fields(one).keys() == fields(other).keys():
            return _join_fields(one, other)
        case [Type("mapping"), Type("record")] | [Type("record"), Type("record")] if fits(
            one, other
        ) or fits(other, one):
            return other if fits(one, other) else one
        case [Type("tuple" | "list" | "array"), Type("tuple" | "list" | "array")]:
            return _join_lists(one, other)
        case [Type("dict" | "mapping" | "record"), Type("dict" | "mapping" | "record")]:
            return Type("dict", (join(_value(one), _value(other)),))
    for low, high in ((one, other), (other, one)):
        if fits(low, high):
            return high
    both = plain(one), plain(other)
    return ANY if both == (one, other) else join(*both)


def _join_choices(one: Type, other: Type) -> Type:
    both = [*one.args, *other.args]
    if one.name == other.name == "literal":
        return constants(value for value in both if isinstance(value, int | str))
    for low, high in ((one, other), (other, one)):
        if set(low.args) <= set(high.args) and high.name == "one_of":
            return high
    choices = sorted({value for value in both if isinstance(value, int | str)}, key=str)
    return Type("one_of", tuple(choices))


def _join_numbers(one: Type, other: Type) -> Type:
    name = "int" if one.name == other.name == "int" else "float"
    units = {unit_of(one), unit_of(other)} - {""}
    return Type(name, tuple(sorted(units))) if len(units) == 1 else Type(name)


def _join_fields(one: Type, other: Type) -> Type:
    """The join of two records or two mappings with the same fields."""
    own = fields(other)
    joins = ((name, join(item, own[name])) for name, item in fields(one).items())
    return Type(one.name, tuple(part for pair in joins for part in pair))


def _join_lists(one: Type, other: Type) -> Type:
    item = joined(item_of(type_) for type_ in (one, other) if length_of(type_) != 0)
    size = length_of(one)
    if size is not None and size == length_of(other):
        return Type("array", (item, size))
    return _bounded(Type("list", (item,)), one, other)


def _bounded(type_: Type, one: Type, other: Type) -> Type:
    """A text or list with the larger bound of two: like a unit, a bound holds where the other type
    has none."""
    bounds = [bound_of(one), bound_of(other)]
    most = max((bound for bound in bounds if bound is not None), default=None)
    return type_ if most is None else Type(type_.name, (*type_.args, most))


def joined(types: Iterable[Type]) -> Type:
    """The least type that all fit; `any` of none at all."""
    found = set(types)
    if len(found) > 1:
        return reduce(join, sorted(found, key=repr))
    return found.pop() if found else ANY


def item_of(type_: Type) -> Type:
    """What one finds in a list, going through it; `any` where it is no list."""
    match type_.name:
        case "tuple":
            return joined(items(type_))
        case "list" | "array":
            return inside(type_)
        case "mapping" | "record" | "str":
            return STR
        case "dict":
            return STR if type_.args else ANY  # keys of a bare dict may be of any type
        case "literal" | "one_of":
            return STR if all(isinstance(argument, str) for argument in type_.args) else ANY
    return ANY


def _value(type_: Type) -> Type:
    found = type_.name in ("mapping", "record")
    return joined(fields(type_).values()) if found else inside(type_)


def plain(type_: Type) -> Type:
    """A literal as the type that a script would write for it, one level deep."""
    match type_.name:
        case "literal" | "one_of":
            kinds = {STR if isinstance(argument, str) else INT for argument in type_.args}
            return kinds.pop() if len(kinds) == 1 else ANY
        case "tuple" if type_.args:
            return Type("array", (joined(items(type_)), len(type_.args)))
        case "tuple":
            return LIST
        case "mapping":
            return Type("dict", (_value(type_),)) if type_.args else DICT
    return type_


def widened(type_: Type) -> Type:
    """A type with the forms of literals in it as a script would write them."""
    if type_.name in ("literal", "tuple", "mapping"):
        return widened(plain(type_))
    return Type(type_.name, tuple(widened(a) if isinstance(a, Type) else a for a in type_.args))


def meet(one: Type, other: Type) -> Type:
    """The largest type that fits both, so that a key of it can be read as either; else `any`."""
    if is_unknown(one) or one == other:
        return other
    if is_unknown(other):
        return one
    if "optional" in (one.name, other.name):
        inner = meet(present(one), present(other))
        return optional(inner) if one.name == other.name else inner
    match one.name, other.name:
        case "int" | "float", "int" | "float" if fits(one, other) or fits(other, one):
            name = "int" if "int" in (one.name, other.name) else "float"
            unit = unit_of(one) or unit_of(other)
            return Type(name, (unit,) if unit else ())
        case "one_of", "one_of":
            common = tuple(argument for argument in one.args if argument in other.args)
            return Type("one_of", common) if common else ANY
        case "list" | "array", "list" | "array" if _same_size(one, other):
            size = length_of(one) if length_of(one) is not None else length_of(other)
            item = meet(inside(one), inside(other))
            if size is not None:
                return Type("array", (item, size))
            return LIST if item == ANY else _bounded(Type("list", (item,)), one, other)
        case "str", "str":
            return _bounded(STR, one, other)
        case "dict", "dict":
            item = meet(inside(one), inside(other))
            return DICT if item == ANY else Type("dict", (item,))
    return one if fits(one, other) else other if fits(other, one) else ANY


def _same_size(one: Type, other: Type) -> bool:
    own, due = length_of(one), length_of(other)
    return own is None or due is None or own == due


def settled(written: Type, read: Type) -> Type:
    """The type of a key from what is written to it and what it is read as (`meet`)."""
    if is_unknown(written):
        return read
    if is_unknown(read) or not fits(written, read):
        return widened(written)
    match written.name, read.name:
        case _, "optional" if written.name not in ("optional", "none"):
            return settled(written, inside(read))
        case "optional", "optional":
            return optional(settled(inside(written), inside(read)))
        case "literal" | "mapping", _:
            return read
        case "tuple", "list" | "array":
            item = settled(joined(items(written)), inside(read)) if written.args else inside(read)
            return Type("array", (item, len(written.args))) if written.args else read
        case "tuple", _:
            return read
        case "list" | "array", "list" | "array":
            return meet(
                Type(written.name, (settled(inside(written), inside(read)), *written.args[1:])),
                read,
            )
    return meet(written, read)


LONGEST_TUPLE = 64
"""The longest list whose items have separate types; the items of a longer one have one type."""

DEEPEST = 12
"""Levels of one type; what is deeper is `any`."""


def type_of_literal(value: bool | int | float | str | None) -> Type:
    """The type of a number, a text, true, false or null."""
    match value:
        case bool():
            return BOOL
        case int() | str():
            return Type("literal", (value,))
        case float():
            return FLOAT
    return NONE


def tuple_type(of: Iterable[Type], size: int) -> Type:
    """The type of a list of so many items; those of a long list are not kept one by one."""
    if size <= LONGEST_TUPLE:
        return Type("tuple", tuple(of))
    return Type("array", (widened(joined(of)), size))


def mapping_type(of: Iterable[tuple[str, Type]]) -> Type:
    """The type of a mapping with these keys; those of a large mapping are not kept one by one."""
    found = dict(of)
    if len(found) <= LONGEST_TUPLE:
        return mapping(found.items())
    return Type("dict", (widened(joined(found.values())),))
