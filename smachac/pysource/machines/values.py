"""Abstract values of the partial evaluator: a value is known, one of a few, or unknown.

What code can change (lists, dictionaries, objects, namespaces) keeps its contents in `slots`, which
only `heap.Heap` writes, so that the two branches of an unknown condition can be joined.
"""

from __future__ import annotations

import ast
import itertools
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, Protocol, TypeAlias

from smachac.diagnostics.source import Span
from smachac.records import dataclass, field

if TYPE_CHECKING:
    from smachac.pysource.modules.source import PythonText

MOST_ALTERNATIVES = 8
"""The most values of which one is known to be right; more are unknown."""

Slots: TypeAlias = "dict[Any, Any]"
"""The contents of an object by name: attributes, items, or names of a module."""

_BIRTHS = itertools.count()


class OwnSlots(dict[Any, Any]):
    """The slots of an object that the code makes; of two objects, the later one has the larger
    `born`. `cls` is the class whose attributes count where the object has none."""

    __slots__ = ("born", "cls")

    def __init__(self, contents: Mapping[Any, Any], cls: Class | None = None) -> None:
        super().__init__(contents)
        self.born = next(_BIRTHS)
        self.cls = cls

    def inherited(self, key: Any, default: Any) -> Any:
        """The attribute of the class; a method is not known, as it would have to be bound."""
        for cls in (self.cls, *self.cls.order) if self.cls is not None else ():
            if isinstance(cls, Unknown):
                return UNKNOWN
            if isinstance(cls, Class) and key in cls.slots:
                return UNKNOWN if isinstance(cls.slots[key], Function) else cls.slots[key]
        return default


def newest() -> int:
    """A number that is larger than `born` of all slots that there are, and not larger than that of
    later ones."""
    return next(_BIRTHS)


@dataclass(frozen=True, slots=True, kw_only=True)
class Unknown:
    """A value that is not known, with the reason and the place, if there is one to tell."""

    reason: str = field(default="", compare=False)
    span: Span | None = field(default=None, compare=False)


UNKNOWN = Unknown()


@dataclass(frozen=True, slots=True, kw_only=True)
class OpenText(Unknown):
    """A text with a part that is not known, but the same wherever it is used: that of a parameter.
    `text` has the name of the parameter in braces: `GO_TO_{place}`."""

    text: str

    @property
    def start(self) -> str:
        """The part before the first open part, with which each text begins that this can be."""
        return self.text.partition("{")[0]


@dataclass(frozen=True, slots=True, kw_only=True)
class Adjustable(Unknown):
    """The value of a parameter of an object that the user of a machine can change, and what it is
    without that."""

    owner: Instance
    name: str
    default: Value


def open_text(text: str) -> Value:
    """A text with an open part, if it is no longer than a name."""
    return OpenText(text=text) if len(text) <= LONGEST_NAME else UNKNOWN


LONGEST_NAME = 200
"""The most characters of a text with an open part."""


@dataclass(frozen=True, slots=True)
class Const:
    """A number, text, truth value or None, at the place where it is written."""

    value: bool | int | float | str | bytes | complex | None
    span: Span | None = field(default=None, compare=False)


NONE = Const(None)


@dataclass(frozen=True, slots=True)
class OneOf:
    """One of a few values: different ones after an unknown condition."""

    values: tuple[Value, ...]


@dataclass(frozen=True, slots=True)
class TupleValue:
    """A tuple."""

    items: tuple[Value, ...]
    span: Span | None = field(default=None, compare=False)


@dataclass(eq=False, slots=True)
class ListValue:
    """A list or a set; its slot `items` is a tuple of values, or UNKNOWN."""

    slots: Slots
    span: Span | None = None
    kind: str = "list"

    def __post_init__(self) -> None:
        self.slots = OwnSlots(self.slots)

    @property
    def items(self) -> tuple[Value, ...] | Unknown | OneOf:
        found: tuple[Value, ...] | Unknown | OneOf = self.slots["items"]
        return found


@dataclass(eq=False, slots=True)
class DictValue:
    """A dictionary; its slot `items` is a dictionary of pairs (key, value) by the key's constant,
    or UNKNOWN. `repeated` are the keys that its literal has twice, each with whether it has one
    value at both places."""

    slots: Slots
    span: Span | None = None
    repeated: tuple[tuple[Const, bool], ...] = ()

    def __post_init__(self) -> None:
        self.slots = OwnSlots(self.slots)

    @property
    def items(self) -> Mapping[Any, tuple[Value, Value]] | Unknown | OneOf:
        found: Mapping[Any, tuple[Value, Value]] | Unknown | OneOf = self.slots["items"]
        return found


