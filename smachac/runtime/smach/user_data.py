# ruff: noqa: SIM401 (reads and writes are hot, and `d.get(k, k)` is the slower form)
"""Userdata: the store of a container, and the restricted view of it that a child gets."""

from __future__ import annotations

import copy
import functools
from collections.abc import Collection, Iterable, Mapping, MutableMapping
from operator import itemgetter
from types import MappingProxyType
from typing import Any, ClassVar, TypeAlias

from smachac.runtime.smach import settings
from smachac.runtime.smach.exceptions import InvalidUserCodeError
from smachac.runtime.smach.failures import near

View: TypeAlias = tuple[
    Collection[str], Collection[str], Mapping[str, str], MutableMapping[str, Any]
]
"""(keys that may be read, keys that may be written, own key -> key in the store, the store)."""

_SAME: Mapping[str, str] = MappingProxyType({})


class UserData:
    """A store with string keys, read and written by item (`ud["k"]`) or attribute (`ud.k`).

    Attributes that begin with an underscore belong to the object and are no keys.
    Reading an absent key raises KeyError, by attribute too.
    """

    __iter__: ClassVar[None] = None
    _data: dict[str, Any]

    def __init__(self) -> None:
        object.__setattr__(self, "_data", {})

    def __getitem__(self, key: str) -> Any:
        try:
            return self._data[key]
        except KeyError:
            raise _absent(key, self._data) from None

    def __setitem__(self, key: str, value: Any) -> None:
        self._data[key] = value

    def __getattr__(self, key: str) -> Any:
        if key.startswith("_"):
            raise AttributeError(key)
        return self[key]

    def __setattr__(self, key: str, value: Any) -> None:
        if key.startswith("_"):
            object.__setattr__(self, key, value)
        else:
            self._data[key] = value

    def __contains__(self, key: object) -> bool:
        return key in self._data

    def keys(self) -> list[str]:
        """The keys, in the order in which they were first written."""
        return list(self._data)

    def update(self, other_userdata: UserData) -> None:
        """Copy every key of another store by reference."""
        for key in other_userdata.keys():  # noqa: SIM118 (a store is no mapping)
            self._data[key] = other_userdata[key]

    def extract(self, keys: Iterable[str], remapping: Mapping[str, str]) -> UserData:
        """A new store with shallow copies of `keys`, renamed by the inverse of `remapping`."""
        inverse = {outer: inner for inner, outer in remapping.items()}
        if len(inverse) != len(remapping):
            settings.logerr(f"the remapping {dict(remapping)} cannot be inverted")
        extracted = UserData()
        for key in keys:
            extracted[inverse.get(key, key)] = copy.copy(self[key])
        return extracted

    def merge(self, ud: UserData, keys: Iterable[str], remapping: Mapping[str, str]) -> None:
        """Store shallow copies of `keys` of another store, renamed by `remapping`."""
        for key in keys:
            self._data[remapping.get(key, key)] = copy.copy(ud[key])


class Const:
    """A read-only proxy: attributes and items can be read, and no attribute set or deleted.

    What is read is wrapped too if it has attributes of its own. The runtime wraps nothing; this
    class is for code that names it.
    """

    def __init__(self, obj: object) -> None:
        object.__setattr__(self, "_obj", obj)

    def __getattr__(self, name: str) -> Any:
        return get_const(getattr(object.__getattribute__(self, "_obj"), name))

    def __getitem__(self, name: Any) -> Any:
        return get_const(self._obj[name])

    def __setattr__(self, name: str, value: object) -> None:
        settings.logerr(f"attribute '{name}' of a constant is set")
        raise TypeError(f"attribute '{name}' is read-only")

    def __delattr__(self, name: str) -> None:
        settings.logerr(f"attribute '{name}' of a constant is deleted")
        raise TypeError(f"attribute '{name}' is read-only")


def get_const(obj: Any) -> Any:
    """A Const for an object with attributes of its own; any other object itself."""
    return Const(obj) if hasattr(obj, "__dict__") else obj


