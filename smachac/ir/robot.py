"""Robot models for rules: joints, limbs and frames; two robots are built in."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from smachac.diagnostics.source import NOWHERE, Span


@dataclass(frozen=True, slots=True, kw_only=True)
class Joint:
    """A revolute joint and its limits (rad); the limits of a continuous joint are infinite.

    `velocity` is its largest speed (rad/s); infinite if it is not known. `span` is its place in the
    robot's file, if there is one.
    """

    name: str
    lower: float = -math.inf
    upper: float = math.inf
    velocity: float = math.inf
    span: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Robot:
    """A robot: its joints, its limbs, the names of its frames.

    A limb is a chain of joints from the base to the hand, to which lists of joint positions refer.
    `frames` are the names of its links, empty if unknown; `added` are frames that the script
    declares. `span` is the place where the script names the robot, NOWHERE if its base does.
    """

    name: str
    joints: tuple[Joint, ...]
    limbs: tuple[tuple[Joint, ...], ...]
    frames: frozenset[str] = frozenset()
    added: frozenset[str] = frozenset()
    span: Span = field(default=NOWHERE, compare=False, repr=False)


def _limb(
    names: list[str], limits: tuple[tuple[float, float], ...], speeds: tuple[float, ...] = ()
) -> tuple[Joint, ...]:
    known = speeds or (math.inf,) * len(names)
    return tuple(
        Joint(name=name, lower=low, upper=high, velocity=speed)
        for name, (low, high), speed in zip(names, limits, known, strict=True)
    )


_BAXTER = (
    (-1.70168, 1.70168),
    (-2.147, 1.047),
    (-3.05418, 3.05418),
    (-0.05, 2.618),
    (-3.059, 3.059),
    (-1.5708, 2.094),
    (-3.059, 3.059),
)
"""Limits of either arm, from baxter_common (Rethink Robotics), baxter_base.urdf.xacro."""

_PANDA = (
    (-2.9671, 2.9671),
    (-1.8326, 1.8326),
    (-2.9671, 2.9671),
    (-3.1416, 0.0),
    (-2.9671, 2.9671),
    (-0.0873, 3.8223),
    (-2.9671, 2.9671),
)
"""Limits of the joints, from franka_panda/panda.urdf of PyBullet's data."""

_PANDA_SPEEDS = (2.175, 2.175, 2.175, 2.175, 2.61, 2.61, 2.61)
"""Largest speeds of the joints, from the same file."""

_PANDA_LINKS = (*(f"link{k}" for k in range(9)), "hand", "leftfinger", "rightfinger", "grasptarget")

_LEFT, _RIGHT = (
    _limb([f"{side}_{joint}" for joint in ("s0", "s1", "e0", "e1", "w0", "w1", "w2")], _BAXTER)
    for side in ("left", "right")
)
_ARM = _limb([f"panda_joint{k}" for k in range(1, 8)], _PANDA, _PANDA_SPEEDS)

BUILT_IN: Mapping[str, Robot] = {
    "baxter": Robot(name="baxter", joints=(*_LEFT, *_RIGHT), limbs=(_LEFT, _RIGHT)),
    "panda": Robot(
        name="panda",
        joints=_ARM,
        limbs=(_ARM,),
        frames=frozenset(f"panda_{link}" for link in _PANDA_LINKS),
    ),
}
"""The built-in robots by name. Baxter has no frames here: its files define different sets."""

SIMULATED = "panda"
"""The robot that the simulation moves."""


def same_joints(one: Robot, other: Robot) -> bool:
    """Whether one description has the joints of the limbs of another one, by name."""
    names = {joint.name for joint in one.joints}
    return names.issuperset(joint.name for limb in other.limbs for joint in limb)