@dataclass(eq=False, slots=True)
class Frame:
    """The names of a function, a class or a module, and the frame around it. `made_by` is the call
    of the function."""

    slots: Slots
    module: ModuleValue
    around: Frame | None = None
    function: Function | None = None
    me: Value | None = None
    global_names: frozenset[str] = frozenset()
    outer_names: frozenset[str] = frozenset()
    kind: Literal["", "class", "comprehension"] = ""
    made_by: Creation | None = None


@dataclass(eq=False, slots=True)
class Function:
    """A function of the project, or a lambda. `owner` is the class that defines it."""

    node: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda
    frame: Frame
    defaults: tuple[Value, ...]
    keyword_defaults: Mapping[str, Value]
    owner: Class | None = None
    kind: str = ""
    setter: Function | None = None
    interface: Interface | None = None

    @property
    def name(self) -> str:
        return getattr(self.node, "name", "<lambda>")


@dataclass(frozen=True, slots=True, kw_only=True)
class Interface:
    """The outcomes and keys that `smach.cb_interface` gives to a function."""

    outcomes: Value
    input_keys: Value
    output_keys: Value


@dataclass(eq=False, slots=True)
class Class:
    """A class of the project; `slots` are the names in it, `order` the classes in which Python
    searches a name, without this one. A base class that is not known is UNKNOWN there."""

    node: ast.ClassDef
    frame: Frame
    order: tuple[Value, ...]
    slots: Slots
    is_dataclass: bool = False

    @property
    def name(self) -> str:
        return self.node.name


@dataclass(frozen=True, slots=True)
class LibraryClass:
    """A class of a framework, or of Python, that the evaluator models, by its full name."""

    name: str

    @property
    def short(self) -> str:
        return self.name.rpartition(".")[2]


class Creation(NamedTuple):
    """The call that made an object or a frame: its code, the frame in which it was evaluated, and
    the arguments."""

    node: ast.expr | None
    frame: Frame
    arguments: Arguments


@dataclass(eq=False, slots=True)
class Instance:
    """An object of a class; `span` is the place of the call that made it, `made_by` the call."""

    cls: Class | LibraryClass
    slots: Slots
    span: Span | None = None
    opaque: bool = False
    made_by: Creation | None = None

    def __post_init__(self) -> None:
        self.slots = OwnSlots(self.slots, self.cls if isinstance(self.cls, Class) else None)


@dataclass(frozen=True, slots=True)
class Method:
    """A function bound to an object."""

    function: Value
    me: Value


@dataclass(frozen=True, slots=True)
class Partial:
    """`functools.partial`."""

    function: Value
    arguments: Arguments


@dataclass(frozen=True, slots=True)
class Native:
    """A function of a library that the evaluator models."""

    name: str
    run: Callable[[Interpreter, Arguments, Span | None], Value] = field(compare=False)
    is_static: bool = False


@dataclass(eq=False, slots=True)
class ModuleValue:
    """A module of the project; `dynamic`: it can have names that were not read. `bound` are the
    names that its code binds, as soon as one was searched in vain."""

    name: str
    slots: Slots
    text: PythonText | None = None
    package: str = ""
    dynamic: bool = False
    file: str = ""
    is_loaded: bool = False
    bound: frozenset[str] | None = None
    faults: list[UseFault] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class Super:
    """`super()` in a method of a class, for an object."""

    owner: Class
    me: Value


@dataclass(frozen=True, slots=True)
class Arguments:
    """The arguments of a call; `open`: there can be others (`*unknown`, `**unknown`)."""

    positional: tuple[Value, ...] = ()
    named: tuple[tuple[str, Value], ...] = ()
    open: bool = False

    def get(self, index: int, name: str, default: Value | None = None) -> Value | None:
        """An argument by its place or name."""
        if 0 <= index < len(self.positional):
            return self.positional[index]
        for key, value in self.named:
            if key == name:
                return value
        return UNKNOWN if self.open else default

    def without_first(self) -> Arguments:
        return Arguments(self.positional[1:], self.named, self.open)

    def followed_by(self, more: Arguments) -> Arguments:
        """These arguments and others, whose named ones replace those of the same name."""
        named = {**dict(self.named), **dict(more.named)}
        positional = () if self.open else more.positional
        return Arguments(
            (*self.positional, *positional), tuple(named.items()), self.open or more.open
        )

    def with_first(self, value: Value) -> Arguments:
        return Arguments((value, *self.positional), self.named, self.open)


