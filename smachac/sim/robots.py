"""Robots as data: which file, which joints make a limb, and the figures its control needs."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .engine import data_file
from .geometry import IDENTITY, Pose, as_pose


@dataclass(frozen=True, slots=True, kw_only=True)
class Finger:
    """A sliding finger: its joint and that joint's position (m) when open and when closed."""

    joint: str
    opened: float
    closed: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Limb:
    """An arm with a gripper: joints from the base to the hand, tip frame, fingers, home.

    `gear` couples the two fingers (ratio of a JOINT_GEAR constraint; -1 where both open with the
    same sign); `settled` is how near (rad) each joint has to come; `turn` is the hand's yaw (rad)
    when a cube of yaw 0 is gripped; `efforts` replace the file's limits by joint name (N m).
    """

    name: str
    joints: tuple[str, ...]
    tip: str
    home: tuple[float, ...]
    fingers: tuple[Finger, ...]
    gear: float = -1.0
    settled: float = 0.002
    turn: float = 0.0
    efforts: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Stand:
    """The box a robot stands on: footprint (m) about a point of the base frame, floor to base."""

    size: tuple[float, float]
    centre: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Robot:
    """A robot fixed in the world: its URDF, the pose of its base, its limbs."""

    name: str
    path: Path
    base: Pose
    limbs: tuple[Limb, ...]
    stand: Stand | None = None


def from_urdf(
    path: str | Path,
    *,
    limbs: tuple[Limb, ...],
    base: Any = IDENTITY,
    name: str = "",
    stand: Stand | None = None,
) -> Robot:
    """The robot in a URDF file on disk or in PyBullet's data; one limb or many.

    Raises FileNotFoundError when there is no such file. Joint and link names are looked up when a
    world loads it.
    """
    found = data_file(path)
    if found is None:
        raise FileNotFoundError(f"no robot description `{path}`")
    return Robot(name=name or found.stem, path=found, base=as_pose(base), limbs=limbs, stand=stand)


PANDA_ARM = Limb(
    name="arm",
    joints=tuple(f"panda_joint{k}" for k in range(1, 8)),
    tip="panda_grasptarget",
    home=(0.0, -math.pi / 4, 0.0, -3 * math.pi / 4, 0.0, math.pi / 2, math.pi / 4),
    fingers=(
        Finger(joint="panda_finger_joint1", opened=0.04),
        Finger(joint="panda_finger_joint2", opened=0.04),
    ),
)


def panda(base: Any = ((0.0, 0.0, 0.4), (0.0, 0.0, 0.0, 1.0))) -> Robot:
    """Franka's seven-joint arm with its hand, from PyBullet's data (Apache-2.0)."""
    return from_urdf(
        "franka_panda/panda.urdf",
        limbs=(PANDA_ARM,),
        base=base,
        name="panda",
        stand=Stand(size=(0.28, 0.26), centre=(-0.04, 0.0)),
    )
