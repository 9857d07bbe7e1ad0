"""Shapes of plain data (what a YAML file holds): each is read, with the place of the first mistake,
and has a JSON Schema.

A place is the path of keys and indices from the outermost value: `("arms", "left", "home", 2)`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any, Generic, NamedTuple, TypeAlias, TypeVar

T = TypeVar("T")

Schema: TypeAlias = dict[str, Any]
Place: TypeAlias = tuple[str | int, ...]
Vector: TypeAlias = tuple[float, float, float]
Quaternion: TypeAlias = tuple[float, float, float, float]
Pose: TypeAlias = tuple[Vector, Quaternion]

NO_ROTATION: Quaternion = (0.0, 0.0, 0.0, 1.0)
IDENTITY: Pose = ((0.0, 0.0, 0.0), NO_ROTATION)
FRAMES = ("base", "world")
"""The frames of every world."""
FARTHEST = 20.0
"""Largest coordinate of a pose (m): a larger one is written in millimetres."""


class DataError(ValueError):
    """A mistake in a file of data: the message, its place, and a line of help. `key`: the last key
    of the place is wrong, not its value. `unknown`: its mapping can have no such key."""

    def __init__(
        self, message: str, place: Place, help: str, *, key: bool = False, unknown: bool = False
    ) -> None:
        super().__init__(message)
        self.message, self.place, self.help = message, place, help
        self.key, self.unknown = key, unknown

    def __str__(self) -> str:
        where = ".".join(map(str, self.place))
        return f"{where}: {self.message}" if where else self.message


@dataclass(frozen=True, slots=True)
class Shape(Generic[T]):
    """A kind of value: the function that reads it, and its JSON Schema.

    The function gets the data and their place, and raises DataError. The schema accepts all data
    that the function accepts.
    """

    read: Callable[[Any, Place], T]
    schema: Schema

    def __call__(self, data: Any, place: Place) -> T:
        return self.read(data, place)


def shape(schema: Schema) -> Callable[[Callable[[Any, Place], T]], Shape[T]]:
    """The shape of a reading function with that JSON Schema."""
    return lambda read: Shape(read, schema)


REQUIRED: Any = object()
"""The default of a field that must be there."""


class Field(NamedTuple):
    """A key of a mapping: the shape of its value, a description, its default."""

    shape: Shape[Any]
    doc: str
    default: Any = REQUIRED


Table: TypeAlias = Mapping[str, Field]
"""The keys that a mapping may have."""


class Fields:
    """A mapping at a place, with the keys of a table. Every method raises DataError."""

    def __init__(self, data: Any, place: Place, table: Table) -> None:
        if not isinstance(data, Mapping):
            help = "write `name: value`, with the keys " + listed(table)
            raise DataError(f"a mapping is expected, not {shown(data)}", place, help)
        self.data, self.place, self.table = data, place, table
        for key in data:
            if key not in table:
                message = f"the key `{key}` is unknown"
                help = self._turned(key) or self._neighbour(key) or guess(key, table)
                raise DataError(message, (*place, str(key)), help, unknown=True)

    def _turned(self, key: object) -> str | None:
        """The help for an unknown key whose value is a key that the mapping does not have."""
        value = self.data[key]
        if not isinstance(value, str) or value not in self.table or value in self.data:
            return None
        return f"write `{value}: {key}`: the name of the key comes first"

    def __contains__(self, key: str) -> bool:
        return self.data.get(key) is not None

    def __getitem__(self, key: str) -> Any:
        """The value of a key; its default if it is absent or null."""
        field = self.table[key]
        if key in self:
            try:
                return field.shape(self.data[key], (*self.place, key))
            except DataError as error:
                self._inner(key, error)
                raise
        if field.default is REQUIRED:
            for name, value in self.data.items():
                inner = self._inner_keys(name)
                if isinstance(value, Mapping) and inner and key in value and key not in inner:
                    raise self._outer(name, key)
            help = f"add `{key}: ...` ({about(field)})"
            raise DataError(f"the key `{key}` is missing", self.place, help)
        return field.default

    def _inner_keys(self, name: str) -> Collection[str]:
        """The keys that the mapping under a key can have, if it has a table."""
        known: Collection[str] = ()
        if name in self.table:
            known = self.table[name].shape.schema.get("properties", ())
        return known

    def _neighbour(self, key: object) -> str | None:
        """The help for an unknown key that is one of a mapping beside it."""
        for name, value in self.data.items():
            inner = self._inner_keys(name)
            if isinstance(value, Mapping) and key in inner and key not in value:
                unknown = [item for item in self.data if item not in self.table]
                moved = [item for item in unknown if item in inner and item not in value]
                them = "it" if len(moved) == 1 else "them"
                return f"move {listed(moved)} into `{name}`: indent {them} as its other keys"
        return None

    def _outer(self, name: str, key: str) -> DataError:
        """The mistake that a key of this mapping is in the mapping under another key."""
        place = (*self.place, name, key)
        help = f"move `{key}` out of `{name}`: indent it as `{name}` itself"
        return DataError(f"the key `{key}` is unknown", place, help, unknown=True)

    def _inner(self, key: str, error: DataError) -> None:
        """Correct the help about an unknown key of a mapping inside, if this mapping lacks it."""
        last = error.place[-1] if error.place else ""
        inside = error.unknown and error.place[:-1] == (*self.place, key)
        if inside and isinstance(last, str) and last in self.table and last not in self.data:
            error.help = self._outer(key, last).help

    @property
    def name(self) -> str:
        """The key under which the mapping is."""
        return str(self.place[-1])


def record(table: Table, **more: Any) -> Callable[[Callable[[Fields], T]], Shape[T]]:
    """The shape of a mapping with the keys of a table, of which a function makes a value. `more`
    are further keywords of its JSON Schema."""

    def made(make: Callable[[Fields], T]) -> Shape[T]:
        schema = {**table_schema(table), **more}
        return Shape(lambda data, place: make(Fields(data, place, table)), schema)

    return made


def table_schema(table: Table) -> Schema:
    """The JSON Schema of a mapping with the keys of a table."""
    needed = [key for key, field in table.items() if field.default is REQUIRED]
    return {
        "type": "object",
        **({"required": needed} if needed else {}),
        "additionalProperties": False,
        "properties": {key: _field_schema(field) for key, field in table.items()},
    }


def _field_schema(field: Field) -> Schema:
    described = {"description": field.doc}
    if field.default is REQUIRED:
        return {**described, **field.shape.schema}
    if field.default not in (None, "", ()):
        described["default"] = field.default
    schema = field.shape.schema
    if "type" in schema:
        return {**described, **schema, "type": [schema["type"], "null"]}
    options = schema["anyOf"] if schema.keys() == {"anyOf"} else [schema]
    return {**described, "anyOf": [*options, {"type": "null"}]}


def given(key: str) -> Schema:
    """The JSON Schema of a mapping that has a key, and not null for it."""
    return {"required": [key], "properties": {key: {"not": {"type": "null"}}}}


def guess(name: object, known: Iterable[str]) -> str:
    """A line of help: the known name that is meant, or all of them."""
    names = list(known)
    close = get_close_matches(str(name), names, n=1)
    if close:
        return f"did you mean `{close[0]}`?"
    return f"the known names are {listed(names)}"


def listed(names: Iterable[str]) -> str:
    """Names for a sentence: "`a`, `b`"."""
    return ", ".join(f"`{name}`" for name in names)


def about(field: Field) -> str:
    """The description of a field as a part of a sentence."""
    text = field.doc.rstrip(".")
    return text if text[1:2].isupper() else text[:1].lower() + text[1:]


def shown(data: Any) -> str:
    """A short form of a value, for a message."""
    text = repr(data)
    return text if len(text) <= 40 else f"{text[:37]}..."


@shape({"type": "string", "minLength": 1})
def text(data: Any, place: Place) -> str:
    """A text that is not empty."""
    if not isinstance(data, str) or not data:
        raise DataError(f"a text is expected, not {shown(data)}", place, _suggested_text(data))
    return data


def _suggested_text(data: Any) -> str:
    """The help for a value that is not a text."""
    match data:
        case str(text), *_:
            return f"write one text, as in `{text}`"
        case bool() | int() | float():
            return f'write it in quotes: `"{data}"`'
        case _:
            return "write a name, or a text in quotes"


@shape({"type": "number"})
def number(data: Any, place: Place) -> float:
    """A finite number."""
    if not is_number(data):
        raise DataError(f"a number is expected, not {shown(data)}", place, _suggested_number(data))
    return float(data)


def is_number(data: Any) -> bool:
    """Whether a value is a finite number."""
    return not isinstance(data, bool) and isinstance(data, int | float) and math.isfinite(data)


_PLAIN = re.compile(r"-?\d{1,9}(\.\d{1,9})?")
_WITH_UNIT = re.compile(r"\s*([-+]?\d*\.?\d+)\s*(mm|cm|m|kg|g|deg|rad|N|°)\s*")
_TO_SI = {"mm": 1e-3, "cm": 1e-2, "g": 1e-3, "deg": math.pi / 180, "°": math.pi / 180}


def _suggested_number(data: Any) -> str:
    """The help for a value that is not a number: one in a list or in quotes, with its unit, or with
    a decimal comma."""
    if isinstance(data, list) and len(data) == 1 and is_number(data[0]):
        return f"write the number without the brackets: `{data[0]:.10g}`"
    if isinstance(data, list):
        return "write one number here, not a list"
    found = _WITH_UNIT.fullmatch(data) if isinstance(data, str) and len(data) < 40 else None
    if found is not None:
        meant = float(found[1]) * _TO_SI.get(found[2], 1.0)
        return f"write the number without its unit: `{meant:.10g}`"
    if isinstance(data, str) and re.fullmatch(r"-?\d{1,9},\d{1,9}", data):
        return f"a decimal comma? write `{data.replace(',', '.')}`"
    if isinstance(data, str) and _PLAIN.fullmatch(data):
        return f"write the number without quotes: `{data}`"
    return "write a finite number, as in `0.5`"


@shape({"type": "number", "exclusiveMinimum": 0})
def positive(data: Any, place: Place) -> float:
    """A number above 0."""
    found = number(data, place)
    if found <= 0.0:
        help = f"write `{-found:g}`" if found else "write a number above 0, as in `0.5`"
        raise DataError(f"a number above 0 is expected, not {found:g}", place, help)
    return found


@shape({"type": "number", "minimum": 0, "maximum": 1})
def probability(data: Any, place: Place) -> float:
    """A number from 0 to 1."""
    found = number(data, place)
    if not 0.0 <= found <= 1.0:
        percent = 1.0 < found <= 100.0
        help = (
            f"write `{found / 100:g}` for {found:g} %" if percent else "write a number from 0 to 1"
        )
        raise DataError(f"a probability from 0 to 1 is expected, not {found:g}", place, help)
    return found


@shape({"type": "boolean"})
def truth(data: Any, place: Place) -> bool:
    """`true` or `false`."""
    if not isinstance(data, bool):
        help = "write `true` or `false`, without quotes"
        raise DataError(f"`true` or `false` is expected, not {shown(data)}", place, help)
    return data


def items(data: Any, place: Place) -> list[Any]:
    """A list."""
    if not isinstance(data, list | tuple):
        plain = isinstance(data, str | int | float)
        form = f"[{data}]" if plain else "[...]"
        raise DataError(f"a list is expected, not {shown(data)}", place, f"write `{form}`")
    return list(data)


def each(item: Shape[T]) -> Shape[tuple[T, ...]]:
    """A list whose items have one shape."""

    @shape({"type": "array", "items": item.schema})
    def read(data: Any, place: Place) -> tuple[T, ...]:
        return tuple(item(part, (*place, k)) for k, part in enumerate(items(data, place)))

    return read


texts = each(text)
numbers = each(number)


def row(count: int, item: Schema) -> Schema:
    """The JSON Schema of a list of that length."""
    return {"type": "array", "items": item, "minItems": count, "maxItems": count}


def vector(data: Any, place: Place) -> Vector:
    """Three numbers."""
    found = numbers(data, place)
    if len(found) != 3:
        raise DataError(
            f"three numbers are expected, not {len(found)}", place, counted(found, "[x, y, z]", 3)
        )
    return found[0], found[1], found[2]


def counted(found: Collection[object], form: str, count: int) -> str:
    """The help for a list of another length than that of a form."""
    more = count - len(found)
    numbers = "one number" if abs(more) == 1 else f"{abs(more)} numbers"
    return f"{'add' if more > 0 else 'remove'} {numbers}: the form is `{form}`"


@shape({"type": "number", "minimum": -FARTHEST, "maximum": FARTHEST})
def near(data: Any, place: Place) -> float:
    """A length (m) that is not far too large for a robot's cell."""
    length = number(data, place)
    if abs(length) > FARTHEST:
        message = f"{abs(length):g} m is more than {FARTHEST:g} m, the largest length here"
        raise DataError(message, place, in_metres(length))
    return length


