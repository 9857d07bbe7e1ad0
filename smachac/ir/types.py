"""Types of userdata. `any` is the unknown type: it is compatible with every type.

The notation is grammars/type.lark; `str(type)` prints it and `parse_type` parses it.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

from smachac.grammars import parser_of

if TYPE_CHECKING:
    pass

LONGEST = 1000
"""Limit on the length of a type, in characters."""

DEEPEST = 50
"""Limit on the applications (`list[...]`, `?`, `of`, `{...}`) in one type."""

SCALARS = ("bool", "int", "float", "str", "any", "none")
STRUCTS = ("Point", "Quaternion", "Pose", "PoseStamped", "Transform", "JointState")
WORDS = (*SCALARS, *STRUCTS, "list", "dict")
"""The types with one-word names. A word with `/` or `.` is a type of ROS or of a program: only its
name is known."""

_WORD = re.compile(r"[^\W\d]\w*(?:[./-]\w+)*")
_QUANTITY = re.compile(r'(float|int)<([^<>\[\]",?\s]+)>')


class Type(NamedTuple):
    """A type: a name and its arguments. A tuple, because types are compared and hashed often.

    `float<rad>` is `Type("float", ("rad",))`, `list[T]` is `Type("list", (T,))`, `T[7]` is
    `Type("array", (T, 7))`, `dict[str, T]` is `Type("dict", (T,))`, `T?` is `Type("optional",
    (T,))`, `one_of[a, b]` is `Type("one_of", ("a", "b"))`, the record `{x: T, y: U}` is
    `Type("record", ("x", T, "y", U))`; any other type is a name alone (`bool`, `Pose`,
    `geometry_msgs/Pose`). The bound of a text or list is its last argument: `str<=32` is
    `Type("str", (32,))`, `list[T]<=8` is `Type("list", (T, 8))`. The target `cpp` has its own types
    beside these (targets/cpp): a record with its class, `Type("struct", ("Part", "x", T, "y", U))`.
    """

    name: str
    args: tuple[Type | int | str, ...] = ()

    def __str__(self) -> str:
        match self.name, self.args:
            case "list", (item, *bound):
                return f"list[{item}]{f'<={bound[0]}' if bound else ''}"
            case "str", (bound,):
                return f"str<={bound}"
            case "array", (item, size):
                return f"{item}[{size}]"
            case "dict", (item,):
                return f"dict[str, {item}]"
            case "optional", (item,):
                return f"{item}?"
            case "one_of", choices:
                return f"one_of[{', '.join(map(_choice, choices))}]"
            case "record", parts if parts:
                pairs = zip(parts[::2], parts[1::2], strict=True)
                return "{" + ", ".join(f"{_choice(name)}: {type_}" for name, type_ in pairs) + "}"
            case (("struct" | "class"), (class_, *_)):
                return str(class_).removeprefix("::")
            case name, (unit,):
                return f"{name}<{unit}>"
        return self.name


ANY = Type("any")


def _choice(choice: Type | int | str) -> str:
    if isinstance(choice, str) and _WORD.fullmatch(choice) is None:
        import json

        return json.dumps(choice, ensure_ascii=False)
    return str(choice)


# Cached, because scripts and interfaces repeat few types: without, a check of 1,000 states whose
# keys have types takes 45 % more instructions.
@lru_cache(maxsize=1000)
def parse_type(text: str) -> Type | None:
    """The type of a text; None if the text is no type, is too long or too deep.

    The notation of old meta blocks is accepted too: `list of str`, `dict of str`, and `[function,
    str]`, which is `any`.
    """
    text = text.strip()
    if _WORD.fullmatch(text):
        return Type(text) if text != "one_of" else None
    number = _QUANTITY.fullmatch(text)
    if number is not None:  # a check of a short script often needs no parser beside these
        return Type(number[1], (number[2],))
    depth = text.count("[") + text.count("?") + text.count(" of ") + text.count("{")
    if len(text) > LONGEST or depth > DEEPEST:
        return None
    from smachac.grammars.standalone.lalr import LarkError

    try:
        found: Any = parser_of("type", _TypeBuilder).parse(text)
        return _complete(found)
    except (LarkError, ValueError):
        return None


def _complete(type_: Type) -> Type:
    """A type that needs no further arguments. Raises ValueError."""
    if type_ == Type("one_of"):
        raise ValueError("one of what?")
    return type_


class Bounds(NamedTuple):
    """The bounds of texts (bytes of UTF-8) and lists (items) that have none of their own; 0: none.
    Only stepped machines in C++ need them."""

    text: int = 0
    list: int = 0


class CppClass(NamedTuple):
    """A class of C++ for values of a type: its qualified name, and the header to include."""

    name: str
    header: str


MOST_BOUND = 65535
"""The largest bound: sizes have 16 bits."""


def bound_of(type_: Type) -> int | None:
    """The bound of a text (bytes of UTF-8) or a list (items), if its type has one."""
    last = type_.args[-1] if type_.args and type_.name in ("str", "list") else None
    return last if isinstance(last, int) else None


def optional(type_: Type) -> Type:
    """The type extended by None."""
    return type_ if type_.name in ("optional", "any", "none") else Type("optional", (type_,))


def unknown_words(type_: Type) -> tuple[str, ...]:
    """The words in a type that are no types; for compatibility they count as `any`."""
    inner = [arg for arg in type_.args if isinstance(arg, Type)]
    found = tuple(word for arg in inner for word in unknown_words(arg))
    if type_.args or type_.name in WORDS or re.search("[./]", type_.name):
        return found
    return (type_.name, *found)


class _TypeBuilder:
    """The type of each grammar rule, made from its parts. Raises ValueError if they do not fit."""

    def word(self, found: list[Any]) -> Type:
        return Type(str(found[0]))

    def quantity(self, found: list[Any]) -> Type:
        word, unit = map(str, found)
        if word not in ("float", "int"):
            raise ValueError("only numbers have units")
        return Type(word, (unit,))

    def of(self, found: list[Any]) -> Type:
        word, of, item = found
        if of != "of" or word not in ("list", "dict"):
            raise ValueError("neither `list of` nor `dict of`")
        return Type(str(word), (_complete(item),))

    def applied(self, found: list[Any]) -> Type:
        match found:
            case [Type("list", ()), Type() as item]:
                return Type("list", (_complete(item),))
            case [Type("dict", ()), Type("str", ()), Type() as item]:
                return Type("dict", (_complete(item),))
            case [Type("one_of", ()), *choices]:
                return Type("one_of", tuple(map(self.choice, choices)))
            case [Type() as item, int(size)] if size >= 0:
                return Type("array", (_complete(item), size))
        raise ValueError("nothing takes these in brackets")

    def choice(self, found: Type | int | str) -> int | str:
        if not isinstance(found, Type):
            return found
        if found.args:
            raise ValueError("a choice is a word or a whole number")
        return found.name

    def bounded(self, found: list[Any]) -> Type:
        type_, bound = found[0], self.integer(found[1:])
        if bound > 0 and (type_ == Type("str") or (type_.name == "list" and len(type_.args) == 1)):
            return Type(type_.name, (*type_.args, bound))
        raise ValueError("only texts and lists have a bound")

    def optional(self, found: list[Any]) -> Type:
        return Type("optional", (_complete(found[0]),))

    def record(self, found: list[Any]) -> Type:
        names = [name for name, _ in found]
        if len(set(names)) < len(names):
            raise ValueError("two fields have one name")
        return Type("record", tuple(part for name, type_ in found for part in (name, type_)))

    def field(self, found: list[Any]) -> tuple[str, Type]:
        name, type_ = found
        return name, _complete(type_)

    def field_name(self, found: list[Any]) -> str:
        return str(found[0])

    def either(self, found: list[Any]) -> Type:
        return ANY

    def integer(self, found: list[Any]) -> int:
        return int(found[0])

    def string(self, found: list[Any]) -> str:
        import json

        return str(json.loads(found[0]))


EXAMPLES = {"float": "1.5", "int": "3", "bool": "true", "str": "text"}
"""A value of each simple type, as a script writes it."""
