"""One type from several: what all of them fit, what fits all of them, and the type of a key."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache, reduce

from smachac.ir.fitting import (
    DICT,
    INT,
    LIST,
    NONE,
    STR,
    fields,
    fits,
    inside,
    is_open,
    items,
    length_of,
    present,
    record,
    unit_of,
)
from smachac.ir.types import ANY, Type, optional

MOST_CHOICES = 16
"""Constants that one literal type tells apart; more are a `str` or an `int`."""


def constants(choices: Iterable[int | str]) -> Type:
    """One of these constants."""
    found = tuple(sorted(set(choices), key=lambda each: (str(each), isinstance(each, str))))
    type_ = Type("literal", found)
    return type_ if len(found) <= MOST_CHOICES else plain(type_)


@lru_cache(maxsize=10_000)
def join(one: Type, other: Type) -> Type:
    """The least type that both fit; `any` where there is none."""
    if one == other:
        return one
    if is_open(one) or is_open(other):
        return ANY
    if "none" in (one.name, other.name):
        return optional(other if one == NONE else one)
    if "optional" in (one.name, other.name):
        return optional(join(present(one), present(other)))
    match sorted((one, other), key=lambda each: each.name):
        case [Type("literal") | Type("one_of"), Type("literal") | Type("one_of")]:
            return _join_choices(one, other)
        case [Type("int" | "float"), Type("int" | "float")]:
            return _join_numbers(one, other)
        case [Type("tuple"), Type("tuple")] if len(one.args) == len(other.args):
            return Type("tuple", tuple(map(join, items(one), items(other))))
        case [Type("record"), Type("record")] if one.args[::2] == other.args[::2]:
            own = fields(other)
            return record((name, join(item, own[name])) for name, item in fields(one).items())
        case [Type("tuple" | "list" | "array"), Type("tuple" | "list" | "array")]:
            return _join_lists(one, other)
        case [Type("record" | "dict"), Type("record" | "dict")]:
            return Type("dict", (join(_value(one), _value(other)),))
    for low, high in ((one, other), (other, one)):
        if fits(low, high):
            return high
    both = plain(one), plain(other)
    return ANY if both == (one, other) else join(*both)


def _join_choices(one: Type, other: Type) -> Type:
    both = [*one.args, *other.args]
    if one.name == other.name == "literal":
        return constants(each for each in both if isinstance(each, int | str))
    for low, high in ((one, other), (other, one)):
        if set(low.args) <= set(high.args) and high.name == "one_of":
            return high
    choices = sorted({each for each in both if isinstance(each, int | str)}, key=str)
    return Type("one_of", tuple(choices))


def _join_numbers(one: Type, other: Type) -> Type:
    name = "int" if one.name == other.name == "int" else "float"
    units = {unit_of(one), unit_of(other)} - {""}
    return Type(name, tuple(sorted(units))) if len(units) == 1 else Type(name)


def _join_lists(one: Type, other: Type) -> Type:
    item = joined(item_of(each) for each in (one, other) if length_of(each) != 0)
    size = length_of(one)
    if size is not None and size == length_of(other):
        return Type("array", (item, size))
    return Type("list", (item,))


def joined(types: Iterable[Type]) -> Type:
    """The least type that all fit; `any` of none at all."""
    found = sorted(set(types), key=repr)
    return reduce(join, found) if found else ANY


def item_of(type_: Type) -> Type:
    """What one finds in a list, going through it; `any` where it is no list."""
    match type_.name:
        case "tuple":
            return joined(items(type_))
        case "list" | "array":
            return inside(type_)
        case "record" | "dict" | "str":
            return STR
        case "literal" | "one_of":
            return STR if all(isinstance(each, str) for each in type_.args) else ANY
    return ANY


def _value(type_: Type) -> Type:
    return joined(fields(type_).values()) if type_.name == "record" else inside(type_)


def plain(type_: Type) -> Type:
    """A literal as the type that a script would write for it, one level deep."""
    match type_.name:
        case "literal" | "one_of":
            kinds = {STR if isinstance(each, str) else INT for each in type_.args}
            return kinds.pop() if len(kinds) == 1 else ANY
        case "tuple" if type_.args:
            return Type("array", (joined(items(type_)), len(type_.args)))
        case "tuple":
            return LIST
        case "record":
            return Type("dict", (_value(type_),)) if type_.args else DICT
    return type_


@lru_cache(maxsize=10_000)
def widened(type_: Type) -> Type:
    """A type with the forms of literals in it as a script would write them."""
    if type_.name in ("literal", "tuple", "record"):
        return widened(plain(type_))
    return Type(type_.name, tuple(widened(a) if isinstance(a, Type) else a for a in type_.args))


def meet(one: Type, other: Type) -> Type:
    """The largest type that fits both, so that a key of it can be read as either; else `any`."""
    if is_open(one) or one == other:
        return other
    if is_open(other):
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
            common = tuple(each for each in one.args if each in other.args)
            return Type("one_of", common) if common else ANY
        case "list" | "array", "list" | "array" if _same_size(one, other):
            size = length_of(one) if length_of(one) is not None else length_of(other)
            item = meet(inside(one), inside(other))
            if size is not None:
                return Type("array", (item, size))
            return LIST if item == ANY else Type("list", (item,))
        case "dict", "dict":
            item = meet(inside(one), inside(other))
            return DICT if item == ANY else Type("dict", (item,))
    return one if fits(one, other) else other if fits(other, one) else ANY


def _same_size(one: Type, other: Type) -> bool:
    own, due = length_of(one), length_of(other)
    return own is None or due is None or own == due


def settled(written: Type, read: Type) -> Type:
    """The type of a key from what is written to it and what it is read as (`meet`)."""
    if is_open(written):
        return read
    if is_open(read) or not fits(written, read):
        return widened(written)
    match written.name, read.name:
        case _, "optional" if written.name not in ("optional", "none"):
            return settled(written, inside(read))
        case "optional", "optional":
            return optional(settled(inside(written), inside(read)))
        case "literal" | "record", _:
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
