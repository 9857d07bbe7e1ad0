"""Reading of plain data (what a YAML file holds), with the place of the first mistake.

A place is the path of keys and indices from the outermost value: `("arms", "left", "home", 2)`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from difflib import get_close_matches
from typing import Any, TypeAlias, TypeVar

T = TypeVar("T")

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
    """A mistake in a file of data: the message, its place, and a line of help."""

    def __init__(self, message: str, place: Place = (), help: str | None = None) -> None:
        super().__init__(message)
        self.message, self.place, self.help = message, place, help

    def __str__(self) -> str:
        where = ".".join(map(str, self.place))
        return f"{where}: {self.message}" if where else self.message


class Fields:
    """A mapping at a place, whose keys are taken one by one. Every method raises DataError."""

    def __init__(self, data: Any, place: Place, known: Iterable[str]) -> None:
        if not isinstance(data, Mapping):
            raise DataError(f"a mapping is expected, not {shown(data)}", place)
        self.data, self.place = data, place
        names = tuple(known)
        for key in data:
            if key not in names:
                message = f"the key `{key}` is unknown"
                raise DataError(message, (*place, str(key)), guess(key, names))

    def __contains__(self, key: str) -> bool:
        return self.data.get(key) is not None

    def take(self, key: str, read: Callable[[Any, Place], T]) -> T:
        """The value of a key, which must be there."""
        if self.data.get(key) is None:
            raise DataError(f"the key `{key}` is missing", self.place)
        return read(self.data[key], (*self.place, key))

    def get(self, key: str, read: Callable[[Any, Place], T], default: T) -> T:
        """The value of a key; `default` if it is absent or null."""
        return self.take(key, read) if key in self else default


def guess(name: object, known: Iterable[str]) -> str:
    """A line of help: the known name that is meant, or all of them."""
    names = list(known)
    close = get_close_matches(str(name), names, n=1)
    if close:
        return f"did you mean `{close[0]}`?"
    return f"the known names are {', '.join(f'`{each}`' for each in names)}"


def shown(data: Any) -> str:
    """A short form of a value, for a message."""
    text = repr(data)
    return text if len(text) <= 40 else f"{text[:37]}..."


def text(data: Any, place: Place) -> str:
    """A text that is not empty."""
    if not isinstance(data, str) or not data:
        raise DataError(f"a text is expected, not {shown(data)}", place)
    return data


def number(data: Any, place: Place) -> float:
    """A finite number."""
    if isinstance(data, bool) or not isinstance(data, int | float) or not math.isfinite(data):
        raise DataError(f"a number is expected, not {shown(data)}", place)
    return float(data)


def positive(data: Any, place: Place) -> float:
    """A number above 0."""
    found = number(data, place)
    if found <= 0.0:
        raise DataError(f"a number above 0 is expected, not {found:g}", place)
    return found


def probability(data: Any, place: Place) -> float:
    """A number from 0 to 1."""
    found = number(data, place)
    if not 0.0 <= found <= 1.0:
        raise DataError(f"a probability from 0 to 1 is expected, not {found:g}", place)
    return found


def truth(data: Any, place: Place) -> bool:
    """`true` or `false`."""
    if not isinstance(data, bool):
        raise DataError(f"`true` or `false` is expected, not {shown(data)}", place)
    return data


def items(data: Any, place: Place) -> list[Any]:
    """A list."""
    if not isinstance(data, list | tuple):
        raise DataError(f"a list is expected, not {shown(data)}", place)
    return list(data)


def texts(data: Any, place: Place) -> tuple[str, ...]:
    """A list of texts."""
    return tuple(text(each, (*place, k)) for k, each in enumerate(items(data, place)))


def numbers(data: Any, place: Place) -> tuple[float, ...]:
    """A list of numbers."""
    return tuple(number(each, (*place, k)) for k, each in enumerate(items(data, place)))


def vector(data: Any, place: Place) -> Vector:
    """Three numbers."""
    found = numbers(data, place)
    if len(found) != 3:
        raise DataError(f"three numbers are expected, not {len(found)}", place)
    return found[0], found[1], found[2]


def size(data: Any, place: Place) -> Vector:
    """Three lengths (m) above 0."""
    found = vector(data, place)
    for k, each in enumerate(found):
        positive(each, (*place, k))
        near(each, (*place, k))
    return found


def no_frame(name: str, place: Place) -> None:
    """Raises DataError for a name that is that of a frame of every world."""
    if name in FRAMES:
        raise DataError(f"`{name}` is the name of a frame", place, "choose another name")


def near(length: float, place: Place) -> float:
    """A length (m) that is not far too large for a robot's cell."""
    if abs(length) > FARTHEST:
        message = f"{length:g} m is farther away than {FARTHEST:g} m"
        raise DataError(message, place, "lengths are in metres, not in millimetres")
    return length


def pose(data: Any, place: Place) -> Pose:
    """`[[x, y, z], [qx, qy, qz, qw]]`, or the position alone; the quaternion is normalized."""
    parts = items(data, place)
    if len(parts) == 3 and not isinstance(parts[0], list | tuple):
        position, rotation = vector(parts, place), NO_ROTATION
        spot: Place = place
    elif len(parts) == 2:
        spot = (*place, 0)
        position = vector(parts[0], spot)
        rotation = quaternion(parts[1], (*place, 1))
    else:
        raise DataError("a pose `[[x, y, z], [qx, qy, qz, qw]]` is expected", place)
    for k, each in enumerate(position):
        near(each, (*spot, k))
    return position, rotation


def quaternion(data: Any, place: Place) -> Quaternion:
    """Four numbers, normalized; four zeros are no rotation."""
    found = numbers(data, place)
    if len(found) != 4:
        raise DataError(f"a quaternion has four numbers, not {len(found)}", place)
    length = math.hypot(*found)
    if length == 0.0:
        return NO_ROTATION
    x, y, z, w = (each / length for each in found)
    return x, y, z, w


def named(
    data: Any, place: Place, read: Callable[[str, Any, Place], T], least: int = 1
) -> tuple[T, ...]:
    """A mapping of names to values, each read with its name."""
    if not isinstance(data, Mapping) or len(data) < least:
        raise DataError(f"a mapping of names is expected, not {shown(data)}", place)
    return tuple(
        read(text(name, (*place, str(name))), value, (*place, str(name)))
        for name, value in data.items()
    )
