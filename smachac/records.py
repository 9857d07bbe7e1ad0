"""`dataclass` and `field`: the decorator of the standard library, in a third of its time.

A check of ten states makes 160 classes of values, and `dataclasses` compiles six methods for each:
that took 40 % of the check (python bench/compile.py). Here `__init__` alone is compiled; `__eq__`,
`__hash__` and `__repr__` are shared functions with the same results.

For type checkers this is `dataclasses.dataclass`. They reject an assignment to a field of a frozen
class; at run time nothing does, because the check of each assignment makes the creation of an
object twenty times as slow.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import field
from operator import attrgetter
from typing import TYPE_CHECKING, Any

__all__ = ["dataclass", "field"]

if TYPE_CHECKING:
    from dataclasses import dataclass
else:

    def dataclass(cls=None, /, **options):
        """The decorator; `options` are those of `dataclasses.dataclass`, but for `order`."""
        return _with_options(options) if cls is None else _with_options(options)(cls)


def _with_options(options: dict[str, bool]) -> Callable[[type], type]:
    frozen, eq = options.pop("frozen", False), options.pop("eq", True)
    hashed = options.pop("unsafe_hash", False) or (frozen and eq)

    def made(cls: type) -> type:
        if cls.__doc__ is None:
            cls.__doc__ = cls.__name__  # else the signature is written, which takes long
        own = vars(cls).keys()
        methods: dict[str, object] = {"__repr__": _repr}
        if eq:
            methods |= {"__eq__": _eq, "__hash__": _hash if hashed else None}
        missing = methods.keys() - own
        new: Any = dataclasses.dataclass(cls, repr=False, eq=False, **options)
        names = [field.name for field in dataclasses.fields(new) if field.compare]
        new._compared = _values_of(names)
        for name in missing:
            setattr(new, name, methods[name])
        return new  # type: ignore[no-any-return]

    return made


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
    shown = (field.name for field in dataclasses.fields(self) if field.repr)
    values = (f"{name}={getattr(self, name)!r}" for name in shown)
    return f"{type(self).__qualname__}({', '.join(values)})"
