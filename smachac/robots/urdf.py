"""URDF, the robot description of ROS: its joints with their limits, and its links.

The checker and the simulation read the same facts here. Lengths are in m, angles in rad. What a
file leaves out has the default of the URDF specification.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches

from smachac.robots.fields import guess, listed
from smachac.robots.urdf_format import check_format, number, numbers
from smachac.robots.xml_tree import Element, TextPlace, XmlError, parse

TURNING = frozenset(["revolute", "continuous"])
"""The types of joints whose position is an angle."""
MOVED = TURNING | {"prismatic"}
"""The types of joints with one position: those that an arm or a gripper can have."""
_MOST_LISTED = 8
"""The most links that a message lists."""
KINDS = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")
"""The types of joints."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Mimic:
    """The joint that a joint follows: its position is `multiplier` times that of `joint`, plus
    `offset`."""

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class UrdfJoint:
    """A joint of a URDF file.

    `lower` and `upper` are its limits (rad, or m if it is prismatic); infinite for a joint without
    limits (continuous, floating, planar, fixed). A `<limit>` without one of them has 0 for it.
    `velocity` is its largest speed (rad/s or m/s); infinite where the file has no positive one.
    `effort` is its largest torque or force (N m or N); infinite for a joint without `<limit>`, 0
    for a `<limit>` without it. `place` is that of its name in the text.
    """

    name: str
    kind: str
    parent: str = ""
    child: str = ""
    lower: float = -math.inf
    upper: float = math.inf
    velocity: float = math.inf
    effort: float = math.inf
    mimic: Mimic | None = None
    place: TextPlace = (0, 0)

    @property
    def turns(self) -> bool:
        """Whether its position is an angle (rad)."""
        return self.kind in TURNING

    @property
    def is_moved(self) -> bool:
        """Whether it has one position, which a motor can change."""
        return self.kind in MOVED

    @property
    def is_limited(self) -> bool:
        """Whether it has limits."""
        return math.isfinite(self.lower)

    @property
    def unit(self) -> str:
        """The unit of its position."""
        return "rad" if self.turns else "m"


@dataclass(frozen=True, slots=True, kw_only=True)
class Urdf:
    """A robot: a tree of links; `joints` by name, in the order of the file. `tree` is the outermost
    element of its `text`."""

    name: str
    root: str
    links: tuple[str, ...]
    joints: Mapping[str, UrdfJoint]
    text: str = field(repr=False)
    tree: Element = field(repr=False)

    def chain(self, link: str) -> tuple[UrdfJoint, ...]:
        """The joints from the root to a link."""
        above = {joint.child: joint for joint in self.joints.values()}
        found: list[UrdfJoint] = []
        while link in above:
            found.append(above[link])
            link = found[-1].parent
        return tuple(reversed(found))

    def leader(self, name: str) -> Mimic:
        """The joint that a joint follows, over all joints between the two; itself if it follows
        none."""
        found = Mimic(joint=name)
        while (mimic := self.joints[found.joint].mimic) is not None:
            found = Mimic(
                joint=mimic.joint,
                multiplier=found.multiplier * mimic.multiplier,
                offset=found.multiplier * mimic.offset + found.offset,
            )
        return found


def read(text: str) -> Urdf:
    """The robot that a text describes. Raises XmlError."""
    robot = parse(text)
    check_format(robot, text)
    links: dict[str, Element] = {}
    joints: dict[str, UrdfJoint] = {}
    for element in robot.children:
        if element.tag == "link":
            links[_name(element, text, links)] = element
        elif element.tag == "joint":
            joint = _joint(element, text, _name(element, text, joints))
            joints[joint.name] = joint
    _check_links(joints, links, robot, text)
    _check_leaders(joints)
    root = _root(links, joints, text)
    name = robot.attributes.get("name", "")
    return Urdf(name=name, root=root, links=tuple(links), joints=joints, text=text, tree=robot)


def _check_links(
    joints: Mapping[str, UrdfJoint], links: Collection[str], robot: Element, text: str
) -> None:
    """Raise XmlError unless the links of all joints exist. The first choice for another one is a
    link to which no joint leads."""
    children = {joint.child for joint in joints.values()}
    for element in robot.all("joint"):
        for end in (*element.all("parent"), *element.all("child")):
            link = end.attributes["link"]
            if link in links:
                continue
            message = f"joint `{element.attributes['name']}` names the link `{link}`, which does"
            free = [name for name in links if name not in children and end.tag == "child"]
            near = get_close_matches(link, free, n=1) or get_close_matches(link, links, n=1)
            help = f'add `<link name="{link}"/>` to the file, or correct the name'
            help = f"did you mean `{near[0]}`?" if near else help
            raise XmlError(f"{message} not exist", end.place(text, "link"), help)


def check_sdf(text: str) -> None:
    """Raise XmlError unless a text can be SDF, the format of Gazebo: nothing in it is read."""
    root = parse(text)
    if root.tag != "sdf":
        message = f"the outermost element is `<{root.tag}>`, not `<sdf>`"
        raise XmlError(message, root.place(text), "name an SDF file: its first tag is `<sdf ...>`")


def _name(element: Element, text: str, known: Mapping[str, object]) -> str:
    """The name of a link or a joint, which is not among those `known`."""
    name, tag = element.attributes.get("name", ""), element.tag
    if not name:
        help = f'write `<{tag} name="...">`'
        raise XmlError(f"this {tag} has no name", element.place(text), help)
    if name in known:
        help = "give one of the two another name, or remove one of them"
        raise XmlError(f"there are two {tag}s `{name}`", element.place(text, "name"), help)
    return name