def in_metres(length: float) -> str:
    """The help for a length (mm) where one in metres is expected."""
    return f"write `{length / 1000:g}`: lengths are in metres, not in millimetres"


EXTENT: Schema = {"type": "number", "exclusiveMinimum": 0, "maximum": FARTHEST}
"""The JSON Schema of an edge length (m)."""


@shape(row(3, EXTENT))
def size(data: Any, place: Place) -> Vector:
    """Three lengths (m) above 0."""
    found = vector(data, place)
    for k, edge in enumerate(found):
        positive(edge, (*place, k))
        near(edge, (*place, k))
    return found


_POSITION = row(3, near.schema)


@shape({"anyOf": [_POSITION, row(2, {}) | {"items": [_POSITION, row(4, number.schema)]}]})
def pose(data: Any, place: Place) -> Pose:
    """`[[x, y, z], [qx, qy, qz, qw]]`, or the position alone; the quaternion is normalized."""
    parts = items(data, place)
    if parts and not any(isinstance(part, list | tuple) for part in parts):
        position, rotation = vector(parts, place), NO_ROTATION
        spot: Place = place
    elif len(parts) == 2:
        spot = (*place, 0)
        position = vector(parts[0], spot)
        rotation = quaternion(parts[1], (*place, 1))
    else:
        help = "write the position, as in `[0.5, 0.0, 0.2]`, or a list of position and quaternion"
        raise DataError("a pose `[[x, y, z], [qx, qy, qz, qw]]` is expected", place, help)
    for k, coordinate in enumerate(position):
        near(coordinate, (*spot, k))
    return position, rotation


