"""What Python's operations take: the kinds of values, and what fails whatever the values are.

Types are told apart only as far as Python does; of what it is not certain of, it says nothing.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from smachac.ir.expression_types import ATTRIBUTES
from smachac.ir.types import Type

Kinds = frozenset[str]

ANYTHING: Kinds = frozenset()
"""The kinds of a value of which nothing is known."""

_KINDS: Mapping[str, Kinds] = {
    **dict.fromkeys(("bool", "int", "float"), frozenset(["number"])),
    "str": frozenset(["text"]),
    "none": frozenset(["nothing"]),
    **dict.fromkeys(("list", "array", "tuple"), frozenset(["list"])),
    **dict.fromkeys(("dict", "record"), frozenset(["mapping"])),
    **dict.fromkeys(ATTRIBUTES, frozenset(["struct"])),
}

_BUILT_IN: Mapping[str, tuple[type, ...]] = {
    "number": (int, float),
    "text": (str,),
    "nothing": (type(None),),
    "list": (list, tuple, range),
    "mapping": (dict,),
}
"""The classes of Python that values of a kind may have. A struct may be a list or an object."""


def kinds(type_: Type) -> Kinds:
    """The kinds that a value of a type can have: `number`, `text`, `list`, `mapping`, `struct`,
    `nothing`. None at all where it is not known, as of `T?`, which is mostly asked before."""
    if type_.name in ("literal", "one_of"):
        return frozenset("text" if isinstance(each, str) else "number" for each in type_.args)
    return _KINDS.get(type_.name, ANYTHING)


def fails(word: str, left: Type, right: Type) -> bool:
    """Whether an operation or comparison of two values fails, whichever they are."""
    pairs = [(one, other) for one in kinds(left) for other in kinds(right)]
    return bool(pairs) and not any(_works(word, *pair) for pair in pairs)


_ALIKE: Mapping[str, tuple[str, ...]] = {
    "+": ("number", "text", "list"),
    **dict.fromkeys(("<", "<=", ">", ">="), ("number", "text", "list")),
}


def _works(word: str, one: str, other: str) -> bool:
    """Whether two kinds go together in an operation."""
    if word in ("in", "not in"):
        if other == "text":
            return one == "text"
        return other in ("list", "struct") or (other == "mapping" and one != "mapping")
    if word in ("==", "!="):
        return True
    if word == "%" and one == "text":
        # Python fills in texts so.
        return True
    if "struct" in (one, other):
        # It may be an object, such as an array, that can do what lists cannot.
        return {one, other} <= {"struct", "list", "number"}
    if word == "*" and {one, other} in ({"number", "text"}, {"number", "list"}):
        return True
    return one == other and one in _ALIKE.get(word, ("number",))


def never_equal(left: Type, right: Type) -> bool:
    """Whether two values differ, whichever they are. One that may be nothing is not judged, as a
    state may have its turn before the value comes."""
    enumerations = {"one_of", "literal"}
    if "one_of" in (left.name, right.name) and {left.name, right.name} <= enumerations:
        return not any(one == other for one in left.args for other in right.args)
    one, other = kinds(left), kinds(right)
    unsure = {"nothing", "struct"}
    return bool(one and other) and not (one & other or (one | other) & unsure)


def can_be_negated(type_: Type) -> bool:
    """Whether some value of a type takes a sign."""
    found = kinds(type_)
    return not found or bool(found & {"number", "struct"})


def can_be_called(type_: Type) -> bool:
    found = kinds(type_)
    return not found or "struct" in found


def has_attribute(type_: Type, name: str) -> bool:
    """Whether some value of a type may have an attribute."""
    if type_.name in ATTRIBUTES:
        return name.startswith("_") or name in ATTRIBUTES[type_.name]
    found = kinds(type_)
    return not found or any(hasattr(each, name) for kind in found for each in _BUILT_IN[kind])


def can_be_indexed(owner: Type, index: Type) -> bool:
    """Whether some value of a type can be asked for an item of some such number or name."""
    known, wanted = kinds(owner), kinds(index)
    if not known or "struct" in known:
        return True
    if not known & {"text", "list", "mapping"}:
        return False
    if not wanted or "struct" in wanted:
        return True
    # What the mappings of a script are asked by is text.
    named = owner.name == "record" or bool(owner.args)
    by_number = bool(known & {"text", "list"}) or not named
    return (by_number and "number" in wanted) or ("mapping" in known and "text" in wanted) or (
        "mapping" in known and not named and bool(wanted - {"list", "mapping"})
    )  # fmt: skip


class Signature(NamedTuple):
    """What a function of Python takes: how many arguments, which keywords, and the kinds of value
    that its first argument may be where it is alone (`many`: at all)."""

    least: int
    most: int
    keywords: tuple[str, ...] = ()
    kinds: Kinds = ANYTHING
    many: Kinds = ANYTHING


_ITEMS = frozenset(["text", "list", "mapping", "struct"])
_NUMBER = frozenset(["number", "struct"])
_PARSED = frozenset(["number", "text", "struct"])
_MANY = 1_000_000

SIGNATURES: Mapping[str, Signature] = {
    "abs": Signature(1, 1, (), _NUMBER, _NUMBER),
    "bool": Signature(0, 1),
    "float": Signature(0, 1, (), _PARSED, _PARSED),
    "int": Signature(0, 2, ("base",), _PARSED, _PARSED),
    "len": Signature(1, 1, (), _ITEMS, _ITEMS),
    "list": Signature(0, 1, (), _ITEMS, _ITEMS),
    "max": Signature(1, _MANY, ("default", "key"), _ITEMS),
    "min": Signature(1, _MANY, ("default", "key"), _ITEMS),
    "range": Signature(1, 3, (), _NUMBER, _NUMBER),
    "round": Signature(1, 2, ("ndigits", "number"), _NUMBER, _NUMBER),
    "sorted": Signature(1, 1, ("key", "reverse"), _ITEMS, _ITEMS),
    "str": Signature(0, 3, ("object", "encoding", "errors")),
    "sum": Signature(1, 2, ("start",), _ITEMS, _ITEMS),
    "tuple": Signature(0, 1, (), _ITEMS, _ITEMS),
}
"""The functions that every expression may call (evaluate.py), but for `dict`, which takes much."""
