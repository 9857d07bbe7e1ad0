"""Descriptions in files: those that are built in, and the data of a YAML text."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from smachac.robots.description import Description, Station, read
from smachac.robots.fields import DataError

BUILT_IN = ("panda", "baxter", "iiwa")
"""The names of the robots that are built in."""
SUFFIXES = (".yml", ".yaml")
"""The endings of descriptions; any other text is the name of a robot."""
FOLDER = Path(__file__).parent
"""The folder of the built-in descriptions and their URDF files."""


def plain(text: str) -> Any:
    """The data of a YAML text. Raises DataError."""
    from ruamel.yaml import YAML
    from ruamel.yaml.error import YAMLError

    try:
        return YAML(typ="safe").load(text)
    except YAMLError as error:
        help = "correct the file; `smachac check FILE` shows the place"
        raise DataError(f"not YAML: {str(error).splitlines()[0]}", (), help) from None


def read_file(path: Path) -> Any:
    """The data of a YAML file. Raises DataError and OSError."""
    try:
        return plain(path.read_bytes().decode("utf-8"))
    except UnicodeDecodeError as error:
        raise DataError(f"not UTF-8: {error.reason}", (), "save the file as UTF-8") from None


def find_file(name: str | Path, folders: Iterable[Path] = ()) -> Path:
    """The file of that name in the working folder or in `folders`. Raises FileNotFoundError."""
    for folder in (Path(), *folders):
        path = folder / name
        if path.is_file():
            return path
    raise FileNotFoundError(f"the file `{name}` was not found")


def built_in(name: str) -> Description | Station:
    """The built-in robot of that name. Raises KeyError for another name."""
    if name not in BUILT_IN:
        raise KeyError(name)
    return read(read_file(FOLDER / f"{name}.yml"))


_PACKAGE = re.compile(r"(?:package|model)://([^/]+)/?(.*)")
_PACKAGE_NAME = re.compile(r"<name>\s*([^<\s]+)\s*</name>")


SEARCHED = (
    "a path is searched in the folder of the URDF file and the folders above it; a package is a"
    " folder of its name in one of them, in ROS_PACKAGE_PATH, or in `share` of AMENT_PREFIX_PATH"
)
"""Where `find_mesh` searches."""


def find_mesh(name: str, urdf: Path) -> Path | None:
    """The mesh or texture file that a URDF file names; None if there is none.

    `name` is a path relative to the folder of the URDF file or to a folder above it, an absolute
    path, `file://PATH`, or `package://PACKAGE/PATH`. A package is a folder PACKAGE in a folder
    above the URDF file, a folder above it with a `package.xml` of that name, a folder in
    ROS_PACKAGE_PATH, or `share/PACKAGE` in a folder of AMENT_PREFIX_PATH.
    """
    above = urdf.absolute().parents
    found = _PACKAGE.fullmatch(name)
    path = found[2] if found is not None else name.removeprefix("file://")
    for folder in above if found is None else _package_folders(found[1], above):
        if path and (folder / path).is_file():
            return folder / path
    return None


def _package_folders(package: str, above: Iterable[Path]) -> Iterator[Path]:
    for folder in above:
        yield folder / package
        if _package_name(folder) == package:
            yield folder
    for entry in filter(None, os.environ.get("ROS_PACKAGE_PATH", "").split(os.pathsep)):
        yield Path(entry) if Path(entry).name == package else Path(entry) / package
    for entry in filter(None, os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)):
        yield Path(entry) / "share" / package


def _package_name(folder: Path) -> str:
    """The name of the ROS package in a folder; empty if there is none."""
    try:
        text = (folder / "package.xml").read_text("utf-8", "replace")
    except OSError:
        return ""
    found = _PACKAGE_NAME.search(text)
    return found[1] if found is not None else ""
