"""Robots in a physics client: where their URDF files are, and how they are loaded.

The descriptions are those of `smachac.robots`; `mount` looks the names of joints and links up.
Lengths in m, angles in rad.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from smachac.robots.description import (
    NO_PARTS,
    Description,
    Finger,
    Gripper,
    Limb,
    Stand,
    Station,
    limb_names,
    read,
)
from smachac.robots.fields import DataError
from smachac.robots.files import BUILT_IN, FOLDER, SUFFIXES, built_in, find_file, read_file
from smachac.sim import models
from smachac.sim.physics import Engine, UnknownNameError, data_file, quiet
from smachac.sim.transforms import IDENTITY, Pose, as_pose, compose

__all__ = ["BUILT_IN", "Finger", "Gripper", "Limb", "Robot", "RobotPart", "Stand", "from_urdf"]

# Robots


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotPart:
    """A robot fixed in the world: its URDF file, the pose of its base (world frame), its limbs."""

    name: str
    path: Path
    base: Pose
    limbs: tuple[Limb, ...]
    stand: Stand | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Robot:
    """The robots of a world, one or several; poses are given in the frame `base` (world frame)."""

    name: str
    base: Pose
    parts: tuple[RobotPart, ...]

    @property
    def limbs(self) -> tuple[Limb, ...]:
        """The limbs of all parts; their names differ."""
        return tuple(limb for part in self.parts for limb in part.limbs)


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
    place, title = as_pose(base), name or found.stem
    part = RobotPart(name=title, path=found, base=place, limbs=limbs, stand=stand)
    return Robot(name=title, base=place, parts=(part,))


def load(name: str, base: Any = None, folders: Iterable[Path] = ()) -> Robot:
    """The built-in robot of that name, or the one that a YAML file describes.

    The file is searched in the working folder and in `folders`. `base` replaces the pose of the
    base. Raises UnknownNameError, FileNotFoundError, and DataError for a wrong description.
    """
    found = _described(name, tuple(folders))
    if isinstance(found, Station):
        place = found.base if base is None else as_pose(base)
        return Robot(name=found.name, base=place, parts=tuple(_parts(found, place)))
    part = _part(found, found.name)
    if base is not None:
        part = replace(part, base=as_pose(base))
    return Robot(name=found.name, base=part.base, parts=(part,))


def panda(base: Any = None) -> Robot:
    """Franka's seven-joint arm with its hand, from PyBullet's data (Apache-2.0)."""
    return load("panda", base)


def baxter(base: Any = None) -> Robot:
    """Baxter, with two arms of seven joints and electric grippers, made of simple shapes."""
    return load("baxter", base)


def iiwa(base: Any = None) -> Robot:
    """The KUKA LBR iiwa 14 with a gripper of two fingers, made of simple shapes."""
    return load("iiwa", base)


def _described(name: str, folders: tuple[Path, ...]) -> Description | Station:
    if not name.lower().endswith(SUFFIXES):
        if name not in BUILT_IN:
            raise UnknownNameError("robot", name, BUILT_IN)
        return _in_folder(built_in(name), FOLDER)
    path = find_file(name, folders)
    return _in_folder(read(read_file(path)), path.parent)


def _in_folder(found: Description | Station, folder: Path) -> Description | Station:
    if isinstance(found, Description):
        return replace(found, folder=str(folder))
    # The parts of a station are found beside it.
    parts = tuple(
        replace(part, robot=str(folder / part.robot)) if part.robot.endswith(SUFFIXES) else part
        for part in found.parts
    )
    return replace(found, parts=parts)


def _parts(station: Station, base: Pose) -> Iterable[RobotPart]:
    """The robots of a station; their bases are given in its frame."""
    for each in station.parts:
        found = _described(each.robot, ())
        if isinstance(found, Station):
            raise DataError("a part has no parts of its own", each.place, NO_PARTS)
        part = _part(found, each.name)
        place = part.base if each.base is None else compose(base, each.base)
        names = limb_names(each.name, [limb.name for limb in part.limbs])
        limbs = tuple(
            replace(limb, name=name) for limb, name in zip(part.limbs, names, strict=True)
        )
        yield replace(part, base=place, limbs=limbs)


def _part(found: Description, name: str) -> RobotPart:
    path = data_file(Path(found.folder) / found.urdf) or data_file(found.urdf)
    if path is None:
        raise FileNotFoundError(f"no URDF file `{found.urdf}` for the robot `{found.name}`")
    return RobotPart(name=name, path=path, base=found.base, limbs=found.limbs, stand=found.stand)


# Loading


_FINGER_FRICTION = 1.0
"""Lateral friction coefficient of the fingers."""
_GEAR_FORCE = 50.0
"""Largest force (N) of the constraint that couples two fingers."""
_ANCHORED = {"frictionAnchor": 1, "contactStiffness": 30000.0, "contactDamping": 1000.0}
"""Contacts of a finger that do not creep."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MountedLimb:
    """A limb with PyBullet's numbers of its body, joints, fingers, pads and tip link.

    `base` is the pose of its robot's base (world frame). `limits` are (lowest, highest) positions
    in rad, `speeds` in rad/s, `efforts` in N m.
    """

    limb: Limb
    body: int
    base: Pose
    joints: tuple[int, ...]
    fingers: tuple[int, ...]
    pads: tuple[int, ...]
    tip: int
    limits: tuple[tuple[float, float], ...]
    speeds: tuple[float, ...]
    efforts: tuple[float, ...]


