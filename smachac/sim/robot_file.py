"""The files of robots and bodies, and the URDF text that the physics engine gets for them.

PyBullet reads no URDF file of the user. It gets a text that is printed from the elements which
`robots.urdf` has read and checked, because PyBullet 3.2.7 reads some valid files otherwise than the
specification: `<limit>` of a continuous joint limits it, a missing `upper` is -1 and not 0, planar
joints break its solvers, a line is cut after 1,023 characters, and packages are not looked up.
"""

from __future__ import annotations

import math
import os
import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from xml.sax.saxutils import quoteattr

from smachac.robots.files import SEARCHED, find_mesh
from smachac.robots.urdf import Mimic, Urdf, UrdfJoint, numbers, read_tree
from smachac.robots.xml_tree import Element, XmlError, parse
from smachac.sim import transforms
from smachac.sim.physics import data_folder
from smachac.sim.transforms import Pose, Vector

MAX_LINKS = 128
"""The most links of one body in PyBullet 3.2.7; the states of more joints cannot be read."""
_MESHES = (".obj", ".stl", ".dae")
"""The endings of mesh files that PyBullet reads, in small letters."""
_LONGEST_LINE = 1000
"""PyBullet cuts a line after 1,023 characters."""


class LoadError(RuntimeError):
    """A file that cannot be loaded; the message names the file, the line where it is known, and the
    reason."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotFile:
    """A URDF file that was read: its elements, and the facts in them."""

    path: Path
    root: Element = field(repr=False)
    text: str = field(repr=False)
    urdf: Urdf = field(repr=False)

    def frames(self) -> dict[str, tuple[Pose, Vector]]:
        """The frame of each joint in that of its parent link, and its axis (unit vector)."""
        return {
            joint.attributes["name"]: (self._origin(joint), self._axis(joint))
            for joint in self.root.all("joint")
        }

    def _origin(self, joint: Element) -> Pose:
        origin = joint.first("origin")
        if origin is None:
            return transforms.IDENTITY
        x, y, z = self._row(origin, "xyz", (0.0, 0.0, 0.0))
        if "quat_xyzw" in origin.attributes:
            return transforms.as_pose([[x, y, z], numbers(origin, self.text, "quat_xyzw", 4)])
        return (x, y, z), transforms.from_rpy(*self._row(origin, "rpy", (0.0, 0.0, 0.0)))

    def _axis(self, joint: Element) -> Vector:
        axis = joint.first("axis")
        x, y, z = self._row(axis, "xyz", (1.0, 0.0, 0.0)) if axis is not None else (1.0, 0.0, 0.0)
        length = math.hypot(x, y, z) or 1.0
        return x / length, y / length, z / length

    def _row(self, element: Element, attribute: str, default: Vector) -> Vector:
        if attribute not in element.attributes:
            return default
        x, y, z = numbers(element, self.text, attribute, 3)
        return x, y, z

    def leader(self, name: str) -> Mimic:
        """The joint that a joint follows (`<mimic>`), over all joints between the two; itself for
        one that follows none. Raises LoadError where there is no such joint."""
        joints, found = self.urdf.joints, Mimic(joint=name)
        seen: set[str] = set()
        while (mimic := joints[found.joint].mimic) is not None:
            seen.add(found.joint)
            if mimic.joint not in joints or mimic.joint in seen:
                message = f"the joint `{name}` follows `{mimic.joint}`, "
                message += "which follows it" if mimic.joint in seen else "which does not exist"
                line = self.text.count("\n", 0, joints[name].place[0]) + 1
                raise self.error(line, message)
            found = Mimic(
                joint=mimic.joint,
                multiplier=found.multiplier * mimic.multiplier,
                offset=found.multiplier * mimic.offset + found.offset,
            )
        return found

    def error(self, line: int, message: str) -> LoadError:
        """The error for a line of the file."""
        return LoadError(f"the file `{self.path}`, line {line}: {message}")


@dataclass(frozen=True, slots=True, kw_only=True)
class EngineFile:
    """A file for PyBullet: the printed `text` of a URDF file, or `path` itself without a text.

    `lines` are the lines of `path` to which the lines of the text belong. `meshes` are the files
    that the text names.
    """

    path: Path
    text: str | None = field(default=None, repr=False)
    lines: tuple[int, ...] = field(default=(), repr=False)
    meshes: tuple[Path, ...] = ()

    @property
    def is_shipped(self) -> bool:
        """Whether the file is part of PyBullet's data or of smachac."""
        known = (data_folder(), Path(__file__).parents[1] / "robots")
        return any(self.path.resolve().is_relative_to(folder.resolve()) for folder in known)


def read_robot_file(path: Path) -> RobotFile:
    """The robot in a URDF file. Raises LoadError and OSError."""
    text = path.read_bytes().decode("utf-8", "replace")
    try:
        root = parse(text)
        return RobotFile(path=path, root=root, text=text, urdf=read_tree(root, text))
    except XmlError as error:
        line = text.count("\n", 0, error.place[0]) + 1
        message = f"the file `{path}`, line {line}: {error.message}; {error.help}"
        raise LoadError(message) from None


def engine_file(robot: RobotFile, used: Collection[str] = ()) -> EngineFile:
    """The file for PyBullet. `used` are the names of links that must be in it.

    Joints of the types planar and floating are fixed. Raises LoadError for a mesh that is not
    found or has an unknown format, and for a robot with too many links.
    """
    printer = _Printer(robot, _left_out(robot, used))
    printer.print(robot.root, 0)
    return EngineFile(
        path=robot.path,
        text="\n".join(printer.text) + "\n",
        lines=tuple(printer.lines),
        meshes=tuple(dict.fromkeys(printer.meshes)),
    )


