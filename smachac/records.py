"""`dataclass`, `field` and `replace`, as those of `dataclasses`, in a tenth of the time.

A check of ten states makes 100 classes of values, and `dataclasses` compiles six methods for each:
that took 40 % of the check (python bench/compile.py), its import alone 5 ms, because it imports
`inspect`. Here `__init__` alone is compiled; `__eq__`, `__hash__` and `__repr__` are shared
functions with the same results. Annotations are texts, as `from __future__ import annotations`
makes them. The functions of `dataclasses`, as `fields` and `asdict`, accept the objects.

For type checkers this is `dataclasses.dataclass`. They reject an assignment to a field of a frozen
class; at run time nothing does, because the check of each assignment makes the creation of an
object twenty times as slow.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from operator import attrgetter
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, TypeAlias

__all__ = ["dataclass", "field", "replace"]

_NO_DEFAULT: Any = object()


class Field:
    """A field of a class: its name, the text of its type, its default or the function that makes
    one. It has the attributes that `dataclasses` reads."""

    __slots__ = ("compare", "default", "default_factory", "kw_only", "name", "repr", "type")

    name: str
    type: str
    kw_only: bool
    init = True

    def __init__(
        self,
        *,
        default: Any = _NO_DEFAULT,
        default_factory: Any = _NO_DEFAULT,
        repr: bool = True,
        compare: bool = True,
    ) -> None:
        self.default, self.default_factory = default, default_factory
        self.repr, self.compare = repr, compare

    @property
    def _field_type(self) -> object:
        """`dataclasses.fields` returns only the items with this value: no class variables."""
        import dataclasses

        return dataclasses._FIELD  # type: ignore[attr-defined]


Fields: TypeAlias = dict[str, Field]


class _Made:
    """The default, in a signature, of a field whose default is made by a function."""

    def __repr__(self) -> str:
        return "<factory>"


_MADE = _Made()

_PARAMS = SimpleNamespace(repr=False)
"""For `pprint`, which prints classes of `dataclasses` with their own `__repr__` in another way."""

if TYPE_CHECKING:
    from dataclasses import dataclass, field, replace
else:

    def dataclass(cls=None, /, **options):
        """The decorator; `options` are those of `dataclasses.dataclass`, but for `order`."""
        return _with_options(**options) if cls is None else _with_options()(cls)

    field = Field

    def replace(item, /, **changes):
        """An object as `item` with other values of some fields."""
        for name in item.__dataclass_fields__:
            if name not in changes:
                changes[name] = getattr(item, name)
        return item.__class__(**changes)


def _with_options(
    *,
    frozen: bool = False,
    eq: bool = True,
    unsafe_hash: bool = False,
    slots: bool = False,
    kw_only: bool = False,
) -> Callable[[type], type]:
    def made(cls: type) -> type:
        own = dict(vars(cls))
        fields = _fields(cls, own, kw_only=kw_only)
        methods: dict[str, object] = {"__repr__": _repr}
        if "__init__" not in own:
            methods["__init__"] = _init(cls, fields.values())
        if eq:
            methods |= {"__eq__": _eq, "__hash__": _hash if unsafe_hash or frozen else None}
        new = {name: method for name, method in methods.items() if name not in own}
        new["__dataclass_fields__"], new["__dataclass_params__"] = fields, _PARAMS
        new["__match_args__"] = tuple([item.name for item in fields.values() if not item.kw_only])
        new["_compared"] = _values_of([item.name for item in fields.values() if item.compare])
        if slots:
            return _with_slots(cls, own | new, fields)
        for name in fields.keys() & own:
            if isinstance(own[name], Field):
                delattr(cls, name)
        for name, value in new.items():
            setattr(cls, name, value)
        return cls

    return made


def _fields(cls: type, own: Mapping[str, Any], *, kw_only: bool) -> Fields:
    """The fields of a class by name, after those of the classes from which it is derived."""
    fields: Fields = {}
    for base in reversed(cls.__mro__[1:]):
        fields |= vars(base).get("__dataclass_fields__", {})
    for name, annotation in own.get("__annotations__", {}).items():
        if annotation.startswith("ClassVar"):
            continue
        default = own.get(name, _NO_DEFAULT)
        item = default if isinstance(default, Field) else Field(default=default)
        item.name, item.type, item.kw_only = name, annotation, kw_only
        fields[name] = item
    return fields


def _init(cls: type, fields: Collection[Field]) -> Any:
    """The method `__init__`, which sets the fields and calls `__post_init__`."""
    names: dict[str, Any] = {"__name__": cls.__module__, "_made": _MADE}
    parameters, body = ["self"], []
    for item in sorted(fields, key=attrgetter("kw_only")):
        name = item.name
        if item.kw_only and "*" not in parameters:
            parameters.append("*")
        if item.default_factory is not _NO_DEFAULT:
            names[f"_new_{name}"] = item.default_factory
            parameters.append(f"{name}=_made")
            body.append(f"self.{name} = _new_{name}() if {name} is _made else {name}")
            continue
        if item.default is not _NO_DEFAULT:
            names[f"_default_{name}"] = item.default
        parameters.append(name if item.default is _NO_DEFAULT else f"{name}=_default_{name}")
        body.append(f"self.{name} = {name}")
    if hasattr(cls, "__post_init__"):
        body.append("self.__post_init__()")
    exec(f"def __init__({', '.join(parameters)}):\n " + "\n ".join(body or ["pass"]), names)
    init = names["__init__"]
    init.__qualname__ = f"{cls.__qualname__}.__init__"
    init.__annotations__ = {item.name: item.type for item in fields} | {"return": None}
    return init


def _with_slots(cls: type, members: dict[str, Any], fields: Fields) -> type:
    """A class as `cls` with slots for the fields: a class gets them when it is made."""
    known = {slot for base in cls.__mro__ for slot in vars(base).get("__slots__", ())}
    for name in (*fields, "__dict__", "__weakref__"):
        members.pop(name, None)
    members["__slots__"] = tuple([name for name in fields if name not in known])
    members["__qualname__"] = cls.__qualname__
    return type(cls)(cls.__name__, cls.__bases__, members)


def _values_of(names: list[str]) -> Any:
    """A function of an object that returns the tuple of these attributes, as a static method."""
    if len(names) > 1:
        return staticmethod(attrgetter(*names))
    # attrgetter returns no tuple of a single name.
    return staticmethod(lambda item: tuple([getattr(item, name) for name in names]))


def _eq(self: Any, other: Any) -> object:
    if other.__class__ is not self.__class__:
        return NotImplemented
    return self._compared(self) == self._compared(other)


def _hash(self: Any) -> int:
    return hash(self._compared(self))


def _repr(self: Any) -> str:
    shown = (item.name for item in self.__dataclass_fields__.values() if item.repr)
    values = (f"{name}={getattr(self, name)!r}" for name in shown)
    return f"{type(self).__qualname__}({', '.join(values)})"
