"""Descriptions in files: those that are built in, and the data of a YAML text."""

from __future__ import annotations

import contextlib
import glob
import os
import re
import sys
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, TypeAlias

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

PACKAGES_SEARCHED = (
    "name its folder in `packages` of the description; else a package is a folder of its name in a"
    " folder above the file, in ROS_PACKAGE_PATH, or in `share` of AMENT_PREFIX_PATH"
)
"""Where `package_folders` searches."""
SEARCHED = "a path is relative to the folder of the URDF file or to one above it; for a package, "
SEARCHED += PACKAGES_SEARCHED
"""Where `find_mesh` searches."""

Packages: TypeAlias = Mapping[str, Path]
"""The folders of packages by name, as a description of a robot gives them."""


def find_mesh(name: str, urdf: Path, packages: Packages | None = None) -> Path | None:
    """The mesh or texture file that a URDF file names; None if there is none.

    `name` is a path relative to the folder of the URDF file or to a folder above it, an absolute
    path, `file://PATH`, or `package://PACKAGE/PATH`, whose package `package_folders` finds.
    """
    found = _PACKAGE.fullmatch(name)
    path = found[2] if found is not None else name.removeprefix("file://")
    above = urdf.absolute().parents
    for folder in above if found is None else package_folders(found[1], urdf, packages):
        with contextlib.suppress(OSError, ValueError):  # a name that the file system cannot have
            if path and (folder / path).is_file():
                return folder / path
    return None


def package_folders(package: str, file: Path, packages: Packages | None = None) -> Iterator[Path]:
    """The folders that a package can have: that in `packages`; PACKAGE in a folder above the file
    that names it, or such a folder with a `package.xml` of that name; an installed package."""
    if packages is not None and package in packages:
        yield packages[package]
        return
    for folder in file.absolute().parents:
        yield folder / package
        if _package_name(folder) == package:
            yield folder
    yield from installed_packages(package, os.environ)


def project_folder(file: Path) -> Path:
    """The project of a file: the nearest folder above it with a git repository, else the nearest
    with a ROS package, else its own folder."""
    above = file.absolute().parents
    for mark in (".git", "package.xml"):
        for folder in above:
            if (folder / mark).exists():
                return folder
    return above[0]


def installed_packages(name: str, environment: Mapping[str, str]) -> Iterator[Path]:
    """The folders that an installed package of ROS can have: in the workspaces of ROS 2
    (AMENT_PREFIX_PATH), in those of ROS 1 (ROS_PACKAGE_PATH), and beside this Python."""
    for prefix in _paths(environment, "AMENT_PREFIX_PATH"):
        yield prefix / "share" / name
    for folder in _paths(environment, "ROS_PACKAGE_PATH"):
        if folder.name == name:
            yield folder
        yield folder / name
        yield from sorted(folder.glob(f"*/{glob.escape(name)}"))  # a repository in a workspace
    yield Path(sys.prefix) / "share" / name


def _paths(environment: Mapping[str, str], name: str) -> list[Path]:
    return [Path(folder) for folder in environment.get(name, "").split(os.pathsep) if folder]


def _package_name(folder: Path) -> str:
    """The name of the ROS package in a folder; empty if there is none."""
    try:
        text = (folder / "package.xml").read_text("utf-8", "replace")
    except OSError:
        return ""
    found = _PACKAGE_NAME.search(text)
    return found[1] if found is not None else ""