def _left_out(robot: RobotFile, used: Collection[str]) -> set[str]:
    """The links that are not printed: none, or in a robot with too many links the outermost ones
    that are fixed, have no content, and are not used."""
    links = {link.attributes["name"]: link for link in robot.root.all("link")}
    if len(links) <= MAX_LINKS:
        return set()
    parents = {joint.parent for joint in robot.urdf.joints.values()}
    empty = {
        joint.child
        for joint in robot.urdf.joints.values()
        if joint.kind == "fixed"
        and joint.child not in parents
        and joint.child not in used
        and not links[joint.child].children
    }
    if len(links) - len(empty) > MAX_LINKS:
        line = robot.root.line
        message = f"the robot has {len(links)} links, more than the {MAX_LINKS} that PyBullet loads"
        raise robot.error(line, f"{message}; remove links without joints that move")
    return empty


class _Printer:
    """Prints the elements that PyBullet reads, each on lines of its own."""

    def __init__(self, robot: RobotFile, left_out: Collection[str]) -> None:
        self.robot, self.left_out = robot, left_out
        self.text: list[str] = []
        self.lines: list[int] = []
        self.meshes: list[Path] = []

    def print(self, element: Element, depth: int) -> None:
        attributes = self._attributes(element)
        if element.tag == "joint" and depth == 1:
            joint = self.robot.urdf.joints[element.attributes["name"]]
            children = list(self._joint_parts(element, joint))
        else:
            children = [child for child in element.children if self._is_read(child, depth)]
        words = [f"<{element.tag}", *(f"{key}={quoteattr(attributes[key])}" for key in attributes)]
        end = "/>" if not children else ">"
        fits = sum(map(len, words)) < _LONGEST_LINE
        self._add(element, [" ".join(words) + end] if fits else [*words, end])
        for child in children:
            self.print(child, depth + 1)
        if children:
            self._add(element, [f"</{element.tag}>"])

    def _add(self, element: Element, lines: list[str]) -> None:
        self.text += lines
        self.lines += [element.line] * len(lines)

    def _is_read(self, element: Element, depth: int) -> bool:
        """Whether the element is printed."""
        if depth > 0:
            return True
        if element.tag == "link":
            return element.attributes["name"] not in self.left_out
        if element.tag == "joint":
            joint = self.robot.urdf.joints[element.attributes["name"]]
            return joint.child not in self.left_out
        return element.tag == "material"

    def _attributes(self, element: Element) -> dict[str, str]:
        match element.tag:
            case "robot":
                return {"name": element.attributes.get("name") or "robot"}
            case "mesh":
                return {**element.attributes, "filename": self._mesh(element)}
            case "origin" if "quat_xyzw" in element.attributes:
                quaternion = numbers(element, self.robot.text, "quat_xyzw", 4)
                angles = transforms.rpy(transforms.as_pose([[0, 0, 0], quaternion])[1])
                rest = {key: element.attributes[key] for key in ("xyz",) if key in element.attributes}
                return {**rest, "rpy": " ".join(map(repr, angles))}
            case "texture":
                found = find_mesh(element.attributes.get("filename", ""), self.robot.path)
                return {"filename": os.path.abspath(found)} if found is not None else {}
        return element.attributes

    def _joint_parts(self, element: Element, joint: UrdfJoint) -> Iterator[Element]:
        """The parts of a joint, with its limits as they are meant."""
        for child in element.children:
            if child.tag in ("origin", "axis", "parent", "child", "dynamics"):
                yield child
            elif child.tag == "limit" and joint.is_moved:
                limits = {
                    key: value
                    for key, value in child.attributes.items()
                    if key in ("effort", "velocity")
                }
                if joint.is_limited:
                    limits |= {"lower": repr(joint.lower), "upper": repr(joint.upper)}
                yield Element("limit", limits, child.start, child.line)

    def _mesh(self, element: Element) -> str:
        """The absolute path of a mesh file. Raises LoadError."""
        name = element.attributes.get("filename", "")
        found = find_mesh(name, self.robot.path)
        if found is None:
            message = f"the mesh file `{name}` was not found; {SEARCHED}"
            raise self.robot.error(element.line, message)
        if found.suffix.lower() not in _MESHES:
            message = f"PyBullet cannot read the mesh file `{name}`; it reads {', '.join(_MESHES)}"
            raise self.robot.error(element.line, message)
        self.meshes.append(found)
        return os.path.abspath(found)


def explained(file: EngineFile, output: str, name: str) -> LoadError:
    """The error for a file that PyBullet does not load, made of the `output` of PyBullet, in which
    the file has the name `name`."""
    words = [_plain(file, line, name) for line in output.splitlines()]
    reasons = [word for word in dict.fromkeys(words) if word]
    reason = "; ".join(reasons[-3:]) or "PyBullet prints no reason"
    return LoadError(f"the file `{file.path}` cannot be loaded: {reason}")


_SOURCE = re.compile(r"^b3\w+\[[^\]]*\]:?")
"""The place in the source code of PyBullet at the start of its messages."""
_NOISE = ("No inertial data for link", "No axis element for Joint", "pybullet build time")


def _plain(file: EngineFile, line: str, name: str) -> str:
    """A line that PyBullet printed, with the names and lines of the user's file."""
    line = _SOURCE.sub("", line).strip()
    if any(noise in line for noise in _NOISE):
        return ""

    def source_line(found: re.Match[str]) -> str:
        number = int(found[2])
        return found[1] + str(file.lines[number - 1] if 0 < number <= len(file.lines) else number)

    line = re.sub(rf"({re.escape(name)}:|Line number=)(\d+)", source_line, line)
    return line.replace(name, str(file.path))