def _joint(element: Element, text: str, name: str) -> UrdfJoint:
    kind = element.attributes.get("type", "")
    if kind not in KINDS:
        known = f"joint `{name}` has "
        known += f"the unknown type `{kind}`" if kind else "no type"
        help = guess(kind, KINDS) if kind else f"the types are {listed(KINDS)}"
        raise XmlError(known, element.place(text, "type" if kind else "name"), help)
    place = element.place(text, "name")
    parent, child = (
        end.attributes["link"] for tag in ("parent", "child") for end in element.all(tag)
    )
    for axis in element.all("axis") if kind in MOVED else ():
        if "xyz" in axis.attributes and math.hypot(*numbers(axis, text, "xyz", 3)) < 1e-6:
            message = f"the axis of joint `{name}` is zero: it has no direction"
            help = 'write an axis such as `xyz="0 0 1"`'
            raise XmlError(message, axis.place(text, "xyz"), help)
    limit = element.first("limit")
    if limit is None:
        if kind in ("revolute", "prismatic"):
            help = "add its limits"
            if kind == "revolute":
                help += ", or use the type `continuous` for a joint without limits"
            raise XmlError(f"the {kind} joint `{name}` has no `<limit>`", place, help)
        low, high, speed, effort = -math.inf, math.inf, math.inf, math.inf
    else:
        low, high = _limits(limit, text, name) if kind in MOVED else (0.0, 0.0)
        speed = abs(number(limit, text, "velocity", 0.0)) or math.inf
        effort = abs(number(limit, text, "effort", 0.0))
        if kind not in ("revolute", "prismatic"):
            low, high = -math.inf, math.inf
    return UrdfJoint(
        name=name,
        kind=kind,
        parent=parent,
        child=child,
        lower=low,
        upper=high,
        velocity=speed,
        effort=effort,
        mimic=_mimic(element, text),
        place=place,
    )


def _limits(limit: Element, text: str, joint: str) -> tuple[float, float]:
    low, high = number(limit, text, "lower", 0.0), number(limit, text, "upper", 0.0)
    if low > high:
        message = f"the lower limit {low} of joint `{joint}` is above its upper limit {high}"
        given = limit.attributes.get("upper", "0"), limit.attributes.get("lower", "0")
        help = f'write `lower="{given[0]}" upper="{given[1]}"`: are the two swapped?'
        raise XmlError(message, limit.place(text, "lower", whole=True), help)
    return low, high


def _mimic(joint: Element, text: str) -> Mimic | None:
    found = joint.first("mimic")
    if found is None:
        return None
    return Mimic(
        joint=found.attributes["joint"],
        multiplier=number(found, text, "multiplier", 1.0),
        offset=number(found, text, "offset", 0.0),
    )


def _check_leaders(joints: Mapping[str, UrdfJoint]) -> None:
    """Raise XmlError unless each joint that follows another leads to one that follows none."""
    led: set[str] = set()
    for joint in joints.values():
        seen, leader = {joint.name}, joint
        while leader.mimic is not None and leader.name not in led:
            other = leader.mimic.joint
            if other not in joints:
                message = f"joint `{leader.name}` follows the joint `{other}`, which does not exist"
                raise XmlError(message, leader.place, guess(other, joints))
            if other in seen:
                message = f"joint `{leader.name}` follows `{other}`, which follows it"
                raise XmlError(message, leader.place, "remove `<mimic>` from one of them")
            seen.add(other)
            leader = joints[other]
        led |= seen


def _root(links: Mapping[str, Element], joints: Mapping[str, UrdfJoint], text: str) -> str:
    """The only link that is the child of no joint, from which all links are reached."""
    above: dict[str, UrdfJoint] = {}
    for joint in joints.values():
        first = above.setdefault(joint.child, joint)
        if first is not joint:
            line = text.count("\n", 0, first.place[0]) + 1
            message = f"the link `{joint.child}` is the child of two joints, `{first.name}` (line"
            message += f" {line}) and `{joint.name}`"
            help = "a link has one parent: remove one of the joints, or name another child link"
            raise XmlError(message, joint.place, help)
    roots = [link for link in links if link not in above]
    if not links:
        raise XmlError("the robot has no link", (0, 0), 'write a `<link name="..."/>`')
    reached = _below(roots, joints)
    for link in links:
        if link not in reached:
            raise _circle(link, above)
    if len(roots) > 1:
        names = f"`{roots[0]}`, nor to `{roots[1]}`"
        message = f"the robot has {len(roots)} roots: no joint leads to {names}"
        help = f"add a joint whose child link is `{roots[1]}`, or remove that link"
        raise XmlError(message, links[roots[1]].place(text, "name"), help)
    return roots[0]


def _below(roots: list[str], joints: Mapping[str, UrdfJoint]) -> set[str]:
    """The links that joints lead to from the roots, and the roots."""
    children: dict[str, list[str]] = {}
    for joint in joints.values():
        children.setdefault(joint.parent, []).append(joint.child)
    todo, found = list(roots), set(roots)
    while todo:
        todo += (below := children.get(todo.pop(), []))
        found |= set(below)
    return found


def _circle(link: str, above: Mapping[str, UrdfJoint]) -> XmlError:
    """The mistake that the joints above a link lead to no root."""
    seen: dict[str, None] = {}
    while link not in seen:
        seen[link] = None
        link = above[link].parent
    circle = list(seen)[list(seen).index(link) :]
    names = listed(circle[::-1][:_MOST_LISTED]) + (", ..." if len(circle) > _MOST_LISTED else "")
    message = f"the links {names} are a circle of joints"
    help = "a robot is a tree of links: remove one of the joints of the circle"
    return XmlError(message, above[link].place, help)