def mount(engine: Engine, part: RobotPart) -> tuple[int, tuple[MountedLimb, ...]]:
    """Load a robot on its stand, every joint held at 0: its body and its limbs.

    Raises UnknownNameError when a limb names a joint or link that the file does not have.
    """
    if part.stand is not None:
        models.stand(engine, part.stand.size, part.stand.centre, part.base)
    with quiet():
        body = engine.loadURDF(str(part.path), part.base[0], part.base[1], useFixedBase=True)
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
    limbs = tuple(_mounted(limb, body, part.base, joints, links) for limb in part.limbs)
    for each in limbs:
        _configure_fingers(engine, body, each)
    return body, limbs


def _mounted(
    limb: Limb, body: int, base: Pose, joints: dict[str, Any], links: dict[str, int]
) -> MountedLimb:
    """The limb with the numbers of its names; `joints` are PyBullet's records by joint name."""
    fingers = limb.gripper.fingers if limb.gripper is not None else ()
    pads = limb.gripper.pads if limb.gripper is not None else ()
    for name in (*limb.joints, *(finger.joint for finger in fingers)):
        if name not in joints:
            raise UnknownNameError("joint", name, tuple(joints))
    for name in (limb.tip, *pads):
        if name not in links:
            raise UnknownNameError("link", name, tuple(links))
    efforts = dict(limb.efforts)
    found = [joints[name] for name in limb.joints]
    driven = tuple(joints[finger.joint][0] for finger in fingers)
    return MountedLimb(
        limb=limb,
        body=body,
        base=base,
        joints=tuple(each[0] for each in found),
        fingers=driven,
        pads=tuple(links[name] for name in pads) or driven,
        tip=links[limb.tip],
        limits=tuple((each[8], each[9]) for each in found),
        speeds=tuple(each[11] for each in found),
        efforts=tuple(float(efforts.get(name) or joints[name][10]) for name in limb.joints),
    )


def _configure_fingers(engine: Engine, body: int, mounted: MountedLimb) -> None:
    """Set the friction of the pads, and couple the joints of the gripper to its first one."""
    gripper = mounted.limb.gripper
    if gripper is None:
        return
    for pad in mounted.pads:
        engine.changeDynamics(
            body,
            pad,
            lateralFriction=_FINGER_FRICTION,
            spinningFriction=0.001,
            restitution=0.0,
            **(_ANCHORED if gripper.anchored else {}),
        )
    if len(gripper.fingers) != 2:
        return  # `JointControl.follow` couples more than two.
    first = gripper.fingers[0]
    for finger, index in zip(gripper.fingers[1:], mounted.fingers[1:], strict=True):
        # Without this coupling a closing hand moves the block by 12 mm.
        gear = engine.createConstraint(
            body,
            mounted.fingers[0],
            body,
            index,
            engine.JOINT_GEAR,
            (1, 0, 0),
            (0, 0, 0),
            (0, 0, 0),
        )
        ratio = -(first.opened - first.closed) / (finger.opened - finger.closed)
        engine.changeConstraint(gear, gearRatio=ratio, erp=0.1, maxForce=_GEAR_FORCE)
