"""Robots: their descriptions as data, those that are known, and how one is loaded.

A description names a URDF file and the joints of each limb; it needs no PyBullet. `mount` loads the
robot into a physics client and looks the names up there. Lengths in m, angles in rad.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from smachac.sim import models
from smachac.sim.physics import Engine, UnknownNameError, data_file, quiet
from smachac.sim.transforms import IDENTITY, Pose, as_pose

# Descriptions


@dataclass(frozen=True, slots=True, kw_only=True)
class Finger:
    """A sliding finger: its joint and that joint's position (m) when open and when closed."""

    joint: str
    opened: float
    closed: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Limb:
    """An arm with a gripper: joints from the base to the hand, tip frame, fingers, home.

    `home` holds the joint positions (rad) at the start. `gear` couples the two fingers (ratio of a
    JOINT_GEAR constraint; -1 where both open with the same sign). `settled` is the tolerance (rad)
    of each joint at the end of a move. `turn` is the yaw of the hand (rad) when it grips a cube of
    yaw 0. `efforts` are pairs of a joint name and its largest torque (N m), which replaces that of
    the file.
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
    """The box under a robot, from the floor to its base: footprint `size` (x, y) in m.

    `centre` (x, y) of the footprint is in m in the base frame.
    """

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

    Raises FileNotFoundError when there is no such file. Joint and link names are checked when a
    world loads the robot.
    """
    found = data_file(path)
    if found is None:
        raise FileNotFoundError(f"no robot description `{path}`")
    return Robot(name=name or found.stem, path=found, base=as_pose(base), limbs=limbs, stand=stand)


# Known robots


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


# Loading


_FINGER_FRICTION = 1.0
"""Lateral friction coefficient of the fingers."""
_GEAR_FORCE = 50.0
"""Largest force (N) of the constraint that couples two fingers."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MountedLimb:
    """A limb with PyBullet's numbers of its joints, fingers and tip link, and its joint limits.

    `limits` are (lowest, highest) positions in rad, `speeds` in rad/s, `efforts` in N m.
    """

    limb: Limb
    joints: tuple[int, ...]
    fingers: tuple[int, ...]
    tip: int
    limits: tuple[tuple[float, float], ...]
    speeds: tuple[float, ...]
    efforts: tuple[float, ...]


def mount(engine: Engine, robot: Robot) -> tuple[int, tuple[MountedLimb, ...]]:
    """Load the robot on its stand, every joint held at 0: its body and its limbs.

    Raises UnknownNameError when a limb names a joint or link that the file does not have.
    """
    if robot.stand is not None:
        models.stand(engine, robot.stand.size, robot.stand.centre, robot.base)
    with quiet():
        body = engine.loadURDF(str(robot.path), robot.base[0], robot.base[1], useFixedBase=True)
    known = [engine.getJointInfo(body, k) for k in range(engine.getNumJoints(body))]
    for each in known:
        if each[2] != engine.JOINT_FIXED:
            # PyBullet's default velocity motors act against position control: they are switched
            # off. Joints that belong to no limb stay at 0.
            engine.setJointMotorControl2(body, each[0], engine.VELOCITY_CONTROL, force=0.0)
            engine.setJointMotorControl2(
                body, each[0], engine.POSITION_CONTROL, targetPosition=0.0, force=each[10]
            )
    joints = {each[1].decode(): each for each in known}
    links = {each[12].decode(): each[0] for each in known}
    limbs = tuple(_mounted(limb, joints, links) for limb in robot.limbs)
    for each in limbs:
        _configure_fingers(engine, body, each)
    return body, limbs


def _mounted(limb: Limb, joints: dict[str, Any], links: dict[str, int]) -> MountedLimb:
    """The limb with the numbers of its names; `joints` are PyBullet's records by joint name."""
    for name in (*limb.joints, *(finger.joint for finger in limb.fingers)):
        if name not in joints:
            raise UnknownNameError("joint", name, tuple(joints))
    if limb.tip not in links:
        raise UnknownNameError("link", limb.tip, tuple(links))
    efforts = dict(limb.efforts)
    found = [joints[name] for name in limb.joints]
    return MountedLimb(
        limb=limb,
        joints=tuple(each[0] for each in found),
        fingers=tuple(joints[finger.joint][0] for finger in limb.fingers),
        tip=links[limb.tip],
        limits=tuple((each[8], each[9]) for each in found),
        speeds=tuple(each[11] for each in found),
        efforts=tuple(float(efforts.get(name) or joints[name][10]) for name in limb.joints),
    )


def _configure_fingers(engine: Engine, body: int, mounted: MountedLimb) -> None:
    """Set the friction of the fingers and couple them, if there are two."""
    for finger in mounted.fingers:
        engine.changeDynamics(
            body,
            finger,
            lateralFriction=_FINGER_FRICTION,
            spinningFriction=0.001,
            restitution=0.0,
        )
    if len(mounted.fingers) != 2:
        return
    # Without this coupling a closing hand moves the block by 12 mm.
    gear = engine.createConstraint(
        body,
        mounted.fingers[0],
        body,
        mounted.fingers[1],
        engine.JOINT_GEAR,
        (1, 0, 0),
        (0, 0, 0),
        (0, 0, 0),
    )
    engine.changeConstraint(gear, gearRatio=mounted.limb.gear, erp=0.1, maxForce=_GEAR_FORCE)