class Interpreter(Protocol):
    """The part of the evaluator that models of libraries use. `opened` are the containers that
    `with` has opened; `adds` counts all states that were added, `orphans` those to a container
    of a caller. `is_certain`: an exception would end the program here. `managers` counts
    the `with` statements of objects that are not known, which can open a container too;
    `sees_opened`: no other code can have opened one."""

    opened: list[Value]
    orphans: int
    adds: int
    faults: list[UseFault]
    managers: int
    sees_opened: bool

    @property
    def is_certain(self) -> bool: ...

    @property
    def heap(self) -> Heap: ...
    def call(
        self, function: Value, arguments: Arguments, node: ast.expr | None, frame: Frame
    ) -> Value: ...
    def attribute(self, owner: Value, name: str, node: ast.expr, frame: Frame) -> Value: ...
    def set_attribute(self, owner: Value, name: str, value: Value) -> None: ...
    def item(self, owner: Value, key: Value) -> Value: ...
    def update(self, owner: DictValue, value: Value) -> None: ...
    def new_list(self, items: Sequence[Value], kind: str = "list") -> ListValue: ...
    def classes(self, cls: Value) -> list[Value]: ...
    def partial(self, function: Value, arguments: Arguments) -> Value: ...


class Heap(Protocol):
    """The store: writes are logged, so that they can be undone."""

    def set(self, slots: Slots, key: Any, value: Any) -> None: ...


UseKind = Literal[
    "text as list", "shared transitions", "missing member", "repeated key",
    "state named as outcome", "no such start state", "unknown argument", "too many arguments",
    "missing argument", "class as state", "no dictionary", "other container",
    "no container",
]  # fmt: skip


class UseFault(NamedTuple):
    """A wrong use of a framework at its place, with the names in it, and another place."""

    kind: UseKind
    span: Span
    names: tuple[str, ...] = ()
    other: Span | None = None


Value: TypeAlias = (
    Unknown | Const | OneOf | TupleValue | ListValue | DictValue | Function | Class | LibraryClass
    | Instance | Method | Partial | Native | ModuleValue | Super
)  # fmt: skip


def one_of(values: Iterable[Value]) -> Value:
    """The value that is one of some values: the only one, one of a few, or unknown."""
    found: list[Value] = []
    for value in values:
        for part in value.values if isinstance(value, OneOf) else (value,):
            if isinstance(part, Unknown):
                return UNKNOWN if isinstance(part, OpenText) else part
            if all(part is not known and part != known for known in found):
                found.append(part)
    if len(found) == 1:
        return found[0]
    return OneOf(tuple(found)) if 0 < len(found) <= MOST_ALTERNATIVES else UNKNOWN


def text_of(value: Value) -> str | None:
    """A text, with the names of the parameters in it if it is not known as a whole."""
    match value:
        case Const(value=str() as text) | OpenText(text=text):
            return text
    return None


def alternatives(value: Value) -> tuple[Value, ...]:
    """The values of which a value is one."""
    return value.values if isinstance(value, OneOf) else (value,)


def truth(value: Value) -> bool | None:
    """The truth value in a condition; None: not known."""
    match value:
        case Const(value=known):
            return bool(known)
        case TupleValue(items=items):
            return bool(items)
        case ListValue() | DictValue():
            contents = value.items
            return None if isinstance(contents, Unknown | OneOf) else bool(contents)
        case OneOf(values=values):
            found = {truth(part) for part in values}
            return found.pop() if len(found) == 1 else None
        case Unknown() | Instance() | Super():
            return None
    return True


def sequence(value: Value | None) -> tuple[Value, ...] | None:
    """The items of a list, tuple or set, the keys of a dictionary, the letters of a text; None: not
    known."""
    match value:
        case TupleValue(items=items):
            return items
        case ListValue():
            contents = value.items
            return None if isinstance(contents, Unknown | OneOf) else contents
        case DictValue():
            pairs = value.items
            return (
                None if isinstance(pairs, Unknown | OneOf) else tuple(k for k, _ in pairs.values())
            )
        case Const(value=str() as text, span=span):
            return tuple(Const(letter, span) for letter in text)
    return None
