"""Writes the definitions of common packages of ROS that are part of smachac.

    python scripts/ros_messages.py 1=/usr/share 2=/opt/share 2=rosbags:ROS2_HUMBLE

writes smachac/frontend/messages/PACKAGE.txt. A source is a version of ROS and a folder of packages
(`std_msgs/msg/Bool.msg`), `rosbags:STORE` for the messages of a version of ROS 2 in the package
rosbags, which has to be installed, or `genpy:FOLDER` for classes that ROS 1 made of definitions.

The files were made of (ROS 1) Debian's packages ros-std-msgs 0.5.13, ros-std-srvs 1.11.3,
ros-actionlib-msgs, ros-diagnostic-msgs, ros-geometry-msgs, ros-nav-msgs, ros-sensor-msgs,
ros-shape-msgs, ros-stereo-msgs, ros-trajectory-msgs, ros-visualization-msgs 1.13.1,
ros-tf2-msgs 0.7.6, ros-map-msgs and ros-move-base-msgs 1.14.1 (BSD-3-Clause), control_msgs as in
py3rosmsgs 1.18.2 of PyPI (BSD-3-Clause); (ROS 2) the wheels ros-std-msgs, ros-std-srvs, ... 5.5.1,
ros-action-msgs and ros-lifecycle-msgs 2.3.0 of PyPI, and the stores ROS2_FOXY, ROS2_HUMBLE,
ROS2_IRON, ROS2_JAZZY, ROS2_KILTED and ROS2_LYRICAL of rosbags 0.11.9 (Apache-2.0).
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TypeAlias

ROOM = Path(__file__).parents[1] / "smachac" / "frontend" / "messages"

PACKAGES = (
    "action_msgs", "actionlib_msgs", "builtin_interfaces", "control_msgs", "diagnostic_msgs",
    "geometry_msgs", "lifecycle_msgs", "map_msgs", "move_base_msgs", "nav_msgs",
    "sensor_msgs", "shape_msgs", "std_msgs", "std_srvs", "stereo_msgs", "tf2_msgs",
    "trajectory_msgs",
    "unique_identifier_msgs", "visualization_msgs",
)  # fmt: skip

SAME_IN_ROS_2 = ("control_msgs/action/GripperCommand", "control_msgs/msg/GripperCommand")
"""Types whose source is of ROS 1 only, and that have the same fields in ROS 2."""

LISTED = {"control_msgs": "1", "map_msgs": "1"}
"""The versions of ROS whose types are all known; of other packages all are."""

Fields: TypeAlias = "tuple[tuple[str, ...], ...]"
"""The lines of the fields of a definition, by its parts."""

PARTS = ("Goal", "Result", "Feedback")


def main() -> None:
    found: dict[str, dict[Fields, dict[str, dict[str, str]]]] = {}
    for word in sys.argv[1:]:
        version, _, place = word.partition("=")
        for path, text in definitions(place):
            package = path.partition("/")[0]
            if package in PACKAGES:
                constants, fields = read(text, package)
                held = found.setdefault(path, {}).setdefault(fields, {}).setdefault(version, {})
                held.update(constants)
    for package in PACKAGES:
        parts = [f"complete {LISTED.get(package, '1 2')}\n"]
        for path in sorted(path for path in found if path.startswith(f"{package}/")):
            for fields, versions in sorted(found[path].items()):
                mark = "" if len(versions) == 2 or path in SAME_IN_ROS_2 else f" {min(versions)}"
                known = {key: value for item in versions.values() for key, value in item.items()}
                parts.append(f"== {path.partition('/')[2]}{mark}\n{written(known, fields)}")
        (ROOM / f"{package}.txt").write_text("".join(parts), encoding="utf-8")


def written(constants: dict[str, str], fields: Fields) -> str:
    """The text of a definition. A constant is known by its part: `0 uint8 LOW`."""
    parts = []
    for number, part in enumerate(fields):
        own = [constant for constant in constants if constant.startswith(f"{number} ")]
        lines = [f"{item.partition(' ')[2]}={constants[item]}" for item in own]
        parts.append("".join(f"{line}\n" for line in (*lines, *part)))
    return "---\n".join(parts)


def definitions(place: str) -> Iterator[tuple[str, str]]:
    """The paths of definitions, `std_msgs/msg/Bool`, and their texts."""
    kind, _, rest = place.partition(":")
    if kind == "rosbags":
        yield from of_store(rest)
    elif kind == "genpy":
        yield from of_classes(Path(rest))
    else:
        for file in sorted(Path(place).glob("*/*/*.*")):
            if file.suffix in (".msg", ".srv", ".action") and file.parent.name == file.suffix[1:]:
                name = f"{file.parent.parent.name}/{file.parent.name}/{file.stem}"
                yield name, file.read_text(encoding="utf-8")


def of_store(name: str) -> Iterator[tuple[str, str]]:
    """The messages of a version of ROS 2."""
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores[name])
    for path in store.fielddefs:
        text, _ = store.generate_msgdef(path, ros_version=2)
        yield path, text.partition("=" * 80)[0]


def of_classes(folder: Path) -> Iterator[tuple[str, str]]:
    """The definitions of the classes in `package/msg/_Name.py`; actions are made of their parts."""
    texts: dict[str, str] = {}
    for file in sorted(folder.glob("*_msgs/*/_[A-Z]*.py")):
        path = f"{file.parent.parent.name}/{file.parent.name}/{file.stem[1:]}"
        held = [
            node.value.value
            for node in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
            if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant)
            and ast.unparse(node.targets[0]) == "_full_text"
        ]  # fmt: skip
        cut = [str(item).partition("=" * 80)[0] for item in held]
        texts[path] = "---\n".join(item if item.endswith("\n") else f"{item}\n" for item in cut)
    for path, text in texts.items():
        whole = re.fullmatch(r"(.*)/msg/(\w+)Action", path)
        of_action = re.fullmatch(r"(.*?)(Action)?(Goal|Result|Feedback|Action)", path)
        if whole is not None:
            parts = [texts[f"{whole[1]}/msg/{whole[2]}{part}"] for part in PARTS]
            yield f"{whole[1]}/action/{whole[2]}", "---\n".join(parts)
        elif of_action is None or f"{of_action[1]}Action" not in texts:
            yield path, text


def read(text: str, package: str) -> tuple[dict[str, str], Fields]:
    """The constants and the fields of a definition, without comments and default values."""
    parts: list[list[str]] = [[]]
    constants: dict[str, str] = {}
    for line in text.splitlines():
        is_text = re.match(r"\s*w?string\s+\w+\s*=", line)
        bare = (line if is_text else line.partition("#")[0]).strip()
        constant = re.fullmatch(r"(\S+)\s+(\w+)\s*=\s*(.*)", bare)
        field = re.match(r"(\S+)\s+(\w+)", bare)
        if bare.startswith("---"):
            parts.append([])
        elif constant is not None:
            constants[f"{len(parts) - 1} {constant[1]} {constant[2]}"] = constant[3].strip()
        elif field is not None:
            parts[-1].append(f"{plain_type(field[1], package)} {field[2]}")
    return constants, tuple(tuple(part) for part in parts)


def plain_type(word: str, package: str) -> str:
    """A type as both versions of ROS can write it, without the name of its own package."""
    word = re.sub(r"^Header$", "std_msgs/Header", word).replace("/msg/", "/")
    word = re.sub(r"^octet\b", "byte", word)
    return word.removeprefix(f"{package}/")


if __name__ == "__main__":
    main()
