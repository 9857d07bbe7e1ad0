"""The files of robots and bodies for the physics engine, and the reasons why it cannot load one."""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from smachac.robots.encodings import EncodingError, decoded
from smachac.robots.engine_text import engine_text
from smachac.robots.files import Packages, find_mesh
from smachac.robots.urdf import Urdf, read
from smachac.robots.urdf_format import numbers
from smachac.robots.xacro_files import SUFFIX as XACRO_SUFFIX
from smachac.robots.xacro_files import XacroError, expand
from smachac.robots.xml_tree import MAX_CHARACTERS, TOO_LARGE, Element, XmlError
from smachac.sim import transforms
from smachac.sim.physics import data_folder
from smachac.sim.transforms import Pose, Vector


class LoadError(RuntimeError):
    """A file that cannot be loaded; the message names the file, the line where it is known, and the
    reason."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotFile:
    """A URDF or xacro file that was read; `packages` are folders of ROS packages by name."""

    path: Path
    urdf: Urdf = field(repr=False)
    packages: Packages = field(default_factory=dict, repr=False)

    def frames(self) -> dict[str, tuple[Pose, Vector]]:
        """The frame of each joint in that of its parent link, and its axis (unit vector)."""
        return {
            joint.attributes["name"]: (self._origin(joint), self._axis(joint))
            for joint in self.urdf.tree.all("joint")
        }

    def _origin(self, joint: Element) -> Pose:
        origin = joint.first("origin")
        if origin is None:
            return transforms.IDENTITY
        place = self._row(origin, "xyz", (0.0, 0.0, 0.0))
        if "quat_xyzw" in origin.attributes:
            rotation = numbers(origin, self.urdf.text, "quat_xyzw", 4)
            return transforms.as_pose([place, rotation])
        return place, transforms.from_rpy(*self._row(origin, "rpy", (0.0, 0.0, 0.0)))

    def _axis(self, joint: Element) -> Vector:
        axis = joint.first("axis")
        x, y, z = self._row(axis, "xyz", (1.0, 0.0, 0.0)) if axis is not None else (1.0, 0.0, 0.0)
        length = math.hypot(x, y, z) or 1.0
        return x / length, y / length, z / length

    def _row(self, element: Element, attribute: str, default: Vector) -> Vector:
        if attribute not in element.attributes:
            return default
        x, y, z = numbers(element, self.urdf.text, attribute, 3)
        return x, y, z


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


def read_robot_file(
    path: Path, arguments: Mapping[str, str] | None = None, packages: Packages | None = None
) -> RobotFile:
    """The robot in a URDF or xacro file; `arguments` are those of the macros. Raises LoadError and
    OSError."""
    if path.stat().st_size > 4 * MAX_CHARACTERS:
        raise LoadError(f"the file `{path}` is too large for a robot: {TOO_LARGE}")
    try:
        text = decoded(path.read_bytes(), path.name)
    except UnicodeDecodeError as error:
        reason = f"not {error.encoding.upper()}: {error.reason}"
        raise LoadError(f"the file `{path}` is {reason}") from None
    except EncodingError as error:
        raise LoadError(f"the file `{path}` cannot be read: {error}") from None
    packages = packages or {}
    try:
        if path.name.lower().endswith(XACRO_SUFFIX):
            text = expand(path, arguments or {}, packages).text
        return RobotFile(path=path, urdf=read(text), packages=packages)
    except XmlError as error:
        raise _wrong(path, text, error) from None


def engine_file(robot: RobotFile, used: Collection[str] = ()) -> EngineFile:
    """The file for PyBullet. `used` are the names of links that must be in it. Raises LoadError."""

    def mesh(name: str) -> Path | None:
        return find_mesh(name, robot.path, robot.packages)

    try:
        printed = engine_text(robot.urdf, mesh, used)
    except XmlError as error:
        raise _wrong(robot.path, robot.urdf.text, error) from None
    return EngineFile(
        path=robot.path, text=printed.text, lines=printed.lines, meshes=printed.meshes
    )


def _wrong(path: Path, text: str, error: XmlError) -> LoadError:
    if isinstance(error, XacroError):
        path, text = error.file, error.text
    line = text.count("\n", 0, error.place[0]) + 1
    return LoadError(f"the file `{path}`, line {line}: {error.message}; {error.help}")


def explained(file: EngineFile, output: str, name: str, ended: str = "") -> LoadError:
    """The error for a file that PyBullet does not load.

    `output` is what PyBullet printed; the file has the name `name` in it. `ended` is how its
    process ended.
    """
    words = [_plain(file, line, name) for line in output.splitlines()]
    reasons = [word for word in dict.fromkeys(words) if word][-3:]
    if ended:
        reasons.append(f"PyBullet {ended}")
    reason = "; ".join(reasons) or "PyBullet prints no reason"
    return LoadError(f"the file `{file.path}` cannot be loaded: {reason}")


_SOURCE = re.compile(r"b3\w+\[[^\]]*\]:?")
"""The place in the source code of PyBullet before its messages."""
_NOISE = ("No inertial data for link", "pybullet build time", "InMemoryFile")
"""Parts of lines that PyBullet prints for files that are right."""


def _plain(file: EngineFile, line: str, name: str) -> str:
    """A line that PyBullet printed, with the names and lines of the user's file."""
    line = _SOURCE.sub("", line).strip()
    # A warning about a link ends with its name on a line of its own.
    if " " not in line or any(noise in line for noise in _NOISE):
        return ""

    def source_line(found: re.Match[str]) -> str:
        number = int(found[2])
        return found[1] + str(file.lines[number - 1] if 0 < number <= len(file.lines) else number)

    line = re.sub(rf"({re.escape(name)}:|Line number=)(\d+)", source_line, line)
    return line.replace(name, str(file.path))
