"""The templates that the Python program of a machine is made of, as source texts."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

from smachac.diagnostics.source import Source
from smachac.ir.nodes import Machine
from smachac.ir.traversal import walk
from smachac.pysource.modules.ros_names import Ros
from smachac.pysource.modules.user_code import UserCode

TEMPLATE_FILES = ("{}.tpl.py", "{}.tpl")
"""The file names that the Python template of a state type may have."""

_OTHERS = r"\{%[-+]?\s*(?:extends|include|import|from)\s+[\"']([^\"']+)[\"']"


def template_finder(library: UserCode, ros: Ros) -> Callable[[str], Source | None]:
    """A function that finds templates: those of the user, then those for a version of ROS, then the
    other built-in ones."""

    def find(name: str) -> Source | None:
        own = library.own_template(name)
        beside = library.template(f"ros2/{name}") if ros == 2 and own is None else None
        return own or beside or library.template(name)

    return find


def template_sources(machine: Machine, library: UserCode) -> Iterator[tuple[str, Source]]:
    """The templates of the base and the state types of a machine, and those that they extend,
    include or import: each once, with its file name."""
    find = template_finder(library, library.ros)
    types = {machine.base, *(node.type for _, node in walk(machine.root))}
    seen = set[str]()
    todo = [file for name in sorted(types) for file in _files(name, machine)]
    while todo:
        file = todo.pop()
        source = find(file) if file not in seen else None
        seen.add(file)
        if source is not None:
            yield file, source
            todo += re.findall(_OTHERS, source.text)


def uses_own_templates(machine: Machine, library: UserCode) -> bool:
    """Whether the user has templates for the base or a state type of a machine."""
    types = {machine.base, *(node.type for _, node in walk(machine.root))}
    files = (file for name in sorted(types) for file in _files(name, machine))
    return any(library.own_template(file) is not None for file in files if ":" not in file)


def _files(name: str, machine: Machine) -> list[str]:
    """The file names that the template of a state type may have."""
    type_ = machine.state_types.get(name)
    code = [type_.code["python"]] if type_ is not None and "python" in type_.code else []
    return [*code, *(pattern.format(name) for pattern in TEMPLATE_FILES)]
