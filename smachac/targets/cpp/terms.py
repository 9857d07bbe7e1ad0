"""Parts of an expression as C++: what each is, and its text wherever it is wanted.

Beside the types of the script there are `number`, a float that may be whole in Python, where `1`
and `1.0` are equal but print differently; `tuple`, a list of another kind; `range`; `never`, of the
items of an empty list; and `mixed`, that has no type in C++, with the reason.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import reduce
from typing import NamedTuple

from smachac.ir.types import Type
from smachac.targets.cpp.types import (
    FLOAT,
    INT,
    LISTED,
    NONE,
    STR,
    UnportableError,
    cpp_bool,
    cpp_float,
    cpp_int,
    cpp_string,
    cpp_type,
)

BOOL, NUMBER, NEVER, RANGE = map(Type, ("bool", "number", "never", "range"))
NUMBERS = ("int", "float", "number")
SEQUENCES = ("list", "array", "tuple", "range")
PY = "smachac::py::"

TERNARY, OR, AND, EQUALITY, RELATION, SUM, PRODUCT, SIGNED, POSTFIX = range(9)
"""How tightly a form of C++ binds."""


class CppText(NamedTuple):
    """C++ text, and how tightly it binds. `digits`: a literal that C++ gives the smallest type that
    holds it, which may be `int`."""

    text: str
    binding: int = POSTFIX
    digits: bool = False

    def at(self, binding: int) -> str:
        """The text where something that binds so tightly is due."""
        return self.text if self.binding >= binding else f"({self.text})"


@dataclass(frozen=True, slots=True, kw_only=True)
class Term:
    """A part of an expression. `spell` gives its text as a value of a type, or raises.

    `simple`: a name or a constant, that can be said twice. `constant` is the value of a literal.
    `test` is the text of its truth, where that is shorter than its value.
    """

    type: Type
    spell: Callable[[Type], CppText]
    simple: bool = False
    constant: bool | int | float | str | None = None
    test: CppText | None = None

    def text(self, binding: int = TERNARY) -> str:
        """The text as a value of its own type."""
        return self.spell(self.type).at(binding)

    def present(self) -> str:
        """The text of what is there; an error where nothing is."""
        return self.spell(present(self.type)).at(TERNARY)


def call(name: str, *arguments: str) -> CppText:
    """A call of a function of Python's."""
    return CppText(f"{PY}{name}({', '.join(arguments)})")


def fixed(type_: Type, text: CppText, *, simple: bool = False) -> Term:
    """A term with one text, which is converted where another type is wanted."""
    return Term(type=type_, spell=lambda wanted: converted(text, type_, wanted), simple=simple)


def literal(value: bool | int | float | str | None) -> Term:
    """A constant."""
    kinds = {bool: BOOL, int: INT, float: FLOAT, str: STR}
    own = kinds.get(type(value), NONE)

    def spell(wanted: Type) -> CppText:
        match value:
            case None:
                return converted(CppText("smachac::None{}"), NONE, wanted)
            case bool():
                return converted(CppText(cpp_bool(value)), BOOL, wanted)
            case str():
                return converted(CppText(cpp_string(value)), STR, wanted)
        if isinstance(value, float) or present(wanted).name in ("float", "number"):
            return converted(CppText(cpp_float(value), SIGNED), FLOAT, wanted)
        return converted(CppText(cpp_int(value), SIGNED, digits=True), own, wanted)

    return Term(type=own, spell=spell, simple=True, constant=value)


# What is known of a type


def inside(type_: Type) -> Type:
    """The type of the items of a sequence or mapping, and of what is in an optional."""
    if type_ == RANGE:
        return INT
    first = type_.args[0] if type_.args else NEVER
    return first if isinstance(first, Type) else NEVER


def size_of(type_: Type) -> int | None:
    """How many items a sequence has, where its type says so."""
    size = type_.args[1] if type_.name in ("array", "tuple") and len(type_.args) > 1 else None
    return size if isinstance(size, int) else None


def present(type_: Type) -> Type:
    """The type without None."""
    if type_ == NONE:
        return NEVER
    return inside(type_) if type_.name == "optional" else type_


def number(type_: Type) -> Type | None:
    """The type that arithmetic takes a value for; None where it is no number."""
    type_ = present(type_)
    return INT if type_ == BOOL else type_ if type_.name in NUMBERS else None


