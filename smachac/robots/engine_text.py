"""The URDF text that the physics engine gets for a robot.

The engine reads no URDF file of the user. It gets a text that is printed from the elements which
`robots.urdf` has read and checked, because PyBullet 3.2.7 reads some valid files otherwise than the
specification: `<limit>` of a continuous joint limits it, a missing `upper` is -1 and not 0,
`quat_xyzw` has no effect, planar joints break its solvers, a line is cut after 1,023 characters,
a link without `<inertial>` has 1 kg and not 0, and packages are not looked up. The checker prints
the text too: what it accepts can be loaded.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass
from html import escape
from pathlib import Path

from smachac.robots.files import SEARCHED
from smachac.robots.urdf import Urdf, UrdfJoint
from smachac.robots.urdf_format import HARMLESS, ROBOT, Tag, number, numbers
from smachac.robots.xml_tree import Element, XmlError

MAX_LINKS = 128
"""The most links of one body in PyBullet 3.2.7; the states of more joints cannot be read."""
MESHES = (".obj", ".stl", ".dae")
"""The endings of mesh files that PyBullet reads, in small letters."""
_LONGEST_LINE = 1000
"""In characters: PyBullet cuts a line after 1,023."""
_NOT_PRINTED = {*HARMLESS, "mimic", "calibration", "safety_controller", "axis", "limit", "verbose"}
"""Elements that the engine does not use. `<axis>` and `<limit>` are printed from what was read."""


@dataclass(frozen=True, slots=True, kw_only=True)
class EngineText:
    """A printed URDF text: the `lines` of the file to which its lines belong, and the mesh and
    texture files that it names."""

    text: str
    lines: tuple[int, ...]
    meshes: tuple[Path, ...]


def engine_text(
    robot: Urdf, find: Callable[[str], Path | None], used: Collection[str] = ()
) -> EngineText:
    """The text of a robot for the engine. Raises XmlError for a mesh that is not found or has an
    unknown format, and for a robot with too many links.

    `find` returns the file of a mesh by the name in the URDF file. `used` are the names of links
    that must be in the text. Joints of the types planar and floating are fixed at their origin.
    """
    printer = _Printer(robot, find, _left_out(robot, used))
    printer.print(robot.tree, ROBOT)
    meshes = tuple(dict.fromkeys(printer.meshes))
    return EngineText(
        text="\n".join(printer.text) + "\n", lines=tuple(printer.lines), meshes=meshes
    )


def _left_out(robot: Urdf, used: Collection[str]) -> set[str]:
    """The links that are not printed: none, or in a robot with too many links the outermost ones
    that are fixed, have no content, and are not used."""
    if len(robot.links) <= MAX_LINKS:
        return set()
    full = {link.attributes["name"] for link in robot.tree.all("link") if link.children}
    kept = full | {joint.parent for joint in robot.joints.values()} | set(used)
    fixed = {joint.child for joint in robot.joints.values() if joint.kind == "fixed"}
    count = len(robot.links) - len(fixed - kept)
    if count > MAX_LINKS:
        message = f"the robot has {count} links, more than the {MAX_LINKS} of the simulation"
        help = "remove links that move with another link, such as frames of sensors"
        raise XmlError(message, robot.tree.place(robot.text), help)
    return fixed - kept


class _Printer:
    """Prints the elements of a robot that the engine reads, each on lines of its own."""

    def __init__(
        self, robot: Urdf, find: Callable[[str], Path | None], left_out: Collection[str]
    ) -> None:
        self.robot, self.find, self.left_out = robot, find, left_out
        self.fixed = {joint.child for joint in robot.joints.values() if not joint.is_moved}
        self.text: list[str] = []
        self.lines: list[int] = []
        self.meshes: list[Path] = []

    def print(self, element: Element, tag: Tag) -> None:
        given = self._attributes(element, tag)
        words = [f"<{element.tag}", *(f'{key}="{escape(value)}"' for key, value in given.items())]
        children = [*self._children(element, tag)]
        end = ">" if children else "/>"
        fits = sum(map(len, words)) + len(words) < _LONGEST_LINE
        self._add(element, [" ".join(words) + end] if fits else [*words, end])
        for child in children:
            self.print(child, tag.children[child.tag])
        if children:
            self._add(element, [f"</{element.tag}>"])

    def _add(self, element: Element, lines: list[str]) -> None:
        self.text += lines
        self.lines += [element.line] * len(lines)

    def _attributes(self, element: Element, tag: Tag) -> dict[str, str]:
        text = self.robot.text
        given = {
            key: element.attributes[key] for key in tag.attributes if key in element.attributes
        }
        match element.tag:
            case "robot":
                return {"name": element.attributes.get("name") or "robot"}
            case "joint":
                joint = self.robot.joints[element.attributes["name"]]
                return {**given, "type": joint.kind if joint.is_moved else "fixed"}
            case "origin" if "quat_xyzw" in given:
                rotation = numbers(element, text, "quat_xyzw", 4)
                del given["quat_xyzw"]
                return {**given, "rpy": _row(roll_pitch_yaw(rotation))}
            case "axis" | "limit":
                return element.attributes  # printed from what was read
            case "inertia" | "dynamics":
                return {key: _row([number(element, text, key, 0.0)]) for key in tag.attributes}
            case "mesh":
                return {**given, "filename": str(self._mesh(element))}
            case "texture":
                found = self.find(given.get("filename", ""))
                return {"filename": str(found)} if found is not None else {}
        return given

    def _children(self, element: Element, tag: Tag) -> Iterator[Element]:
        seen: set[str] = set()
        for child in element.children:
            if child.tag not in tag.children or child.tag in _NOT_PRINTED:
                continue
            if child.tag in seen and child.tag not in tag.several:
                continue
            seen.add(child.tag)
            if not self._is_left_out(child):
                yield child
        if element.tag == "link" and "inertial" not in seen:
            yield from self._no_mass(element)
        if element.tag == "joint":
            joint = self.robot.joints[element.attributes["name"]]
            yield from _axis_and_limit(element, joint, self.robot.text)

    def _no_mass(self, link: Element) -> Iterator[Element]:
        """The mass of a link without `<inertial>`: 0, as in the specification. A link that a joint
        moves has to have one for the engine, which sets 1 kg."""
        if link.attributes["name"] in self.fixed:
            place = link.start, link.line
            parts = [Element("mass", {"value": "0"}, *place), Element("inertia", {}, *place)]
            yield Element("inertial", {}, *place, children=parts)

    def _is_left_out(self, element: Element) -> bool:
        name = element.attributes.get("name", "")
        if element.tag == "joint":
            name = self.robot.joints[name].child
        return element.tag in ("link", "joint") and name in self.left_out

    def _mesh(self, element: Element) -> Path:
        """The file of a mesh. Raises XmlError."""
        name, place = element.attributes["filename"], element.place(self.robot.text, "filename")
        found = self.find(name)
        if found is None:
            raise XmlError(f"the mesh file `{name}` was not found", place, SEARCHED)
        if found.suffix.lower() not in MESHES:
            message = f"the simulation does not read mesh files such as `{name}`"
            raise XmlError(message, place, f"convert it to one of {', '.join(MESHES)}")
        self.meshes.append(found)
        return found


def _axis_and_limit(element: Element, joint: UrdfJoint, text: str) -> Iterator[Element]:
    """The axis of a joint, with the length 1, and its limits, as they were read."""
    if not joint.is_moved:
        return
    axis = element.first("axis")
    given = axis is not None and "xyz" in axis.attributes
    vector = numbers(axis, text, "xyz", 3) if axis is not None and given else (1.0, 0.0, 0.0)
    length = math.hypot(*vector)
    xyz = {"xyz": _row(part / length for part in vector)}
    yield Element("axis", xyz, element.start, (axis or element).line)
    found = element.first("limit")
    if found is None:
        return
    limits = {"effort": repr(joint.effort)}
    if math.isfinite(joint.velocity):
        limits["velocity"] = repr(joint.velocity)
    if joint.is_limited:
        limits |= {"lower": repr(joint.lower), "upper": repr(joint.upper)}
    yield Element("limit", limits, found.start, found.line)


def _row(values: Iterator[float] | tuple[float, ...] | list[float]) -> str:
    return " ".join(map(repr, values))


def roll_pitch_yaw(quaternion: tuple[float, ...]) -> tuple[float, float, float]:
    """The angles (rad) about the fixed axes x, y and z, in this order, of a rotation (x, y, z, w),
    which need not have the length 1."""
    length = math.hypot(*quaternion)
    x, y, z, w = (part / length for part in quaternion)
    sine = 2.0 * (w * y - z * x)
    if abs(sine) > 1.0 - 1e-9:  # straight up or down: only the sum of roll and yaw is known
        return 0.0, math.copysign(math.pi / 2.0, sine), math.copysign(2.0, -sine) * math.atan2(x, w)
    roll = math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
    yaw = math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
    return roll, math.asin(sine), yaw
