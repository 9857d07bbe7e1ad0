"""The description of a robot: its URDF file, base, arms, grippers and tools.

Lengths are in m, angles in rad. A description with `parts` is several robots in one world.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from smachac.robots import fields
from smachac.robots.fields import (
    IDENTITY,
    DataError,
    Field,
    Fields,
    Place,
    Pose,
    Shape,
    Table,
    guess,
    in_metres,
    listed,
)
from smachac.robots.urdf import Mimic, Urdf, UrdfJoint

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

    @property
    def links(self) -> tuple[str, ...]:
        """The links that the description names."""
        return (self.tip, *(self.gripper.pads if self.gripper is not None else ()))


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

    `frames` are the names of its links, where the checker has no URDF file. `packages` are names of
    ROS packages and their folders, as written. `arguments` are those of a xacro file. `folder` is
    where its file was read, empty for text without a file.
    """

    name: str
    urdf: str
    limbs: tuple[Limb, ...]
    base: Pose = IDENTITY
    stand: Stand | None = None
    frames: tuple[str, ...] = ()
    packages: tuple[tuple[str, str], ...] = ()
    arguments: tuple[tuple[str, str], ...] = ()
    folder: str = ""

    @property
    def has_limits(self) -> bool:
        """Whether it has the limits of all its arms."""
        return all(limb.limits for limb in self.limbs)

    def package_folders(self, folder: Path) -> dict[str, Path]:
        """The folders of the packages by name; `folder` is that of the description."""
        return {name: folder / path for name, path in self.packages}


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


NO_PARTS = "name the robots of that file here, each as a part of its own"
"""The help for a station as a part of a station."""


def _centre(data: Any, place: Place) -> tuple[float, float]:
    x, y = _pair(data, place)
    return fields.near(x, (*place, 0)), fields.near(y, (*place, 1))


def _footprint(data: Any, place: Place) -> tuple[float, float]:
    x, y = _centre(data, place)
    return fields.positive(x, (*place, 0)), fields.positive(y, (*place, 1))


@fields.shape(fields.row(2, fields.number.schema))
def _pair(data: Any, place: Place) -> tuple[float, float]:
    found = fields.numbers(data, place)
    if len(found) != 2:
        help = fields.counted(found, "[lowest, highest]", 2)
        raise DataError(f"two numbers are expected, not {len(found)}", place, help)
    return found[0], found[1]


_STAND: Table = {
    "size": Field(Shape(_footprint, fields.row(2, fields.EXTENT)), "The footprint in x and y (m)."),
    "centre": Field(
        Shape(_centre, fields.row(2, fields.near.schema)),
        "The centre of the footprint in x and y (m), in the base frame.",
        (0.0, 0.0),
    ),
}


@fields.record(_STAND)
def _stand(given: Fields) -> Stand:
    return Stand(size=given["size"], centre=given["centre"])


_FINGER: Table = {
    "open": Field(fields.number, "The position when the gripper is open (m, or rad if it turns)."),
    "closed": Field(
        fields.number, "The position when the gripper is closed (m, or rad if it turns).", 0.0
    ),
}


@fields.record(_FINGER)
def _finger(given: Fields) -> Finger:
    opened, closed = given["open"], given["closed"]
    if opened == closed:
        help = f"write another position for `open` than `{closed:g}`, that of `closed`"
        raise DataError("the positions `open` and `closed` are the same", given.place, help)
    return Finger(joint=given.name, opened=opened, closed=closed)


WIDEST = 1.0
"""The largest width of a gripper (m): a larger one is written in millimetres."""

_WIDTH: Table = {
    "open": Field(
        Shape(fields.number.read, {"type": "number", "exclusiveMinimum": 0, "maximum": WIDEST}),
        "The width between the fingers when the gripper is open (m).",
    ),
    "closed": Field(
        Shape(fields.number.read, {"type": "number", "minimum": 0, "exclusiveMaximum": WIDEST}),
        "The width between the fingers when the gripper is closed (m).",
    ),
}


