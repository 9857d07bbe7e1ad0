"""The description of a robot: its URDF file, base, arms, grippers and tools.

Lengths are in m, angles in rad. A description with `parts` is several robots in one world.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from smachac.robots import fields
from smachac.robots.fields import IDENTITY, DataError, Fields, Place, Pose, guess

DOWN: Pose = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))
"""The pose of a tool in the frame of a body that it grasps from above."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Finger:
    """A joint of a gripper and its position when open and when closed (m, or rad if it turns)."""

    joint: str
    opened: float
    closed: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Gripper:
    """A gripper: its joints, and the width between its fingers when closed and when open (m).

    `pads` are the links that touch a body; empty: the child links of the joints. `force` is that of
    each finger (N, or N m if it turns). `anchored`: the contacts of the pads are stiff and do not
    creep, as `<contact>` with `<friction_anchor/>` in a URDF file gives them.
    """

    fingers: tuple[Finger, ...]
    width: tuple[float, float]
    pads: tuple[str, ...] = ()
    force: float = 20.0
    anchored: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Limb:
    """An arm: joints from the base to the hand, tool frame, home, gripper.

    The tool frame is the link `tip` moved by `offset`. `home` has the joint positions at the start.
    `grasp` is the pose of the tool in the frame of a cube that it grasps. `settled` is the
    tolerance (rad) of each joint at the end of a move. `efforts` are pairs of a joint and its
    largest torque (N m), which replaces that of the URDF file. `limits` (lowest, highest) are those
    of the joints where the checker has no URDF file, `speeds` their largest speeds (rad/s); empty:
    those of the URDF file.
    """

    name: str
    joints: tuple[str, ...]
    tip: str
    home: tuple[float, ...]
    offset: Pose = IDENTITY
    grasp: Pose = DOWN
    gripper: Gripper | None = None
    settled: float = 0.002
    efforts: tuple[tuple[str, float], ...] = ()
    limits: tuple[tuple[float, float], ...] = ()
    speeds: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Stand:
    """The box under a robot, from the floor to its base: footprint `size` (x, y) in m.

    `centre` (x, y) of the footprint is in m in the base frame.
    """

    size: tuple[float, float]
    centre: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Description:
    """A robot that stands with its base at `base` (world frame); `urdf` is its file, as written.

    `frames` are the names of its links, where the checker has no URDF file. `folder` is where its
    file was read, empty for text without a file.
    """

    name: str
    urdf: str
    limbs: tuple[Limb, ...]
    base: Pose = IDENTITY
    stand: Stand | None = None
    frames: tuple[str, ...] = ()
    folder: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """A robot among several: its name, the name or file of its description, its base."""

    name: str
    robot: str
    base: Pose | None
    place: Place


@dataclass(frozen=True, slots=True, kw_only=True)
class Station:
    """Several robots in one world; `base` is the frame in which poses are given (world frame)."""

    name: str
    parts: tuple[Part, ...]
    base: Pose = IDENTITY


def read(data: Any) -> Description | Station:
    """The description in the data of a YAML file. Raises DataError."""
    if isinstance(data, Mapping) and "parts" in data:
        given = Fields(data, (), ("name", "base", "parts"))
        return Station(
            name=given.take("name", fields.text),
            base=given.get("base", fields.pose, IDENTITY),
            parts=given.take("parts", lambda each, place: fields.named(each, place, _part)),
        )
    given = Fields(data, (), ("name", "urdf", "base", "stand", "arms", "frames"))
    return Description(
        name=given.take("name", fields.text),
        urdf=given.take("urdf", fields.text),
        base=given.get("base", fields.pose, IDENTITY),
        stand=given.get("stand", _stand, None),
        limbs=given.take("arms", lambda each, place: fields.named(each, place, _limb)),
        frames=given.get("frames", fields.texts, ()),
    )


