"""Pick-and-place tasks: random poses drawn from the seed, and the check of a placed body."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from smachac.sim import transforms
from smachac.sim.outcome import Result
from smachac.sim.physics import UnknownNameError
from smachac.sim.scene import Scene

_TRIES = 1000
"""Poses drawn before `scattered` gives up."""
_TILT = math.radians(3.0)
"""Largest tilt (rad) of a body that stands upright."""


def scattered(
    world: Scene, pose: Any, spread: Sequence[float], apart: Mapping[str, float] | None = None
) -> list[list[float]]:
    """`pose` with a uniform random shift of at most +-`spread` (x m, y m, yaw rad).

    Drawn from the world's seed until its distance in x and y from every body named in `apart` is at
    least the one given there (m). Raises ValueError if 1000 draws find none, and UnknownNameError.
    """
    position, rotation = transforms.as_pose(pose)
    others = {name: (world.pose(name)[0], least) for name, least in (apart or {}).items()}
    for _ in range(_TRIES):
        dx, dy, yaw = (number * world.random.uniform(-1.0, 1.0) for number in spread)
        moved = (position[0] + dx, position[1] + dy, position[2])
        if all(math.dist(moved[:2], at[:2]) >= least for at, least in others.values()):
            turned = transforms.multiply(transforms.about_z(yaw), rotation)
            return transforms.as_lists((moved, turned))
    raise ValueError(f"no place within {list(spread)} is {dict(apart or {})} apart")


def check_placed(world: Scene, body: str, pose: Any, tolerance: float) -> Result:
    """Check that a body stands upright and at rest within `tolerance` (m) of `pose`.

    The value is its distance from `pose` (m); None if there is no such body.
    """
    if body not in world.bodies:
        return Result("aborted", str(UnknownNameError("body", body, tuple(world.bodies))))
    error = world.error(body, pose)
    if error > tolerance:
        reason = f"`{body}` is {1000 * error:.2f} mm from where it was to be"
        return Result("aborted", reason, error)
    if not world.at_rest(body):
        return Result("aborted", f"`{body}` still moves", error)
    (_, rotation) = transforms.as_pose(world.pose(body))
    up = transforms.rotate(rotation, (0.0, 0.0, 1.0))
    tilt = math.acos(max(-1.0, min(1.0, max(abs(number) for number in up[2:]))))
    if tilt > _TILT:
        return Result("aborted", f"`{body}` is tilted by {math.degrees(tilt):.1f} deg", error)
    return Result("succeeded", value=error)