@fields.record(_WIDTH)
def _width(given: Fields) -> tuple[float, float]:
    opened, closed = given["open"], given["closed"]
    if not 0.0 <= closed < opened:
        raise _wrong_width(opened, closed, given.place)
    if opened > WIDEST:
        message = f"a gripper that opens {opened:g} m wide is larger than an arm"
        place = (*given.place, "open")
        raise DataError(message, place, in_metres(opened))
    return closed, opened


def _wrong_width(opened: float, closed: float, place: Place) -> DataError:
    """The mistake in widths of a gripper that is not wider when it is open."""
    if closed < 0.0:
        message = f"`closed` is {closed:g} m: a width is not negative"
        return DataError(message, (*place, "closed"), "write `closed: 0.0` if the fingers touch")
    if opened == closed:
        help = f"write a larger width for `open` than `{closed:g}`"
        return DataError(f"`open` and `closed` are the same width, {opened:g} m", place, help)
    message = f"`open` is {opened} m, less than `closed`, {closed} m"
    swapped = opened >= 0.0 and closed <= WIDEST
    pair = f"{{open: {closed}, closed: {opened}}}"
    help = f"write `{pair}`" if swapped else "write for `open` the larger width (m)"
    return DataError(message, place, help)


_GRIPPER: Table = {
    "joints": Field(fields.values(fields.named(_finger)), "The joints of the fingers, by name."),
    "width": Field(_width, "The width between the fingers (m)."),
    "pads": Field(
        fields.texts, "The links that touch a body; without it, the child links of the joints.", ()
    ),
    "force": Field(fields.positive, "The force of each finger (N, or N m if it turns).", 20.0),
    "anchored": Field(
        fields.truth,
        "The contacts of the pads are stiff and do not creep, as with <friction_anchor/>.",
        False,
    ),
}


@fields.record(_GRIPPER)
def _gripper(given: Fields) -> Gripper:
    width = given["width"]
    return Gripper(
        fingers=given["joints"],
        width=width,
        pads=given["pads"],
        force=given["force"],
        anchored=given["anchored"],
    )


_TOOL: Table = {
    "link": Field(fields.text, "The link of the tool frame."),
    "offset": Field(
        fields.pose, "The pose of the tool frame in the link: metres, and a quaternion.", IDENTITY
    ),
}


@fields.record(_TOOL)
def _tool_record(given: Fields) -> tuple[str, Pose]:
    return given["link"], given["offset"]


@fields.shape({"anyOf": [fields.text.schema, _tool_record.schema]})
def _tool(data: Any, place: Place) -> tuple[str, Pose]:
    if isinstance(data, str):
        return fields.text(data, place), IDENTITY
    return _tool_record(data, place)


@fields.shape({**fields.texts.schema, "uniqueItems": True})
def _joints(data: Any, place: Place) -> tuple[str, ...]:
    joints = fields.texts(data, place)
    for k, joint in enumerate(joints):
        if joint in joints[:k]:
            help = "remove it, or write the name of the joint that is missing"
            raise DataError(f"the joint `{joint}` is there twice", (*place, k), help)
    return joints


@fields.shape(_pair.schema)
def _limit(data: Any, place: Place) -> tuple[float, float]:
    low, high = _pair(data, place)
    if low > high:
        message = f"the lowest position {low:g} is above the highest {high:g}"
        raise DataError(message, place, f"write `[{high:g}, {low:g}]`")
    return low, high


def _for_each_joint(joints: Sequence[str], count: int) -> str:
    """The help for a list of `count` items that needs one for each joint of an arm."""
    if count < len(joints):
        return f"add the items of {fields.listed(joints[count:])}: one for each of the `joints`"
    return f"write {len(joints)}, one for each of the `joints`: {fields.listed(joints)}"