def _part(name: str, data: Any, place: Place) -> Part:
    fields.no_frame(name, place)
    given = Fields(data, place, ("robot", "base"))
    robot = given.take("robot", fields.text)
    base = given.get("base", fields.pose, None)
    return Part(name=name, robot=robot, base=base, place=(*place, "robot"))


def _stand(data: Any, place: Place) -> Stand:
    given = Fields(data, place, ("size", "centre"))
    return Stand(
        size=given.take("size", _footprint), centre=given.get("centre", _centre, (0.0, 0.0))
    )


def _footprint(data: Any, place: Place) -> tuple[float, float]:
    x, y = _centre(data, place)
    return fields.positive(x, (*place, 0)), fields.positive(y, (*place, 1))


def _centre(data: Any, place: Place) -> tuple[float, float]:
    x, y = _pair(data, place)
    return fields.near(x, (*place, 0)), fields.near(y, (*place, 1))


def _pair(data: Any, place: Place) -> tuple[float, float]:
    found = fields.numbers(data, place)
    if len(found) != 2:
        raise DataError(f"two numbers are expected, not {len(found)}", place)
    return found[0], found[1]


_ARM = (
    *("joints", "tool", "home", "grasp", "gripper", "tolerance", "efforts", "limits", "speeds"),
)


def _limb(name: str, data: Any, place: Place) -> Limb:
    given = Fields(data, place, _ARM)
    joints = given.take("joints", fields.texts)
    for k, joint in enumerate(joints):
        if joint in joints[:k]:
            raise DataError(f"the joint `{joint}` is there twice", (*place, "joints", k))
    tip, offset = given.take("tool", _tool)
    home = given.take("home", fields.numbers)
    limits: tuple[tuple[float, float], ...] = given.get("limits", _limits, ())
    speeds: tuple[float, ...] = given.get("speeds", _speeds, ())
    gripper = given.get("gripper", _gripper, None)
    for key, found in (("home", home), ("limits", limits), ("speeds", speeds)):
        if found and len(found) != len(joints):
            message = f"`{key}` has {len(found)} items, but the arm has {len(joints)} joints"
            raise DataError(message, (*place, key))
    for k, (low, high) in enumerate(limits):
        _inside(joints[k], home[k], UrdfJoint(low, high, turns=True), (*place, "home", k))
    for finger in gripper.fingers if gripper is not None else ():
        if finger.joint in joints:
            spot = (*place, "gripper", "joints", finger.joint)
            raise DataError(f"the joint `{finger.joint}` is one of the arm", spot)
    return Limb(
        name=name,
        joints=joints,
        tip=tip,
        offset=offset,
        home=home,
        grasp=given.get("grasp", fields.pose, DOWN),
        gripper=gripper,
        settled=given.get("tolerance", fields.positive, 0.002),
        efforts=given.get("efforts", _efforts, ()),
        limits=limits,
        speeds=speeds,
    )


def _tool(data: Any, place: Place) -> tuple[str, Pose]:
    if isinstance(data, str):
        return fields.text(data, place), IDENTITY
    given = Fields(data, place, ("link", "offset"))
    return given.take("link", fields.text), given.get("offset", fields.pose, IDENTITY)


def _limits(data: Any, place: Place) -> tuple[tuple[float, float], ...]:
    rows = enumerate(fields.items(data, place))
    found = tuple(_pair(each, (*place, k)) for k, each in rows)
    for k, (low, high) in enumerate(found):
        if low > high:
            message = f"the lowest position {low:g} is above the highest {high:g}"
            raise DataError(message, (*place, k))
    return found


def _speeds(data: Any, place: Place) -> tuple[float, ...]:
    rows = enumerate(fields.items(data, place))
    return tuple(fields.positive(each, (*place, k)) for k, each in rows)


def _efforts(data: Any, place: Place) -> tuple[tuple[str, float], ...]:
    return fields.named(data, place, lambda name, each, at: (name, fields.positive(each, at)))


