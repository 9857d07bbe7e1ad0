"""Definitions of the common packages of ROS, for machines without an installation.

The files of this folder have the fields and constants of all types of these packages, without
comments and default values. `scripts/ros_messages.py` makes them of the packages of Debian
(ROS 1 Noetic) and PyPI (ROS 2 Foxy to Lyrical); it names the packages, their versions and licences.
A type that differs between versions of ROS has several texts. A file is read only if a script names
a type of its package that is in no folder of the user or of an installation.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from smachac.pysource.modules.ros_names import Ros

FOLDER = Path(__file__).parent

HEAD = "\n== "
"""Before the path of each text; a version of ROS after it means that only this version has it."""


class StandardPackage(NamedTuple):
    """The texts of the definitions of a package by path, `msg/Bool`. `is_complete`: it has no other
    types."""

    texts: Mapping[str, tuple[str, ...]]
    is_complete: bool

    def names(self, kind: str) -> list[str]:
        """The names of the types of a kind."""
        return [path.partition("/")[2] for path in self.texts if path.startswith(f"{kind}/")]


NO_PACKAGE = StandardPackage({}, False)


def standard_package(name: str, ros: Ros) -> StandardPackage:
    """The definitions of a package; empty for a package that is not among the common ones. If the
    types of a version of ROS are not all known, those of the other version are left out."""
    try:
        text = (FOLDER / f"{name}.txt").read_text(encoding="utf-8")
    except (OSError, ValueError):
        return NO_PACKAGE
    first, *parts = text.split(HEAD)
    is_complete = str(ros) in first.split()
    texts: dict[str, tuple[str, ...]] = {}
    for part in parts:
        head, _, body = part.partition("\n")
        path, _, version = head.partition(" ")
        if is_complete or version in ("", str(ros)):
            texts[path] = (*texts.get(path, ()), body)
    return StandardPackage(texts, is_complete)


def packages_by_message(ros: Ros) -> dict[str, list[str]]:
    """The common packages that have a message, by the name of the message."""
    found: dict[str, list[str]] = {}
    for file in sorted(FOLDER.glob("*.txt")):
        for name in standard_package(file.stem, ros).names("msg"):
            found.setdefault(name, []).append(file.stem)
    return found


def packages_with(name: str, kind: str, ros: Ros) -> list[str]:
    """The common packages that have a type of a name and a kind."""
    return [
        file.stem
        for file in sorted(FOLDER.glob("*.txt"))
        if f"{kind}/{name}" in standard_package(file.stem, ros).texts
    ]
