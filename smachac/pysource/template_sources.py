"""The templates that the Python program of a machine is made of, as source texts."""

from __future__ import annotations

import re
from collections.abc import Iterator

from smachac.diagnostics.source import Source
from smachac.frontend.loader import Library
from smachac.frontend.types.state_types import TEMPLATE_FILES
from smachac.ir.nodes import Machine
from smachac.ir.traversal import walk
from smachac.targets.python.ros import template_finder

_OTHERS = re.compile(r"\{%[-+]?\s*(?:extends|include|import|from)\s+[\"']([^\"']+)[\"']")


def template_sources(machine: Machine, library: Library) -> Iterator[tuple[str, Source]]:
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
            todo += _OTHERS.findall(source.text)


def uses_own_templates(machine: Machine, library: Library) -> bool:
    """Whether the user has templates for the base or a state type of a machine."""
    types = {machine.base, *(node.type for _, node in walk(machine.root))}
    files = (file for name in sorted(types) for file in _files(name, machine))
    return any(library.own_template(file) is not None for file in files if ":" not in file)


def _files(name: str, machine: Machine) -> list[str]:
    """The file names that the template of a state type may have."""
    type_ = machine.state_types.get(name)
    code = [type_.code["python"]] if type_ is not None and "python" in type_.code else []
    return [*code, *(pattern.format(name) for pattern in TEMPLATE_FILES)]
