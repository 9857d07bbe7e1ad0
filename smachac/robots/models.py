"""Models of bodies that are built in: boxes as data. Lengths in m, masses in kg."""

from dataclasses import dataclass

RGB = tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Box:
    """A box: edge lengths and centre (m) in the model's frame."""

    size: tuple[float, float, float]
    centre: tuple[float, float, float] = (0.0, 0.0, 0.0)
    colour: RGB | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Model:
    """A rigid body of boxes.

    `mass` is in kg; a body of mass 0 does not move, and one that moves has the centre of its first
    box as centre of mass. A body that is not `solid` is drawn and has no
    contacts. `friction` is the lateral friction coefficient. Bodies of one model take the `colours`
    in turn.
    """

    boxes: tuple[Box, ...]
    colours: tuple[RGB, ...]
    mass: float = 0.0
    friction: float = 0.8
    solid: bool = True


def _table(size: tuple[float, float], height: float, wood: RGB) -> Model:
    """A table of `size` (x, y) and `height` (m) on four legs; its origin is on the floor."""
    x, y = size[0] / 2 - 0.04, size[1] / 2 - 0.04
    leg, low = height - 0.04, (height - 0.04) / 2
    grey = (0.38, 0.40, 0.44)
    corners = ((x, y), (x, -y), (-x, y), (-x, -y))
    return Model(
        boxes=(
            Box(size=(*size, 0.04), centre=(0.0, 0.0, height - 0.02)),
            *(Box(size=(0.04, 0.04, leg), centre=(*at, low), colour=grey) for at in corners),
        ),
        colours=(wood,),
    )


_PAINTS: tuple[RGB, ...] = (
    (0.86, 0.20, 0.18),
    (0.16, 0.42, 0.80),
    (0.95, 0.70, 0.13),
    (0.93, 0.46, 0.16),
)
_GREY: RGB = (0.60, 0.60, 0.60)
_GREEN: RGB = (0.16, 0.66, 0.36)

MODELS: dict[str, Model] = {
    "table": _table((0.6, 0.8), 0.4, (0.80, 0.66, 0.48)),
    "cafe_table": _table((0.913, 0.913), 0.775, (0.80, 0.66, 0.48)),
    "block": Model(boxes=(Box(size=(0.05, 0.05, 0.05)),), colours=_PAINTS, mass=0.1, friction=1.0),
    "corner_block": Model(
        boxes=(Box(size=(0.05, 0.05, 0.05), centre=(0.025, 0.025, 0.025)),),
        colours=_PAINTS,
        mass=0.5,
        friction=1.0,
    ),
    "brick": Model(boxes=(Box(size=(0.10, 0.05, 0.05)),), colours=_PAINTS, mass=0.2, friction=1.0),
    "wall": Model(boxes=(Box(size=(0.02, 0.4, 0.3), centre=(0, 0, 0.15)),), colours=(_GREY,)),
    "goal": Model(
        boxes=(
            Box(size=(0.08, 0.08, 0.002), centre=(0.0, 0.0, -0.024)),
            Box(size=(0.058, 0.058, 0.002), centre=(0.0, 0.0, -0.0234), colour=(0.93, 0.95, 0.90)),
        ),
        colours=(_GREEN,),
        solid=False,
    ),
}
