"""Descriptions in files: those that are built in, and the data of a YAML text."""

from __future__ import annotations

from collections.abc import Iterable
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
