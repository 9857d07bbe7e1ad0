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

from smachac.robots.core_schema import value_of
from smachac.robots.encodings import decoded
from smachac.robots.fields import DataError

TYPE_CHECKING = False  # annotations only: most scripts have no robot
if TYPE_CHECKING:
    from smachac.robots.description import Description, Station

BUILT_IN = ("panda", "baxter", "iiwa")
"""The names of the robots that are built in."""
SUFFIXES = (".yml", ".yaml")
"""The endings of descriptions; any other text is the name of a robot."""
FOLDER = Path(__file__).parent
"""The folder of the built-in descriptions and their URDF files."""


def plain(text: str) -> Any:
    """The data of a YAML text. Raises DataError."""
    from yaml import YAMLError

    try:
        documents = _documents(text)
    except (YAMLError, LookupError, TypeError, ValueError) as error:
        help = "correct the file; `smachac check FILE` shows the place"
        raise DataError(f"not YAML: {str(error).splitlines()[0]}", (), help) from None
    if len(documents) > 1:
        raise DataError("it has more than one YAML document", (), "remove the `---`")
    return documents[0] if documents else None


def _documents(text: str) -> list[Any]:
    """The data of each document of a YAML text. Raises YAMLError, and LookupError, TypeError or
    ValueError for a wrong alias or key."""
    from yaml import events as kinds
    from yaml._yaml import CParser

    stack: list[tuple[list[Any], str | None]] = [([], None)]
    anchors: dict[str, Any] = {}
    for event in iter(CParser(text).get_event, None):
        match event:
            case kinds.SequenceStartEvent() | kinds.MappingStartEvent():
                stack.append(([], event.anchor))
                continue
            case kinds.ScalarEvent():
                is_text = event.style or event.tag is not None
                value: Any = event.value if is_text else value_of(event.value)
                anchor = event.anchor
            case kinds.SequenceEndEvent():
                value, anchor = stack.pop()
            case kinds.MappingEndEvent():
                items, anchor = stack.pop()
                value = _mapping(items)
            case kinds.AliasEvent():
                value, anchor = anchors[event.anchor], None
            case _:
                continue
        stack[-1][0].append(value)
        if anchor is not None:
            anchors[anchor] = value
    return stack[0][0]


def _mapping(items: list[Any]) -> dict[Any, Any]:
    """A mapping of its keys and values in turn; `<<` adds the entries of mappings. Raises
    TypeError and ValueError."""
    found: dict[Any, Any] = {}
    merged: list[dict[Any, Any]] = []
    for key, value in zip(items[::2], items[1::2], strict=True):
        if key == "<<":
            merged += value if isinstance(value, list) else [value]
        elif key in found:
            raise ValueError(f"the key {key} is there twice")
        else:
            found[key] = value
    for value in merged:
        found = {**found, **{key: item for key, item in dict(value).items() if key not in found}}
    return found


def read_file(path: Path) -> Any:
    """The data of a YAML file. Raises DataError and OSError."""
    try:
        return plain(decoded(path.read_bytes(), path.name))
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
    from smachac.robots.description import read

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
