"""Robots in a physics client: where their URDF files are, and how they are loaded.

The descriptions are those of `smachac.robots`; `mount` looks the names of joints and links up.
Lengths in m, angles in rad.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
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
    check,
    limb_names,
    read,
)
from smachac.robots.fields import DataError
from smachac.robots.files import BUILT_IN, FOLDER, SUFFIXES, built_in, find_file, read_file
from smachac.robots.urdf import Urdf, UrdfJoint
from smachac.sim import models
from smachac.sim.loading import load as load_file
from smachac.sim.physics import Engine, UnknownNameError, data_file
from smachac.sim.robot_file import EngineFile, RobotFile, engine_file, read_robot_file
from smachac.sim.transforms import IDENTITY, Pose, as_pose, compose

__all__ = ["BUILT_IN", "Finger", "Gripper", "Limb", "Robot", "RobotPart", "Stand", "from_urdf"]

# Robots


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotPart:
    """A robot fixed in the world: its URDF file, the pose of its base (world frame), its limbs."""

    name: str
    file: RobotFile
    base: Pose
    limbs: tuple[Limb, ...]
    stand: Stand | None = None

    def rest(self) -> dict[str, float]:
        """The position of each joint at the start (rad or m).

        That is its home in a limb; 0, or the limit nearest to it, for a joint of no limb; and for
        a joint that follows another one, the position in which it follows.
        """
        joints = self.file.urdf.joints
        rest = {name: min(max(0.0, joint.lower), joint.upper) for name, joint in joints.items()}
        for limb in self.limbs:
            rest |= zip(limb.joints, limb.home, strict=True)
        leaders = {name: self.file.urdf.leader(name) for name in joints}
        return {
            name: leader.multiplier * rest[leader.joint] + leader.offset
            for name, leader in leaders.items()
        }

    def engine_file(self) -> EngineFile:
        """The file for PyBullet. Raises LoadError."""
        used = {limb.tip for limb in self.limbs}
        for limb in self.limbs:
            used.update(limb.gripper.pads if limb.gripper is not None else ())
        return engine_file(self.file, used)


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

    Raises FileNotFoundError when there is no such file, LoadError for one that is no robot, and
    DataError for a limb that does not fit it.
    """
    found = data_file(path)
    if found is None:
        raise FileNotFoundError(f"no robot description `{path}`")
    place, title = as_pose(base), name or found.stem
    data = Description(name=title, urdf=str(path), limbs=limbs, base=place, stand=stand)
    return Robot(name=title, base=place, parts=(_checked(data, title, found),))


def load(name: str, base: Any = None, folders: Iterable[Path] = ()) -> Robot:
    """The built-in robot of that name, or the one that a YAML file describes.

    The file is searched in the working folder and in `folders`. `base` replaces the pose of the
    base. Raises UnknownNameError, FileNotFoundError, LoadError for a wrong URDF file, and DataError
    for a wrong description.
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
    for other in station.parts:
        found = _described(other.robot, ())
        if isinstance(found, Station):
            raise DataError("a part has no parts of its own", other.place, NO_PARTS)
        part = _part(found, other.name)
        place = part.base if other.base is None else compose(base, other.base)
        names = limb_names(other.name, [limb.name for limb in part.limbs])
        limbs = tuple(
            replace(limb, name=name) for limb, name in zip(part.limbs, names, strict=True)
        )
        yield replace(part, base=place, limbs=limbs)


def _part(found: Description, name: str) -> RobotPart:
    path = data_file(Path(found.folder) / found.urdf) or data_file(found.urdf)
    if path is None:
        raise FileNotFoundError(f"no URDF file `{found.urdf}` for the robot `{found.name}`")
    return _checked(found, name, path)


def _checked(found: Description, name: str, path: Path) -> RobotPart:
    """The robot of a description whose names and positions fit its URDF file."""
    packages = found.package_folders(Path(found.folder))
    file = read_robot_file(path, dict(found.arguments), packages)
    check(found, file.urdf)
    return RobotPart(name=name, file=file, base=found.base, limbs=found.limbs, stand=found.stand)


# Loading


_FINGER_FRICTION = 1.0
"""Lateral friction coefficient of the fingers."""
_GEAR_FORCE = 50.0
"""Largest force (N) of the constraint that couples two fingers."""
_ANCHORED = {"frictionAnchor": 1, "contactStiffness": 30000.0, "contactDamping": 1000.0}
"""Contacts of a finger that do not creep."""


SLIDE = 0.2
"""The way (m) of a joint that slides which counts as 1 rad of one that turns: in speeds,
tolerances, and steps of inverse kinematics."""
_NO_LIMIT = 1000.0
"""Force (N) or torque (N m) of a joint whose effort is not limited."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Follower:
    """A joint that follows one of a limb: PyBullet's number, the index of the other joint in the
    limb, and its largest force (N, or N m); its position is `multiplier` times that of the other
    joint, plus `offset`."""

    joint: int
    leader: int
    multiplier: float
    offset: float
    effort: float