def ground(type_: Type) -> Type:
    """The type as C++ holds it."""
    match type_.name, type_.args:
        case "number", _:
            return FLOAT
        case "never", _:
            return INT
        case "range", _:
            return Type("list", (INT,))
        case "tuple", (Type() as item, int(size)):
            return Type("array", (ground(item), size))
        case "tuple", (Type() as item,):
            return Type("list", (ground(item),))
        case "mixed", (str(reason),):
            raise UnportableError(reason)
    args = tuple(ground(arg) if isinstance(arg, Type) else arg for arg in type_.args)
    return Type(type_.name, args)


def cpp(type_: Type) -> str:
    return cpp_type(ground(type_))


def shown(type_: Type) -> str:
    """A type in a message. Of a value that has none, the reason why is all there is to say."""
    match type_.name, type_.args:
        case "number", _:
            return "float"
        case "tuple", (Type() as item, *_):
            return f"tuple of {shown(item)}"
        case (("list" | "array"), (Type(name="never"), *_)):
            return "empty list"
        case "mixed", (str(reason),):
            raise UnportableError(reason)
    return str(type_)


def has(type_: Type, name: str) -> bool:
    """Whether a type is, or has in it, one of that name."""
    return type_.name == name or any(has(a, name) for a in type_.args if isinstance(a, Type))


# What fits what


def mixed(one: Type, other: Type) -> Type:
    reason = f"a value is one of two types here, `{shown(one)}` and `{shown(other)}`"
    return Type("mixed", (reason,))


def join(one: Type, other: Type) -> Type:
    """The type that holds values of both; `mixed` where there is none."""
    if one == other or other == NEVER:
        return one
    if one == NEVER:
        return other
    if "mixed" in (one.name, other.name):
        return one if one.name == "mixed" else other
    if "none" in (one.name, other.name) or "optional" in (one.name, other.name):
        inner = join(present(one), present(other))
        return inner if inner.name == "mixed" else Type("optional", (inner,))
    if one.name in NUMBERS and other.name in NUMBERS:
        return NUMBER
    kinds = {one.name, other.name}
    if kinds <= {"list", "array"} or kinds == {"tuple"}:
        return sequence(one, other)
    if kinds == {"dict"}:
        inner = join(inside(one), inside(other))
        return inner if inner.name == "mixed" else Type("dict", (inner,))
    return mixed(one, other)


def sequence(one: Type, other: Type) -> Type:
    """The type of either of two lists, or of two tuples."""
    inner = join(inside(one), inside(other))
    if inner.name == "mixed":
        return inner
    kind = "tuple" if one.name == "tuple" else "list"
    size = size_of(one)
    if size is not None and size == size_of(other):
        return Type("array" if kind == "list" else kind, (inner, size))
    return Type(kind, (inner,))


def joined(types: list[Type]) -> Type:
    return reduce(join, types, NEVER)


def convertible(own: Type, wanted: Type) -> bool:
    """Whether a value can become one of another type, or say at run time why it cannot."""
    if own in (wanted, NEVER):
        return True
    if wanted.name == "optional":
        return own == NONE or convertible(present(own), inside(wanted))
    if own.name == "optional":
        return convertible(inside(own), wanted)
    if wanted.name in ("float", "number"):
        return own.name in NUMBERS
    if wanted.name in ("list", "array", "tuple") and own.name in SEQUENCES:
        sizes = {size_of(own), size_of(wanted)} - {None}
        return len(sizes) < 2 and convertible(inside(own), inside(wanted))
    if own.name == wanted.name == "dict":
        return convertible(inside(own), inside(wanted))
    if wanted.name in LISTED[:2] and own.name in SEQUENCES:
        fits = size_of(own) in (None, 3 if wanted.name == "Point" else 4)
        return fits and convertible(inside(own), FLOAT)
    return False


def converted(text: CppText, own: Type, wanted: Type) -> CppText:
    """The text of a value as one of another type. Raises UnportableError where it can be none."""
    if own.name == "mixed" or wanted.name == "mixed":
        ground(own if own.name == "mixed" else wanted)
    if not convertible(own, wanted):
        raise UnportableError(f"this is a `{shown(own)}`, and a `{shown(wanted)}` is wanted")
    if cpp(own) == cpp(wanted):
        return text
    if own == NONE:
        return CppText(f"{cpp(wanted)}{{}}")
    if wanted.name == "optional" and cpp(own) == cpp(inside(wanted)):
        return CppText(f"{cpp(wanted)}({text.text})")
    if own.name == "optional" and cpp(inside(own)) == cpp(wanted):
        return call("present", text.text)
    if own == INT and wanted.name in ("float", "number"):
        return call("widen", text.text)
    return CppText(f"smachac::convert<{cpp(wanted)}>({text.text})")
