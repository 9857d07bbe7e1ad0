"""Definitions of the messages, services and actions of ROS: fields with their types, constants."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, NamedTuple, TypeAlias

from smachac.diagnostics.source import NOWHERE, Span
from smachac.ir.types import ANY, Type
from smachac.records import dataclass, field

DefinitionKind: TypeAlias = Literal["msg", "srv", "action"]
"""The ending of the file of a definition, which is also the name of its folder."""

PARTS: dict[DefinitionKind, tuple[str, ...]] = {
    "msg": ("message",),
    "srv": ("request", "response"),
    "action": ("goal", "result", "feedback"),
}
"""The messages in one file of each kind, in their order."""

INTEGERS = frozenset(
    f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)
) | {"byte", "char"}  # fmt: skip
FLOATS = frozenset(["float32", "float64"])
TEXTS = frozenset(["string", "wstring"])
PRIMITIVES = INTEGERS | FLOATS | TEXTS | {"bool", "time", "duration"}
"""The types that are no messages; `time` and `duration` exist in ROS 1 only."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FieldType:
    """The type of a field: a primitive type, or the name of a message (`geometry_msgs/Pose`).

    `array`: the field is a list, of `size` items (None: any number) or of at most `most`.
    `longest`: the limit on the length of a string.
    """

    name: str
    array: bool = False
    size: int | None = None
    most: int | None = None
    longest: int | None = None

    def __str__(self) -> str:
        item = self.name if self.longest is None else f"{self.name}<={self.longest}"
        if not self.array:
            return item
        limit = f"<={self.most}" if self.most is not None else ""
        return f"{item}[{self.size if self.size is not None else limit}]"


@dataclass(frozen=True, slots=True, kw_only=True)
class MessageField:
    """A field of a message; `default` is the text of its default value (ROS 2), or empty."""

    name: str
    type: FieldType
    default: str = ""
    span: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class MessageConstant:
    """A constant of a message; `value` is its text."""

    name: str
    type: FieldType
    value: str
    span: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Message:
    """The fields and the constants of one message, in their order.

    `name` is that of its definition, for a message without definition of its own with the part:
    `std_srvs/Trigger.request`.
    """

    name: str
    fields: tuple[MessageField, ...] = ()
    constants: tuple[MessageConstant, ...] = ()

    def field(self, name: str) -> MessageField | None:
        return next((other for other in self.fields if other.name == name), None)


@dataclass(frozen=True, slots=True, kw_only=True)
class Definition:
    """The messages of one file: `PARTS` has their names. `span` is the beginning of the file."""

    package: str
    name: str
    kind: DefinitionKind
    messages: tuple[Message, ...]
    span: Span = field(default=NOWHERE, compare=False, repr=False)

    def part(self, name: str) -> Message:
        """The message of a name in `PARTS`. Raises ValueError if the kind has no such part."""
        return self.messages[PARTS[self.kind].index(name)]


Definitions: TypeAlias = "Mapping[tuple[DefinitionKind, str], tuple[Definition, ...]]"
"""By kind and name as in the script all definitions that were found: those of several versions of
ROS can differ. The messages in their fields are in it, too: `("msg", "geometry_msgs/Pose")`."""


class Missing(NamedTuple):
    """A type that its package does not have: the names of the types of that kind that the package
    has, the kind of its type with this name, and the common packages that have such a type."""

    names: tuple[str, ...]
    other: DefinitionKind | None = None
    packages: tuple[str, ...] = ()


MissingDefinitions: TypeAlias = "Mapping[tuple[DefinitionKind, str], Missing]"
"""The types of a script that their packages do not have, by kind and name as in the script."""


OtherTypes: TypeAlias = "Mapping[tuple[str, tuple[str, ...]], str]"
"""By the name of a type in a script, and fields that its message does not have, the only type of
the same package that has them all."""


def userdata_type(wanted: FieldType) -> Type:
    """The type of userdata whose values fit a field; `any` where Python has several such types."""
    if wanted.name in ("uint8", "byte", "char") and wanted.array:
        return ANY  # a list of numbers or bytes
    if wanted.name == "bool":
        item = Type("bool")
    elif wanted.name in INTEGERS:
        item = Type("int")
    elif wanted.name in FLOATS:
        item = Type("float")
    elif wanted.name in TEXTS:
        item = Type("str")
    elif wanted.name in PRIMITIVES:
        return ANY  # times are numbers or objects
    else:
        item = Type(wanted.name)
    if not wanted.array:
        return item
    return Type("array", (item, wanted.size)) if wanted.size is not None else Type("list", (item,))