@dataclass(frozen=True, slots=True, kw_only=True)
class MountedLimb:
    """A limb with PyBullet's numbers of its body, joints, fingers, pads and tip link.

    `base` is the pose of its robot's base (world frame). `facts` are those of its joints, `efforts`
    their largest torques and forces (N m, N). `fingers` are the joints of the gripper with those
    that follow them, described by `gripper`. `carriers` are the joints of other limbs between the
    base and the tip, by name.
    """

    limb: Limb
    gripper: Gripper | None
    body: int
    base: Pose
    joints: tuple[int, ...]
    fingers: tuple[int, ...]
    pads: tuple[int, ...]
    tip: int
    facts: tuple[UrdfJoint, ...]
    efforts: tuple[float, ...]
    followers: tuple[Follower, ...]
    carriers: Mapping[str, int]


def mount(engine: Engine, part: RobotPart, file: EngineFile) -> tuple[int, tuple[MountedLimb, ...]]:
    """Load a robot on its stand, every joint held at its rest: its body and its limbs.

    `file` is that of `part.engine_file()`. Raises LoadError.
    """
    if part.stand is not None:
        models.stand(engine, part.stand.size, part.stand.centre, part.base)
    (body,) = load_file(
        engine, file, basePosition=part.base[0], baseOrientation=part.base[1], useFixedBase=True
    )
    facts, rest = part.file.urdf.joints, part.rest()
    joints: dict[str, int] = {}
    links: dict[str, int] = {part.file.urdf.root: -1}
    for index in range(engine.getNumJoints(body)):
        known = engine.getJointInfo(body, index)
        name = known[1].decode()
        joints[name], links[known[12].decode()] = index, index
        if facts[name].is_moved:
            # PyBullet's default velocity motors act against position control: they are switched
            # off. Joints that belong to no limb stay at their rest.
            engine.setJointMotorControl2(body, index, engine.VELOCITY_CONTROL, force=0.0)
            engine.resetJointState(body, index, rest[name])
            engine.setJointMotorControl2(
                body,
                index,
                engine.POSITION_CONTROL,
                targetPosition=rest[name],
                force=_force(facts[name]) or _NO_LIMIT,
            )
    limbs = tuple(_mounted(limb, body, part, joints, links) for limb in part.limbs)
    for limb in limbs:
        _configure_fingers(engine, body, limb)
    return body, limbs


def _mounted(
    limb: Limb, body: int, part: RobotPart, joints: dict[str, int], links: dict[str, int]
) -> MountedLimb:
    """The limb with the numbers of its names."""
    urdf, efforts = part.file.urdf, dict(limb.efforts)
    gripper = _with_followers(limb.gripper, urdf)
    fingers = gripper.fingers if gripper is not None else ()
    pads = gripper.pads if gripper is not None else ()
    driven = tuple(joints[finger.joint] for finger in fingers)
    leaders = [urdf.leader(joint.name).joint for joint in urdf.chain(limb.tip) if joint.is_moved]
    return MountedLimb(
        limb=limb,
        gripper=gripper,
        body=body,
        base=part.base,
        joints=tuple(joints[name] for name in limb.joints),
        fingers=driven,
        pads=tuple(links[name] for name in pads) or driven,
        tip=links[limb.tip],
        facts=tuple(urdf.joints[name] for name in limb.joints),
        efforts=tuple(efforts.get(name, _force(urdf.joints[name])) for name in limb.joints),
        followers=tuple(_followers(limb, urdf, joints, {finger.joint for finger in fingers})),
        carriers={name: joints[name] for name in leaders if name not in limb.joints},
    )


def _followers(
    limb: Limb, urdf: Urdf, joints: Mapping[str, int], fingers: Collection[str]
) -> Iterable[Follower]:
    """The joints that follow those of a limb, without its fingers."""
    for name, joint in urdf.joints.items():
        leader = urdf.leader(name)
        if joint.mimic is None or name in fingers or leader.joint not in limb.joints:
            continue
        if joint.is_moved:
            yield Follower(
                joint=joints[name],
                leader=limb.joints.index(leader.joint),
                multiplier=leader.multiplier,
                offset=leader.offset,
                effort=_force(joint) or _NO_LIMIT,
            )


def _force(joint: UrdfJoint) -> float:
    """The largest force (N) or torque (N m) of the motor of a joint."""
    return joint.effort if math.isfinite(joint.effort) else _NO_LIMIT


def _with_followers(gripper: Gripper | None, urdf: Urdf) -> Gripper | None:
    """The gripper with the joints that follow its own (`<mimic>`) as further fingers."""
    if gripper is None:
        return None
    fingers = {finger.joint: finger for finger in gripper.fingers}
    for name, joint in urdf.joints.items():
        leader = urdf.leader(name)
        first = fingers.get(leader.joint)
        if name in fingers or first is None or not joint.is_moved or leader.multiplier == 0.0:
            continue
        fingers[name] = Finger(
            joint=name,
            opened=leader.multiplier * first.opened + leader.offset,
            closed=leader.multiplier * first.closed + leader.offset,
        )
    return replace(gripper, fingers=tuple(fingers.values()))


def _configure_fingers(engine: Engine, body: int, mounted: MountedLimb) -> None:
    """Set the friction of the pads, and couple the joints of the gripper to its first one."""
    gripper = mounted.gripper
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
        engine.changeConstraint(
            gear,
            gearRatio=ratio,
            relativePositionTarget=first.closed + ratio * finger.closed,
            erp=0.1,
            maxForce=_GEAR_FORCE,
        )