_ARM: Table = {
    "joints": Field(_joints, "The joints from the base to the hand."),
    "tool": Field(_tool, "The tool frame: a link, or a link and an offset."),
    "home": Field(fields.numbers, "The joint positions at the start (rad), one for each joint."),
    "grasp": Field(
        fields.pose,
        "The pose of the tool in the frame of a cube that it grasps: metres, and a quaternion.",
        DOWN,
    ),
    "gripper": Field(_gripper, "The gripper; an arm without one cannot grasp.", None),
    "tolerance": Field(
        fields.positive, "The tolerance of each joint at the end of a move (rad).", 0.002
    ),
    "efforts": Field(
        fields.named(fields.positive, least=0),
        "Largest torques of joints, by name (N m); they replace those of the URDF file.",
        (),
    ),
    "limits": Field(
        fields.each(_limit),
        "[lowest, highest] position of each joint (rad): then the checker reads no URDF file.",
        (),
    ),
    "speeds": Field(
        fields.each(fields.positive), "The largest speed of each joint (rad/s), for `limits`.", ()
    ),
}


@fields.record(_ARM)
def _limb(given: Fields) -> Limb:
    limb = Limb(
        name=given.name,
        joints=given["joints"],
        tip=given["tool"][0],
        offset=given["tool"][1],
        home=given["home"],
        limits=given["limits"],
        speeds=given["speeds"],
        gripper=given["gripper"],
        grasp=given["grasp"],
        settled=given["tolerance"],
        efforts=given["efforts"],
    )
    count = len(limb.joints)
    for key, size in (
        ("home", len(limb.home)),
        ("limits", len(limb.limits)),
        ("speeds", len(limb.speeds)),
    ):
        if size != count and (size or key == "home"):
            message = f"`{key}` has {size} items, but the arm has {count} joints"
            raise DataError(message, (*given.place, key), _for_each_joint(limb.joints, size))
    for k, (low, high) in enumerate(limb.limits):
        joint = UrdfJoint(name=limb.joints[k], kind="revolute", lower=low, upper=high)
        _inside(limb.home[k], joint, (*given.place, "home", k))
    for finger in limb.gripper.fingers if limb.gripper is not None else ():
        if finger.joint in limb.joints:
            spot = (*given.place, "gripper", "joints", finger.joint)
            help = f"remove it here, or remove `{finger.joint}` from the `joints` of the arm"
            raise DataError(f"the joint `{finger.joint}` is one of the arm", spot, help)
    return limb


_PART: Table = {
    "robot": Field(
        fields.text, "A built-in robot (panda, baxter, iiwa), or the file of a description."
    ),
    "base": Field(
        fields.pose,
        "The pose of its base in the frame `base` of the whole: metres, and a quaternion; without"
        " it, that of its description.",
        None,
    ),
}


@fields.record(_PART)
def _part(given: Fields) -> Part:
    place = (*given.place, "robot")
    return Part(name=given.name, robot=given["robot"], base=given["base"], place=place)


_NAME = Field(fields.text, "The name of the robot.")
_BASE = Field(
    fields.pose,
    "The pose of the base in the world: [[x, y, z], [qx, qy, qz, qw]] in metres, or [x, y, z].",
    IDENTITY,
)

_STATION: Table = {
    "name": _NAME,
    "base": _BASE,
    "parts": Field(
        fields.values(fields.named(_part, reserved=fields.FRAMES)),
        "Several robots in one world, by name.",
    ),
}


@fields.record(_STATION)
def _station(given: Fields) -> Station:
    return Station(name=given["name"], base=given["base"], parts=given["parts"])


@fields.shape({"type": ["string", "number", "boolean"]})
def _argument(data: Any, place: Place) -> str:
    if isinstance(data, bool):
        return "true" if data else "false"
    if not isinstance(data, str | int | float):
        message = f"a text, a number or a truth value is expected, not {fields.shown(data)}"
        raise DataError(message, place, "write the value as in `xacro FILE NAME:=VALUE`")
    return str(data)