def _gripper(data: Any, place: Place) -> Gripper:
    given = Fields(data, place, ("joints", "width", "pads", "force", "anchored"))
    closed, opened = given.take("width", _width)
    return Gripper(
        fingers=given.take("joints", lambda each, at: fields.named(each, at, _finger)),
        width=(closed, opened),
        pads=given.get("pads", fields.texts, ()),
        force=given.get("force", fields.positive, 20.0),
        anchored=given.get("anchored", fields.truth, False),
    )


def _width(data: Any, place: Place) -> tuple[float, float]:
    given = Fields(data, place, ("open", "closed"))
    opened, closed = given.take("open", fields.number), given.take("closed", fields.number)
    if not 0.0 <= closed < opened:
        raise DataError("a gripper is wider when it is open", place)
    if opened > 1.0:
        message = f"a gripper that opens {opened:g} m wide is larger than an arm"
        raise DataError(message, (*place, "open"), "lengths are in metres, not in millimetres")
    return closed, opened


def _finger(name: str, data: Any, place: Place) -> Finger:
    given = Fields(data, place, ("open", "closed"))
    opened, closed = given.take("open", fields.number), given.get("closed", fields.number, 0.0)
    if opened == closed:
        raise DataError("the positions `open` and `closed` are the same", place)
    return Finger(joint=name, opened=opened, closed=closed)


@dataclass(frozen=True, slots=True)
class UrdfJoint:
    """A joint of a URDF file: its limits (rad or m), and whether it turns."""

    lower: float
    upper: float
    turns: bool


def check(robot: Description, joints: Mapping[str, UrdfJoint], links: Collection[str]) -> None:
    """Compare a description with its URDF file. Raises DataError for a joint or link that the file
    does not have, and for a position outside the limits of its joint."""
    for limb in robot.limbs:
        place: Place = ("arms", limb.name)
        for k, name in enumerate(limb.joints):
            _known(name, joints, "joint", (*place, "joints", k))
        for k, (name, angle) in enumerate(zip(limb.joints, limb.home, strict=True)):
            _inside(name, angle, joints[name], (*place, "home", k))
        for name, _ in limb.efforts:
            _known(name, joints, "joint", (*place, "efforts", name))
        _known(limb.tip, links, "link", (*place, "tool"))
        if limb.gripper is None:
            continue
        place = (*place, "gripper")
        for finger in limb.gripper.fingers:
            at: Place = (*place, "joints", finger.joint)
            _known(finger.joint, joints, "joint", at)
            for key, position in (("open", finger.opened), ("closed", finger.closed)):
                _inside(finger.joint, position, joints[finger.joint], (*at, key))
        for k, name in enumerate(limb.gripper.pads):
            _known(name, links, "link", (*place, "pads", k))


def _known(name: str, known: Collection[str], kind: str, place: Place) -> None:
    if name not in known:
        message = f"the URDF file has no {kind} `{name}`"
        raise DataError(message, place, guess(name, sorted(known)))


def _inside(name: str, position: float, joint: UrdfJoint, place: Place) -> None:
    slack = 1e-4
    if joint.lower - slack <= position <= joint.upper + slack:
        return
    unit = "rad" if joint.turns else "m"
    message = (
        f"`{name}` is {position:g} {unit}, outside its limits {joint.lower:g} to {joint.upper:g}"
    )
    help = f"the limits are in {unit}"
    if joint.turns and abs(position) > 2 * math.pi:
        help = "angles are in radians, not in degrees"
    if not joint.turns and joint.lower <= position / 1000 <= joint.upper:
        help = "lengths are in metres, not in millimetres"
    raise DataError(message, place, help)


def limb_names(part: str, limbs: Sequence[str]) -> tuple[str, ...]:
    """The names of the arms of a part: that of the part for the only arm, else `part_arm`."""
    return (part,) if len(limbs) == 1 else tuple(f"{part}_{limb}" for limb in limbs)
