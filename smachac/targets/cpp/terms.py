"""Terms: the parts of an expression with their types, and their C++ text for a wanted type.

Terms have more types than scripts: `number` is a float that may be an `int` in Python, where `1`
and `1.0` are equal but print differently; `tuple` is a kind of list; `range`; `never` is the type
of the items of an empty list; `mixed` has no type in C++, and its argument is the reason.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import reduce
from typing import NamedTuple

from smachac.ir.types import Type
from smachac.records import dataclass
from smachac.targets.cpp.dialect import CONVERT, FAULT, OPERATIONS, TEXT, UNBOUNDED
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
STRING = "std::string"
"""The type of a text in blocking machines."""

SURE = frozenset(["contains", "equal", "field", "length", "real", "truth", "with"])
"""The operations that cannot fail in a stepped machine."""

UNBOUNDED_CALLS = frozenset(["characters", "keys", "range", "repeat", "sorted", "text"])
"""The operations that need the heap."""

TERNARY, OR, AND, EQUALITY, RELATION, SUM, PRODUCT, SIGNED, POSTFIX = range(9)
"""The precedences of the operators of C++, lowest first."""


class CppText(NamedTuple):
    """C++ text and the precedence of its outermost operator. `digits`: it is an integer literal,
    whose type in C++ may be `int`."""

    text: str
    binding: int = POSTFIX
    digits: bool = False

    def at(self, binding: int) -> str:
        """The text as an operand: in brackets if its precedence is lower than `binding`."""
        return self.text if self.binding >= binding else f"({self.text})"


@dataclass(frozen=True, slots=True, kw_only=True)
class Term:
    """A part of an expression. `spell` returns its text as a value of a type, or raises
    UnportableError.

    `simple`: it is a name or a constant, which may be evaluated twice. `constant` is the value of a
    literal. `test` is the text of its truth value, if that is shorter than `spell`.
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
        """The text of the value of an optional; in C++ an error if there is none."""
        return self.spell(present(self.type)).at(TERNARY)


def call(name: str, *arguments: str) -> CppText:
    """A call of a function in the namespace for operations of Python, with marks."""
    if name in UNBOUNDED_CALLS:
        return hosted_call(name, *arguments)
    fault = "" if name in SURE else FAULT
    return CppText(f"{OPERATIONS}{name}({fault}{', '.join(arguments)})")


def hosted_call(name: str, *arguments: str) -> CppText:
    """A call of a function that needs the heap, or parts of the C library that read and write
    numbers: a stepped machine has neither."""
    return CppText(f"{UNBOUNDED}{OPERATIONS}{name}({', '.join(arguments)})")


def fixed(type_: Type, text: CppText, *, simple: bool = False) -> Term:
    """A term with one text, which is converted to other types."""
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
                text = TEXT + cpp_string(value).removeprefix(STRING)
                return converted(CppText(text), STR, wanted)
        if isinstance(value, float) or present(wanted).name in ("float", "number"):
            return converted(CppText(cpp_float(value), SIGNED), FLOAT, wanted)
        return converted(CppText(cpp_int(value), SIGNED, digits=True), own, wanted)

    return Term(type=own, spell=spell, simple=True, constant=value)


# Properties of types


def inside(type_: Type) -> Type:
    """The type of the items of a sequence or mapping, and of what is in an optional."""
    if type_ == RANGE:
        return INT
    first = type_.args[0] if type_.args else NEVER
    return first if isinstance(first, Type) else NEVER


def size_of(type_: Type) -> int | None:
    """The number of items of a sequence, if its type has a length."""
    size = type_.args[1] if type_.name in ("array", "tuple") and len(type_.args) > 1 else None
    return size if isinstance(size, int) else None


def present(type_: Type) -> Type:
    """The type without None."""
    if type_ == NONE:
        return NEVER
    return inside(type_) if type_.name == "optional" else type_


def number(type_: Type) -> Type | None:
    """The type of a value in arithmetic, where a bool is an `int`; None if it is no number."""
    type_ = present(type_)
    return INT if type_ == BOOL else type_ if type_.name in NUMBERS else None


def ground(type_: Type) -> Type:
    """The script type that represents a type of terms in C++."""
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
    """The C++ type of values of a type, with a mark if they need the heap."""
    return spelt(ground(type_))


def spelt(type_: Type) -> str:
    """The C++ type of a type of the script, with a mark if its values need the heap."""
    mark = UNBOUNDED if has(type_, "list") or has(type_, "dict") else ""
    return mark + cpp_type(type_).replace(STRING, TEXT)


def shown(type_: Type) -> str:
    """A type in a message. Raises UnportableError for `mixed`, with its reason."""
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
    """Whether a type is, or has in it, one of that name. Fields of records are not looked at: these
    have a class."""
    if type_.name == "struct":
        return name == "struct"
    return type_.name == name or any(has(a, name) for a in type_.args if isinstance(a, Type))


# Joins and conversions of types


def mixed(one: Type, other: Type) -> Type:
    reason = f"the value has one of two types, `{shown(one)}` or `{shown(other)}`"
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
    """Whether a value of one type converts to another, possibly with an error at run time."""
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
    """The text of a value, converted to a type. Raises UnportableError if it does not convert."""
    if own.name == "mixed" or wanted.name == "mixed":
        ground(own if own.name == "mixed" else wanted)
    if not convertible(own, wanted):
        raise UnportableError(f"the type is `{shown(own)}`, but `{shown(wanted)}` is required")
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
    return CppText(f"{CONVERT}<{cpp(wanted)}>({FAULT}{text.text})")
