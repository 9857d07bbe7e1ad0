"""`records.dataclass` makes classes that behave like those of `dataclasses.dataclass`."""

from __future__ import annotations

import copy
import dataclasses
import inspect
import math
import pickle
import pprint
from collections.abc import Callable
from typing import Any, ClassVar

import pytest

from smachac import records

OPTIONS: list[dict[str, bool]] = [
    {},
    {"frozen": True},
    {"frozen": True, "slots": True},
    {"frozen": True, "slots": True, "kw_only": True},
    {"frozen": True, "slots": True, "eq": False},
    {"slots": True, "unsafe_hash": True},
    {"slots": True},
]


def point(made_by: Any, options: dict[str, bool]) -> Any:
    @made_by.dataclass(**options)
    class Point:
        x: float
        y: float = 0.0
        names: tuple[str, ...] = made_by.field(default=(), repr=False)
        place: list[int] = made_by.field(default_factory=list, compare=False)

    Point.__qualname__ = "Point"
    return Point


@pytest.mark.parametrize("options", OPTIONS, ids=str)
def test_a_class_behaves_as_that_of_the_standard_library(options: dict[str, bool]) -> None:
    made, own = (point(item, options) for item in (records, dataclasses))
    assert str(inspect.signature(made)) == str(inspect.signature(own))
    assert made.__match_args__ == own.__match_args__
    assert hasattr(made(x=1), "__dict__") is hasattr(own(x=1), "__dict__")
    values: list[dict[str, Any]] = [
        {"x": 1},
        {"x": 1, "y": 2},
        {"x": 1, "place": [1]},
        {"x": math.nan},
        {"x": [1]},
    ]
    for one in values:
        assert repr(made(**one)) == repr(own(**one))
        for other in values:
            assert (made(**one) == made(**other)) is (own(**one) == own(**other))
    hashable: list[dict[str, Any]] = [{"x": 1}, {"x": 1, "y": 2, "names": ("a",)}]
    if own.__hash__ is None:
        assert made.__hash__ is None
    elif own.__hash__ is not object.__hash__:
        assert [hash(made(**item)) for item in hashable] == [hash(own(**item)) for item in hashable]
    assert made(x=1) != own(x=1)
    with pytest.raises(TypeError, match="'x'"):
        made()
    with pytest.raises(TypeError, match="colour"):
        made(x=1, colour=2)


@records.dataclass(frozen=True, slots=True, kw_only=True)
class _Named:
    name: str
    known: dict[str, int] = records.field(default_factory=dict)

    def __repr__(self) -> str:
        return f"<{self.name}>"


@records.dataclass(frozen=True)
class _Empty:
    pass


def test_objects_can_be_replaced_copied_and_pickled() -> None:
    made = _Named(name="a", known={"b": 1})
    assert dataclasses.replace(made, name="c") == _Named(name="c", known={"b": 1})
    assert dataclasses.asdict(made) == {"name": "a", "known": {"b": 1}}
    for other in (copy.copy(made), copy.deepcopy(made), pickle.loads(pickle.dumps(made))):
        assert type(other) is _Named
        assert other == made
    assert _Named(name="a").known is not _Named(name="a").known


def test_own_methods_stay() -> None:
    assert repr(_Named(name="a")) == "<a>"
    assert _Empty() == _Empty()
    assert hash(_Empty()) == hash(_Empty())


def test_methods_are_shared() -> None:
    """They are what takes the time of `dataclasses`: one function for each class and method."""
    assert vars(_Named)["__eq__"] is vars(_Empty)["__eq__"]
    assert vars(_Named)["__hash__"] is vars(_Empty)["__hash__"]


@records.dataclass(slots=True, unsafe_hash=True)
class _Link:
    inner: Any


def test_a_deep_value_takes_linear_time() -> None:
    """A field is compared and hashed once: twice would be 2 to the power of the depth."""
    one, other = (deep(200) for _ in range(2))
    assert one == other
    assert hash(one) == hash(other)


