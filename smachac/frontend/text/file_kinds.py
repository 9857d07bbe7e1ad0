"""The kinds of files in YAML, known by the fields of their text."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, TypeAlias

from smachac.frontend.schema import INTERFACE_FIELDS, VARIABLES
from smachac.frontend.text.yaml_tree import Map, Tree

FileKind: TypeAlias = Literal[
    "script", "interface", "scenario", "project", "robot", "scene", "faults"
]
"""The kinds of files that are edited; a sub-script is a script. A project file is in TOML."""

OTHER_FILES: Mapping[FileKind, tuple[str, str]] = {
    "interface": ("the interface of a state type", "name a script that uses it"),
    "scenario": ("a scenario", "`smachac run main.yml --mock FILE` plays it with a script"),
    "robot": ("the description of a robot", "name a script that has it as `robot: FILE`"),
    "scene": ("a scene", "name a script that has it as `scene: FILE`"),
    "faults": ("a list of faults", "`smachac run main.yml --faults FILE` injects them in a run"),
}
"""What a file is that is no script, and what to do with it."""

_SCRIPT_FIELDS = frozenset(["states", "s", "template", "T"])
"""The fields by which a script is known, also with a field of another kind of file."""

_STATE_FIELDS = frozenset(["template", "T", "script", "S", "transitions", "t"])
"""The fields by which a state of a script is known, also in a mapping in place of a list."""

_INTERFACE_FIELDS = INTERFACE_FIELDS.keys() - VARIABLES.keys()

_DATA_FIELDS: Mapping[str, FileKind] = {
    "arms": "robot",
    "urdf": "robot",
    "parts": "robot",
    "bodies": "scene",
    "faults": "faults",
}
"""The fields by which another file is known: neither scripts nor interfaces have them."""


def kind_of_tree(tree: Tree | None) -> FileKind:
    """The kind of a text; a script if no field shows another kind."""
    if not isinstance(tree, Map):
        return "script"
    names = [str(entry.key.value) for entry in tree.entries]
    if names == ["states"] and isinstance(states := tree.entries[0].value, Map):
        bodies = [entry.value for entry in states.entries if isinstance(entry.value, Map)]
        given = {str(entry.key.value) for body in bodies for entry in body.entries}
        return "scenario" if _STATE_FIELDS.isdisjoint(given) else "script"
    if not _SCRIPT_FIELDS.isdisjoint(names):
        return "script"
    if not _INTERFACE_FIELDS.isdisjoint(names):
        return "interface"
    if {"outcomes", "o"}.isdisjoint(names):
        return next((_DATA_FIELDS[name] for name in names if name in _DATA_FIELDS), "script")
    return "script"
