"""Types of stepped machines: texts and lists have a bound, and lie in the machine object.

| script             | storage                    | in expressions     |
| `str<=32`          | `text` of 32 bytes         | `str`              |
| `list[T]<=8`       | `bounded` list of 8 items  | `list[T]`          |
| `PoseStamped`      | `stamped`, with such a text| `PoseStamped`      |

The types in the second column exist only here. Other types are the same in both.
"""

from __future__ import annotations

from smachac.ir.types import MOST_BOUND, Bounds, Type, bound_of
from smachac.targets.cpp.types import STR, UnportableError, fields_of, plain


def bounded(type_: Type, bounds: Bounds) -> Type:
    """The storage of a type of the script in a stepped machine. Raises UnportableError for a type
    without a bound, and for types that need the heap."""
    own = bound_of(type_)
    match type_.name, type_.args:
        case "str", _:
            return Type("text", (_bound(type_, own or bounds.text, "str<=32"),))
        case "one_of" | "literal", choices:
            texts = [choice for choice in choices if isinstance(choice, str)]
            if texts:
                return Type("text", (max(len(text.encode()) for text in texts),))
            return plain(type_)
        case "list", (Type() as item, *_):
            size = _bound(type_, own or bounds.list, f"{type_.name}[{item}]<=8")
            return Type("bounded", (bounded(item, bounds), size))
        case "array", (Type() as item, int(size)):
            return Type("array", (bounded(item, bounds), size))
        case "optional", (Type() as item,):
            return Type("optional", (bounded(item, bounds),))
        case "PoseStamped", _:
            return Type("stamped", (_bound(type_, bounds.text, ""),))
        case "struct", (str(class_), *parts):
            fields = (bounded(part, bounds) if isinstance(part, Type) else part for part in parts)
            return Type("struct", (class_, *fields))
        case "class", _:
            return type_
        case (("dict" | "JointState" | "any"), _):
            raise UnportableError(
                f"`{type_}` has no bound, and a stepped machine has no heap", help=_OTHER
            )
    found = plain(type_)
    if found.name in ("any", "list", "dict"):
        message = f"`{type_}` has no bound, and a stepped machine has no heap"
        raise UnportableError(message, help=_OTHER)
    return found


_OTHER = "declare a type with a size that is known, such as `float[7]` or `list[Pose]<=8`"


def _bound(type_: Type, bound: int, example: str) -> int:
    if not bound:
        setting = "`bounds = {text = 32, list = 8}` in smachac.toml"
        help_ = f"write `{example}`, or {setting}" if example else f"write {setting}"
        message = f"`{type_}` has no bound, and a stepped machine has no heap"
        raise UnportableError(message, help=help_)
    if bound > MOST_BOUND:
        raise UnportableError(f"the bound of `{type_}` is larger than {MOST_BOUND}")
    return bound


def loose(type_: Type) -> Type:
    """The type of a stored value in expressions and for classes of the user: without its bound."""
    match type_.name, type_.args:
        case "text", _:
            return STR
        case "stamped", _:
            return Type("PoseStamped")
        case "bounded", (Type() as item, _):
            return Type("list", (loose(item),))
        case (("array" | "optional"), (Type() as item, *rest)):
            return Type(type_.name, (loose(item), *rest))
        case "struct", args:
            return Type(
                "struct", tuple(loose(arg) if isinstance(arg, Type) else arg for arg in args)
            )
    return type_


def is_loose(type_: Type) -> bool:
    """Whether the storage of a type has a bound that its type in expressions has not."""
    return loose(type_) != type_


def has_bound(type_: Type) -> bool:
    """Whether a text or list with a bound is in a stored type."""
    return type_.name in ("text", "bounded", "stamped") or any(
        has_bound(arg) for arg in type_.args if isinstance(arg, Type)
    )


def most_bytes(type_: Type) -> int:
    """An upper limit on the size of a value of a stored type, with pointers and numbers of 8
    bytes."""
    match type_.name, type_.args:
        case "text", (int(size),):
            return 16 + _rounded(size)
        case "stamped", (int(size),):
            return 16 + _rounded(size) + 8 + 56
        case "bounded", (Type() as item, int(size)):
            return 16 + size * _rounded(most_bytes(item))
        case "array", (Type() as item, int(size)):
            return _rounded(max(size, 1) * most_bytes(item))
        case "optional", (Type() as item,):
            return 8 + _rounded(most_bytes(item))
        case "struct", _:
            return sum(_rounded(most_bytes(part)) for part in fields_of(type_).values())
    return {"Point": 24, "Quaternion": 32, "Pose": 56, "Transform": 56, "bool": 1}.get(
        type_.name, 8
    )


def _rounded(size: int) -> int:
    """A size with the gap before the next object of 8 bytes."""
    return -(-size // 8) * 8
