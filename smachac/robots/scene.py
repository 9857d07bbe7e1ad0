"""A scene: the bodies that are in the world from the start, as data."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from smachac.robots import fields
from smachac.robots.fields import (
    IDENTITY,
    DataError,
    Field,
    Fields,
    Place,
    Pose,
    Table,
    Vector,
    guess,
)
from smachac.robots.models import MODELS, RGB, Box, Model


@dataclass(frozen=True, slots=True, kw_only=True)
class Body:
    """A body of a scene: a built-in model, the model of a file, or a box of its own.

    `pose` is given in `frame` (`base`, `world`, or a body before it in the file), before a uniform
    random shift of at most +-`spread` (x m, y m, yaw rad). `apart` are least distances in x and
    y to other bodies (m). `colour` replaces that of the model. One of `model`, `path` and `box` is
    set.
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


@fields.shape({"enum": [*MODELS]})
def _model(data: Any, place: Place) -> str:
    name = fields.text(data, place)
    if name not in MODELS:
        raise DataError(f"there is no model `{name}`", place, guess(name, MODELS))
    return name


@fields.shape({"type": "number", "minimum": 0})
def _mass(data: Any, place: Place) -> float:
    mass = fields.number(data, place)
    if mass < 0.0:
        raise DataError("a mass is not negative", place, f"write `{-mass:g}`")
    return mass


@fields.shape(fields.row(3, {"type": "number", "minimum": 0, "maximum": 1}))
def _colour(data: Any, place: Place) -> RGB:
    found = fields.vector(data, place)
    for k, number in enumerate(found):
        if not 0.0 <= number <= 1.0:
            message = f"a part of a colour is from 0 to 1, not {number:g}"
            parts = ", ".join(f"{part / 255:.3g}" for part in found)
            small = all(part in range(256) for part in found)
            help = f"write `[{parts}]`" if small else "divide values from 0 to 255 by 255"
            raise DataError(message, (*place, k), help)
    return found


_SHIFT = {"type": "number", "minimum": 0, "maximum": fields.FARTHEST}


@fields.shape(fields.row(3, {}) | {"items": [_SHIFT, _SHIFT, {"type": "number", "minimum": 0}]})
def _spread(data: Any, place: Place) -> Vector:
    found = fields.vector(data, place)
    for k, number in enumerate(found):
        if number < 0.0:
            message, help = f"a shift is not negative, as {number:g} is", f"write `{-number:g}`"
            raise DataError(message, (*place, k), f"{help}: it holds for both directions")
    for k, number in enumerate(found[:2]):
        fields.near(number, (*place, k))
    return found


_BODY: Table = {
    "model": Field(_model, "A built-in model.", ""),
    "path": Field(fields.text, "A URDF or SDF file.", ""),
    "size": Field(fields.size, "The edge lengths of a box in x, y and z (m).", None),
    "mass": Field(_mass, "The mass of the box (kg); one of mass 0 does not move.", 0.0),
    "friction": Field(fields.positive, "The lateral friction coefficient of the box.", 0.8),
    "colour": Field(_colour, "[red, green, blue], each from 0 to 1.", None),
    "pose": Field(
        fields.pose,
        "Its pose in `frame`: [[x, y, z], [qx, qy, qz, qw]] in metres, or [x, y, z].",
        IDENTITY,
    ),
    "frame": Field(fields.text, "`base`, `world`, or a body before it in the file.", "base"),
    "spread": Field(
        _spread, "The largest random shift in x, y (m) and yaw (rad).", (0.0, 0.0, 0.0)
    ),
    "apart": Field(
        fields.named(fields.positive, least=0),
        "The least distances in x and y to bodies before it in the file, by name (m).",
        (),
    ),
}


@fields.record(
    _BODY,
    oneOf=[fields.given(key) for key in ("model", "path", "size")],
    **{"if": {"anyOf": [fields.given("mass"), fields.given("friction")]}},
    then=fields.given("size"),
)
def _body(given: Fields) -> Body:
    kinds = [key for key in ("model", "path", "size") if key in given]
    if len(kinds) != 1:
        help = f"add one of them: `model` is one of {fields.listed(MODELS)}, `path` a URDF or SDF"
        help = f"{help} file, `size` the edges of a box, as in `size: [0.05, 0.05, 0.05]`"
        if kinds:
            help = f"remove {fields.listed(kinds[1:])} or `{kinds[0]}`"
        message = "a body has either a `model`, a `path` or a `size`"
        raise DataError(message, given.place, help)
    if "size" not in given:
        for key in ("mass", "friction"):
            if key in given:
                help = f"remove `{key}`: the {kinds[0]} has its own, or describe a box with `size`"
                raise DataError(f"`{key}` needs `size`", (*given.place, key), help)
    colour: RGB | None = given["colour"]
    return Body(
        name=given.name,
        pose=given["pose"],
        frame=given["frame"],
        model=given["model"],
        path=given["path"],
        box=_box(given, colour) if "size" in given else None,
        colour=colour,
        spread=given["spread"],
        apart=given["apart"],
    )


def _box(given: Fields, colour: RGB | None) -> Model:
    mass = given["mass"]
    return Model(
        boxes=(Box(size=given["size"]),),
        colours=(colour or (0.6, 0.6, 0.6),),
        mass=mass,
        friction=given["friction"],
    )


_SCENE: Table = {
    "bodies": Field(
        fields.values(fields.named(_body, reserved=fields.FRAMES)),
        "The bodies that are in the world from the start, by name.",
    )
}


@fields.record(_SCENE)
def _scene(given: Fields) -> tuple[Body, ...]:
    bodies: tuple[Body, ...] = given["bodies"]
    names = {body.name for body in bodies}
    before = [*fields.FRAMES]
    for body in bodies:
        place: Place = ("bodies", body.name)
        if body.frame not in before:
            if body.frame in names and body.frame != body.name:
                message = f"the frame `{body.frame}` is defined after `{body.name}`"
                help = f"move `{body.frame}` before `{body.name}`"
            else:
                message = f"there is no frame `{body.frame}` before `{body.name}` in the file"
                help = guess(body.frame, before)
            raise DataError(message, (*place, "frame"), help)
        for name, _ in body.apart:
            if name not in before[2:]:
                message = f"`apart` of `{body.name}` names `{name}`, but no body before it in the"
                message += " file has this name"
                help = guess(name, before[2:])
                raise DataError(message, (*place, "apart", name), help, key=True)
        before.append(body.name)
    places: dict[object, str] = {}
    for body in bodies:
        same = (body.model, body.path, body.box, body.pose, body.frame, body.spread)
        other = places.setdefault(same, body.name)
        if other != body.name and body.spread == (0.0, 0.0, 0.0):
            message = f"`{body.name}` is at the same place as `{other}`"
            help = "write another pose: two bodies in one place push each other away"
            raise DataError(message, ("bodies", body.name, "pose"), help)
    return bodies


SCHEMA = _scene.schema
"""The JSON Schema of a scene."""


def read(data: Any) -> tuple[Body, ...]:
    """The bodies in the data of a YAML file. Raises DataError."""
    return _scene(data, ())
