"""A scene: the bodies that are in the world from the start, as data."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from smachac.robots import fields
from smachac.robots.fields import IDENTITY, DataError, Fields, Place, Pose, Vector, guess
from smachac.robots.models import MODELS, RGB, Box, Model


@dataclass(frozen=True, slots=True, kw_only=True)
class Body:
    """A body of a scene: a built-in model, the model of a file, or a box of its own.

    `pose` is given in `frame` (`base`, `world`, or a body above it), before a uniform random shift
    of at most +-`spread` (x m, y m, yaw rad). `apart` are least distances in x and y to other
    bodies (m). `colour` replaces that of the model. One of `model`, `path` and `box` is set.
    """

    name: str
    pose: Pose
    frame: str = "base"
    model: str = ""
    path: str = ""
    box: Model | None = None
    colour: RGB | None = None
    spread: Vector = (0.0, 0.0, 0.0)
    apart: tuple[tuple[str, float], ...] = ()


AXES = ("x", "y", "z", "yaw")
"""The parts of a pose that can be replaced: x, y, z (m), and the angle about z (rad)."""


def posed(body: Body, values: Mapping[str, float]) -> Body:
    """A body with other values for some of AXES, before its random shift. A `yaw` replaces the
    whole rotation."""
    position, rotation = body.pose
    x, y, z = (values.get(axis, old) for axis, old in zip(AXES[:3], position, strict=True))
    if "yaw" in values:
        half = values["yaw"] / 2
        rotation = (0.0, 0.0, math.sin(half), math.cos(half))
    return replace(body, pose=((x, y, z), rotation))


def read(data: Any) -> tuple[Body, ...]:
    """The bodies in the data of a YAML file. Raises DataError."""
    given = Fields(data, (), ("bodies",))
    bodies = given.take("bodies", lambda each, place: fields.named(each, place, _body))
    above = [*fields.FRAMES]
    for body in bodies:
        place: Place = ("bodies", body.name)
        if body.frame not in above:
            message = f"there is no frame `{body.frame}` above this body"
            raise DataError(message, (*place, "frame"), guess(body.frame, above))
        for name, _ in body.apart:
            if name not in above[2:]:
                message = f"there is no body `{name}` above this body"
                raise DataError(message, (*place, "apart", name), guess(name, above[2:]))
        above.append(body.name)
    return bodies


_BODY = ("model", "path", "size", "mass", "friction", "colour", "pose", "frame", "spread", "apart")


def _body(name: str, data: Any, place: Place) -> Body:
    fields.no_frame(name, place)
    given = Fields(data, place, _BODY)
    kinds = [key for key in ("model", "path", "size") if key in given]
    if len(kinds) != 1:
        raise DataError("a body has either a `model`, a `path` or a `size`", place)
    if "size" not in given:
        for key in ("mass", "friction"):
            if key in given:
                raise DataError(f"`{key}` needs `size`", (*place, key))
    colour = given.get("colour", _colour, None)
    return Body(
        name=name,
        pose=given.get("pose", fields.pose, IDENTITY),
        frame=given.get("frame", fields.text, "base"),
        model=given.get("model", _model, ""),
        path=given.get("path", fields.text, ""),
        box=_box(given, colour) if "size" in given else None,
        colour=colour,
        spread=given.get("spread", _spread, (0.0, 0.0, 0.0)),
        apart=given.get("apart", _apart, ()),
    )


def _model(data: Any, place: Place) -> str:
    name = fields.text(data, place)
    if name not in MODELS:
        raise DataError(f"there is no model `{name}`", place, guess(name, MODELS))
    return name


def _box(given: Fields, colour: RGB | None) -> Model:
    mass = given.get("mass", fields.number, 0.0)
    if mass < 0.0:
        raise DataError("a mass is not negative", (*given.place, "mass"))
    return Model(
        boxes=(Box(size=given.take("size", fields.size)),),
        colours=(colour or (0.6, 0.6, 0.6),),
        mass=mass,
        friction=given.get("friction", fields.positive, 0.8),
    )


def _colour(data: Any, place: Place) -> RGB:
    found = fields.vector(data, place)
    for k, each in enumerate(found):
        if not 0.0 <= each <= 1.0:
            message = f"a part of a colour is from 0 to 1, not {each:g}"
            raise DataError(message, (*place, k), "divide values from 0 to 255 by 255")
    return found


def _spread(data: Any, place: Place) -> Vector:
    found = fields.vector(data, place)
    for k, each in enumerate(found):
        if each < 0.0:
            raise DataError(f"a shift is not negative, as {each:g} is", (*place, k))
    for k, each in enumerate(found[:2]):
        fields.near(each, (*place, k))
    return found


def _apart(data: Any, place: Place) -> tuple[tuple[str, float], ...]:
    if isinstance(data, Mapping) and not data:
        return ()
    return fields.named(data, place, lambda name, each, at: (name, fields.positive(each, at)))
