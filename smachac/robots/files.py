"""Descriptions in files: those that are built in, and the data of a YAML text."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from smachac.robots.core_schema import value_of
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