class Remapper:
    """A child's view of its container's store: the declared keys, under the child's own names.

    The child may read `input_keys` and write `output_keys`; writes reach the container at once.
    `remapping` (child's key -> container's key) is followed one step.
    Reading an undeclared key raises InvalidUserCodeError, an absent one KeyError;
    writing an undeclared key is logged as an error and dropped.
    Dicts given as keys or remapping are not copied, so later changes of them apply.
    """

    __iter__: ClassVar[None] = None
    _view: View

    def __new__(
        cls,
        ud: Any,
        input_keys: Collection[str] = (),
        output_keys: Collection[str] = (),
        remapping: Mapping[str, str] | None = None,
    ) -> Remapper:
        return object.__new__(_with_properties(frozenset(input_keys)))

    def __init__(
        self,
        ud: Any,
        input_keys: Collection[str] = (),
        output_keys: Collection[str] = (),
        remapping: Mapping[str, str] | None = None,
    ) -> None:
        view: View = (
            input_keys if isinstance(input_keys, dict) else dict.fromkeys(input_keys),
            output_keys if isinstance(output_keys, dict) else dict.fromkeys(output_keys),
            {} if remapping is None else remapping,
            store(ud),
        )
        object.__setattr__(self, "_view", view)

    def __reduce__(self) -> tuple[Any, ...]:
        inputs, outputs, remapping, data = self._view
        return Remapper, (data, inputs, outputs, remapping)

    def __getitem__(self, key: str) -> Any:
        inputs, _, remapping, data = self._view
        if key in inputs:
            try:
                return data[remapping[key] if key in remapping else key]
            except KeyError:
                pass
        raise self._refusal(key)

    def __getattr__(self, key: str) -> Any:
        return self[key]

    def __setitem__(self, key: str, value: Any) -> None:
        _, outputs, remapping, data = self._view
        if key in outputs:
            data[remapping[key] if key in remapping else key] = value
        else:
            self._drop(key)

    def __setattr__(self, key: str, value: Any) -> None:
        _, outputs, remapping, data = self._view
        if key in outputs:
            data[remapping[key] if key in remapping else key] = value
        elif key.startswith("_"):
            object.__setattr__(self, key, value)
        else:
            self._drop(key)

    def __contains__(self, key: str) -> bool:
        inputs, _, remapping, data = self._view
        return key in inputs and remapping.get(key, key) in data

    def keys(self) -> list[str]:
        """The declared inputs that are present, under the child's names."""
        inputs, _, remapping, data = self._view
        if settings.compat:
            return [remapping.get(key, key) for key in data.keys() if key in inputs]  # noqa: SIM118
        return [key for key in inputs if key in self]

    def update(self, other_userdata: UserData | Remapper) -> None:
        """Write every key of another store, by the same rules as single writes."""
        target = self._view[3] if settings.compat else self
        for key in other_userdata.keys():  # noqa: SIM118 (a store is no mapping)
            target[key] = other_userdata[key]

    def _refusal(self, key: str) -> Exception:
        inputs, _, remapping, data = self._view
        if key in inputs:
            return _absent(remapping.get(key, key), data, key)
        if isinstance(key, str) and key.startswith("_"):
            return AttributeError(key)
        return InvalidUserCodeError(
            f"userdata key '{key}' is read, but is no input key;{near(str(key), list(inputs))}"
            f" input keys: {list(inputs)}"
        )

    def _drop(self, key: str) -> None:
        outputs = list(self._view[1])
        settings.logerr(
            f"userdata key '{key}' is written, but is no output key; output keys: {outputs}"
        )


@functools.cache
def _with_properties(keys: frozenset[str]) -> type[Remapper]:
    """The Remapper class with a property for each of these keys, cached for the process,
    because making a class takes 22 us.

    Without properties, a read by attribute goes through `__getattr__`, which costs 1.4 us in
    CPython 3.11, because it first creates an AttributeError.
    """
    names = [key for key in keys if not key.startswith("_") and not hasattr(Remapper, key)]
    return type("Remapper", (Remapper,), {name: property(itemgetter(name)) for name in names})


def store(ud: Any) -> Any:
    """The mapping in a plain UserData; any other object is returned unchanged.

    A subclass of UserData may define item access, so it is read and written by item.
    """
    return ud._data if type(ud) is UserData else ud


def read_keys(source: Any, keys: Collection[str], data: MutableMapping[str, Any]) -> list[str]:
    """Copy `keys` by reference from a UserData, Remapper or mapping; the keys not found."""
    inputs, remapping, held = keys, _SAME, source
    if isinstance(source, Remapper):
        inputs, _, remapping, held = source._view
    elif type(source) is UserData:
        held = source._data
    missing = []
    for key in keys:
        if key not in inputs:
            raise source._refusal(key)
        name = remapping[key] if key in remapping else key
        if name in held:
            data[key] = held[name]
        else:
            missing.append(key)
    return missing


def write_keys(target: Any, keys: Collection[str], data: Mapping[str, Any]) -> None:
    """Copy `keys` by reference to a UserData, Remapper or mapping, except those not in `data`."""
    outputs, remapping, held = keys, _SAME, target
    if isinstance(target, Remapper):
        _, outputs, remapping, held = target._view
    elif type(target) is UserData:
        held = target._data
    for key in keys:
        if key not in data:
            continue
        if key in outputs:
            held[remapping[key] if key in remapping else key] = data[key]
        else:
            target._drop(key)


class _AbsentKeyError(KeyError):
    """A KeyError whose text is its message, without the quotes of a key."""

    def __str__(self) -> str:
        return str(self.args[0])


_AbsentKeyError.__name__ = _AbsentKeyError.__qualname__ = KeyError.__name__
_AbsentKeyError.__module__ = KeyError.__module__


def _absent(key: object, data: Collection[str], own: object = None) -> KeyError:
    """The error for a key that a store lacks; `own` is its name for the state that reads it."""
    called = f"'{key}'" if own in (None, key) else f"'{own}' ('{key}' of the container)"
    present = list(data) if isinstance(data, dict) else None
    hint = near(str(key), list(map(str, present))) if present is not None else ""
    words = f"userdata key {called} is absent;{hint} present: {present}"
    if present is None:
        words = f"userdata key {called} is absent in a store of another kind"
    settings.log_raised(words)
    return _AbsentKeyError(words)