def quaternion(data: Any, place: Place) -> Quaternion:
    """Four numbers, normalized; four zeros are no rotation."""
    found = numbers(data, place)
    if len(found) != 4:
        help = counted(found, "[qx, qy, qz, qw]", 4)
        raise DataError(f"a quaternion has four numbers, not {len(found)}", place, help)
    length = math.hypot(*found)
    if length == 0.0:
        return NO_ROTATION
    x, y, z, w = (part / length for part in found)
    return x, y, z, w


def named(
    item: Shape[T], *, least: int = 1, reserved: tuple[str, ...] = ()
) -> Shape[tuple[tuple[str, T], ...]]:
    """A mapping of names to values of one shape, with at least `least` names, none of `reserved`;
    read as pairs."""
    names: Schema = {"minLength": 1}
    schema: Schema = {"type": "object", "additionalProperties": item.schema}
    schema |= {"minProperties": least} if least else {}
    schema["propertyNames"] = names | ({"not": {"enum": [*reserved]}} if reserved else {})

    @shape(schema)
    def read(data: Any, place: Place) -> tuple[tuple[str, T], ...]:
        if not isinstance(data, Mapping) or len(data) < least:
            found = "a list" if isinstance(data, list | tuple) else shown(data)
            raise DataError(f"a mapping of names is expected, not {found}", place, _by_name(data))
        return tuple(pair(*entry, place) for entry in data.items())

    def pair(name: Any, value: Any, place: Place) -> tuple[str, T]:
        below = (*place, str(name))
        text(name, below)
        if name in reserved:
            raise DataError(f"`{name}` is the name of a frame", below, "choose another name")
        return name, item(value, below)

    return read


def _by_name(data: Any) -> str:
    """The help for a value in place of a mapping of names, above all for a list of named values."""
    form = "write a name for each, with its keys below it: `name: {...}`"
    if not isinstance(data, list | tuple) or not data or not isinstance(data[0], Mapping):
        return form
    first = data[0]
    name = first.get("name") if "name" in first else next(iter(first), None)
    if not isinstance(name, str):
        return form
    without = ", without `name:` inside" if "name" in first else ""
    return f"write `{name}:` with its keys below it, without the `-`{without}"


def values(shape: Shape[tuple[tuple[str, T], ...]]) -> Shape[tuple[T, ...]]:
    """A mapping of names, read as its values alone."""
    return Shape(lambda data, place: tuple(value for _, value in shape(data, place)), shape.schema)
