"""Names of ROS and Gazebo that scripts for Baxter use, for programs without ROS.

`Pose`, `Point` and `Quaternion` have the fields of geometry_msgs. `rospkg.RosPack().get_path` gives
the path of a package as a `package://` text, which `model_of` reads: no package is installed.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

MODELS = {"cafe_table": "cafe_table", "block": "corner_block"}
"""The folder of a Gazebo model -> the built-in model that replaces it."""


@dataclass
class Point:
    """geometry_msgs/Point (m)."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0


@dataclass
class Quaternion:
    """geometry_msgs/Quaternion; all zeros are read as no rotation."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    w: float = 0.0


@dataclass
class Pose:
    """geometry_msgs/Pose."""

    position: Point = field(default_factory=Point)
    orientation: Quaternion = field(default_factory=Quaternion)


class RosPack:
    """The part of rospkg.RosPack that scripts use."""

    def get_path(self, name: str) -> str:
        """The path of a package."""
        return f"package://{name}"


class rospkg:  # noqa: N801
    """The part of the module rospkg that scripts use."""

    RosPack = RosPack


def model_of(path: str) -> tuple[str, str | None]:
    """The built-in model for the file of a Gazebo model, else the file: (model, path).

    A file that exists is loaded itself. A model's file is `.../models/NAME/model.sdf`.
    """
    if Path(path).is_file():
        return "", path
    return MODELS.get(PurePosixPath(path).parent.name, ""), None