_ROBOT: Table = {
    "name": _NAME,
    "urdf": Field(fields.text, "The URDF or xacro file: beside this file, or in PyBullet's data."),
    "base": _BASE,
    "stand": Field(_stand, "The box under the robot, from the floor to its base.", None),
    "arms": Field(fields.values(fields.named(_limb)), "The arms, by name."),
    "frames": Field(
        fields.texts, "The names of the links, for a robot whose URDF file is not read.", ()
    ),
    "packages": Field(
        fields.named(fields.text, least=0),
        "Folders of ROS packages, by name: those that the URDF file names.",
        (),
    ),
    "arguments": Field(
        fields.named(_argument, least=0), "Values of `<xacro:arg>`, by name, for a xacro file.", ()
    ),
}


@fields.record(_ROBOT)
def _robot(given: Fields) -> Description:
    return Description(
        name=given["name"],
        urdf=given["urdf"],
        base=given["base"],
        stand=given["stand"],
        limbs=given["arms"],
        frames=given["frames"],
        packages=given["packages"],
        arguments=given["arguments"],
    )


@fields.shape({"if": {"required": ["parts"]}, "then": _station.schema, "else": _robot.schema})
def _whole(data: Any, place: Place) -> Description | Station:
    several = isinstance(data, Mapping) and "parts" in data
    return _station(data, place) if several else _robot(data, place)


SCHEMA = _whole.schema
"""The JSON Schema of a description."""


def read(data: Any) -> Description | Station:
    """The description in the data of a YAML file. Raises DataError."""
    return _whole(data, ())


def check(robot: Description, urdf: Urdf) -> None:
    """Compare a description with its URDF file. Raises DataError for a joint or link that the file
    does not have, for joints that are not those from the base to the tool, for a joint without
    effort, and for a position outside the limits of its joint."""
    for limb in robot.limbs:
        place: Place = ("arms", limb.name)
        for k, name in enumerate(limb.joints):
            _moved(name, urdf, (*place, "joints", k))
            if urdf.joints[name].mimic is not None:
                raise _follows(urdf.leader(name), name, (*place, "joints", k))
        for k, (name, angle) in enumerate(zip(limb.joints, limb.home, strict=True)):
            _inside(angle, urdf.joints[name], (*place, "home", k))
        for name, _ in limb.efforts:
            _known(name, urdf.joints, "joint", (*place, "efforts", name))
        _known(limb.tip, urdf.links, "link", (*place, "tool"))
        _check_chain(limb, urdf, place)
        _check_efforts(limb, urdf, place)
        if limb.gripper is not None:
            _check_gripper(limb.gripper, urdf, (*place, "gripper"))


def _check_gripper(gripper: Gripper, urdf: Urdf, place: Place) -> None:
    for finger in gripper.fingers:
        at: Place = (*place, "joints", finger.joint)
        _moved(finger.joint, urdf, at)
        for key, position in (("open", finger.opened), ("closed", finger.closed)):
            _inside(position, urdf.joints[finger.joint], (*at, key))
        if urdf.joints[finger.joint].mimic is not None:
            _check_follower(finger, gripper, urdf, at)
    for k, name in enumerate(gripper.pads):
        _known(name, urdf.links, "link", (*place, "pads", k))


def _check_follower(finger: Finger, gripper: Gripper, urdf: Urdf, place: Place) -> None:
    """Raise DataError unless the gripper has the joint that a finger follows (`<mimic>`), with
    positions that lead to those of the finger."""
    leader = urdf.leader(finger.joint)
    first = next((other for other in gripper.fingers if other.joint == leader.joint), None)
    if first is None:
        raise _follows(leader, finger.joint, place)
    for key, position, led in (
        ("open", finger.opened, first.opened),
        ("closed", finger.closed, first.closed),
    ):
        reached = leader.multiplier * led + leader.offset
        if not math.isclose(position, reached, abs_tol=1e-6):
            message = f"`{finger.joint}` follows `{leader.joint}` (`<mimic>`) to {reached:.6g}"
            help = f"remove `{finger.joint}`, which needs no entry, or write `{key}: {reached:.6g}`"
            raise DataError(message, (*place, key), help)