def deep(levels: int) -> _Link:
    link = _Link(None)
    for _ in range(levels):
        link = _Link(link)
    return link


Make = Any
"""The module `records` or `dataclasses`."""


def plain(made_by: Make) -> Any:
    @made_by.dataclass(slots=True)
    class Plain:
        first: int
        second: str = "b"
        many: list[int] = made_by.field(default_factory=list)

    return Plain


def keyed(made_by: Make) -> Any:
    @made_by.dataclass(frozen=True, slots=True, kw_only=True)
    class Keyed:
        kind: ClassVar[str] = "keyed"
        name: str
        place: int = made_by.field(default=0, compare=False, repr=False)
        parts: tuple[int, ...] = made_by.field(default=(1, 2))

        @property
        def first(self) -> str:
            return self.name[0]

    return Keyed


def derived(made_by: Make) -> Any:
    base = keyed(made_by)

    @made_by.dataclass(frozen=True, slots=True, kw_only=True)
    class Derived(base):  # type: ignore[misc, valid-type]
        kind: ClassVar[str] = "derived"
        parts: tuple[int, ...] = ()
        more: int

    return Derived


def with_methods(made_by: Make) -> Any:
    @made_by.dataclass(slots=True, unsafe_hash=True)
    class WithMethods:
        value: int
        half: float = 0.0

        def __post_init__(self) -> None:
            self.half = self.value / 2

        def __repr__(self) -> str:
            return "own"

    return WithMethods


def without_slots(made_by: Make) -> Any:
    @made_by.dataclass(eq=False)
    class WithoutSlots:
        value: int = 3
        made: dict[str, int] = made_by.field(default_factory=dict)

    return WithoutSlots


def empty(made_by: Make) -> Any:
    @made_by.dataclass(slots=True)
    class Empty:
        pass

    return Empty


CASES = [
    (plain, {"first": 1}, {"first": 2, "second": "c", "many": [1]}),
    (keyed, {"name": "a"}, {"name": "b", "place": 4, "parts": ()}),
    (derived, {"name": "a", "more": 1}, {"name": "a", "more": 2, "place": 3}),
    (with_methods, {"value": 4}, {"value": 5}),
    (without_slots, {}, {"value": 1, "made": {"a": 1}}),
    (empty, {}, {}),
]


def facts(cls: Any, first: dict[str, Any], second: dict[str, Any]) -> dict[str, Any]:
    """What a class is and does, with two sets of arguments."""
    one, same, other = cls(**first), cls(**first), cls(**second)
    parameters = inspect.signature(cls).parameters.values()
    fields = dataclasses.fields(cls)
    changed = dataclasses.replace(one, **second)
    return {
        "parameters": [(item.name, item.kind, str(item.default)) for item in parameters],
        "fields": [(f.name, f.type, f.compare, f.repr, f.kw_only) for f in fields],
        "match": cls.__match_args__,
        "slots": not hasattr(one, "__dict__"),
        "names": (cls.__name__, cls.__qualname__, cls.__module__),
        "values": [[getattr(item, f.name) for f in fields] for item in (one, other, changed)],
        "shown": (repr(one), repr(other)),
        "equal": (one == same, one == other, one != same, one == 3),
        "hashable": cls.__hash__ is not None,
        "equal_hashes": cls.__hash__ is None or (hash(one) == hash(same)) == (one == same),
        "copied": repr(copy.deepcopy(other)),
        "printed": pprint.pformat(other),
        "error": _error(cls, first),
        "dict": dataclasses.asdict(one),
    }


def _error(cls: Any, arguments: dict[str, Any]) -> str:
    with pytest.raises(TypeError) as raised:
        cls(**arguments, unknown=1)
    return str(raised.value)


@pytest.mark.parametrize(("case", "first", "second"), CASES)
def test_a_derived_class_and_one_with_methods(
    case: Callable[[Make], Any], first: dict[str, Any], second: dict[str, Any]
) -> None:
    ours, theirs = case(records), case(dataclasses)
    assert facts(ours, first, second) == facts(theirs, first, second)