def _follows(leader: Mimic, name: str, place: Place) -> DataError:
    """The mistake of a joint that follows another one and is named in its place."""
    message = f"the joint `{name}` follows `{leader.joint}` (`<mimic>`): no command moves it"
    help = f"write `{leader.joint}`, with its own positions, in its place, or remove it"
    return DataError(message, place, help)


def _check_chain(limb: Limb, urdf: Urdf, place: Place) -> None:
    """Raise DataError unless the joints of an arm are the last ones that move its tool, in their
    order. Joints before them, such as those of a torso, stay at 0."""
    chain = urdf.chain(limb.tip)
    moving = [joint.name for joint in chain if joint.kind != "fixed" and joint.mimic is None]
    wanted = f"write `joints: [{', '.join(moving)}]`" if moving else "name another link as `tool`"
    for k, name in enumerate(limb.joints):
        if name not in moving:
            message = f"the joint `{name}` does not move the tool link `{limb.tip}`"
            help = f"{wanted}: the joints from the root `{urdf.root}` to it" if moving else wanted
            raise DataError(message, (*place, "joints", k), help)
    start = min(moving.index(name) for name in limb.joints)
    order = [name for name in moving if name in limb.joints]
    if [*limb.joints] != order:
        message = "the joints are not in the order from the base to the tool"
        help = f"write `joints: [{', '.join(order)}]`, and `home` in the same order"
        raise DataError(message, (*place, "joints"), help)
    for name in moving[start:]:
        if name in limb.joints:
            continue
        joint = urdf.joints[name]
        message = f"the joint `{name}` also moves the tool link `{limb.tip}`"
        help = f"write `joints: [{', '.join(moving[start:])}]`, with its position in `home`"
        if not joint.is_moved:
            message += f", but an arm has no joint of the type {joint.kind}"
            help = "name the joints and the link of an arm without this joint"
        raise DataError(message, (*place, "joints"), help)


def _check_efforts(limb: Limb, urdf: Urdf, place: Place) -> None:
    for k, name in enumerate(limb.joints):
        joint = urdf.joints[name]
        if joint.effort == 0.0 and name not in dict(limb.efforts):
            message = (
                f"the joint `{name}` has the effort 0 in the URDF file: its motor cannot move it"
            )
            quantity = "torque (N m)" if joint.turns else "force (N)"
            help = f"add `efforts: {{{name}: 100}}` to the arm, with the largest {quantity}"
            raise DataError(message, (*place, "joints", k), help)


def _moved(name: str, urdf: Urdf, place: Place) -> None:
    """Raise DataError unless a joint is there and has a motor of its own."""
    _known(name, urdf.joints, "joint", place)
    joint = urdf.joints[name]
    if not joint.is_moved:
        moved = [other.name for other in urdf.joints.values() if other.is_moved]
        message = f"the joint `{name}` has the type {joint.kind}: no motor moves it"
        raise DataError(message, place, f"write a joint that moves: {listed(moved)}")


def _known(name: str, known: Collection[str], kind: str, place: Place) -> None:
    if name not in known:
        message = f"the URDF file has no {kind} `{name}`"
        raise DataError(message, place, guess(name, sorted(known)))


def _inside(position: float, joint: UrdfJoint, place: Place) -> None:
    slack = 1e-4
    if joint.lower - slack <= position <= joint.upper + slack:
        return
    limits = f"{joint.lower:g} to {joint.upper:g}"
    message = f"`{joint.name}` is {position:g} {joint.unit}, outside its limits {limits}"
    help = f"write a position from {limits}"
    if joint.turns and abs(position) > 2 * math.pi:
        help = f"write `{math.radians(position):.4g}`: angles are in radians, not in degrees"
    if not joint.turns and joint.lower <= position / 1000 <= joint.upper:
        help = in_metres(position)
    raise DataError(message, place, help)


def limb_names(part: str, limbs: Sequence[str]) -> tuple[str, ...]:
    """The names of the arms of a part: that of the part for the only arm, else `part_arm`."""
    return (part,) if len(limbs) == 1 else tuple(f"{part}_{limb}" for limb in limbs)
