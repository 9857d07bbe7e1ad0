"""The search for scripts: from the arguments of a command (files, folders, patterns) to paths.

A folder is searched for files whose text looks like a script; the project file can exclude some.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Sequence
from fnmatch import fnmatchcase
from glob import has_magic
from pathlib import Path

from smachac.diagnostics.diagnostic import Report
from smachac.frontend.config import Project
from smachac.frontend.files import Disk, find_project, leads_out, lies_inside

SUFFIXES = (".yml", ".yaml")

PYTHON_SUFFIX = ".py"
"""The suffix of Python files with machines."""

SKIPPED = ("__pycache__", "node_modules")
"""Folders that are not searched; nor are those whose name begins with a dot."""

_KEY = r"^([\"']?)(\w+)\1[ \t]*:"
_ITEM = r"^[ \t]*(?:#[^\n]*|---[^\n]*)?$"
_CALLABLE = r"(?:^[ \t]+|[{,][ \t]*)(?:template|script|T|S)[ \t]*:"
_FLOW_PART = r"""#[^\n]*|(?:"((?:[^"\\]|\\.)*)"?|'([^']*)'?|(\w+))([ \t\n]*:)?|[{}\[\]]"""
"""A part of flow style: a comment, a text or word with the colon of a key, a bracket. A text that
does not end goes up to the end, so that each character is read once."""

_NAMED = {"name", "template", "outcomes", "n", "T", "o"}


PythonFiles = Callable[[Path, Disk], "list[Path]"]


class NothingFoundError(Exception):
    """An argument matches no script; the message names it."""


def scripts_of(
    arguments: Sequence[Path], disk: Disk, python: PythonFiles | None = None
) -> list[Path]:
    """The scripts that files, folders and patterns match, each once, in order. `python` returns the
    Python files with machines in a folder, which then belong to the result.

    A named file is always included. A folder stands for all YAML files in it that look like scripts
    and that the project file does not exclude. The disk refuses links that lead out of a folder or
    of the folder of a pattern. Raises NothingFoundError.
    """
    found: dict[str, Path] = {}
    for argument in arguments:
        paths = [argument]
        if os.path.isdir(argument):  # noqa: PTH112 (no error for a name that is too long)
            paths = [path for path in yaml_files([argument]) if _is_script(path, argument, disk)]
            paths += python(argument, disk) if python is not None else []
        elif has_magic(str(argument)) and not os.path.lexists(argument):
            root = Path(argument.anchor)
            paths = sorted(root.glob(str(argument.relative_to(root))))
            paths = [path for path in paths if path.is_file()]
            folder = next(parent for parent in argument.parents if not has_magic(str(parent)))
            for path in paths:
                _refuse_link(path, folder, disk)
        if not paths:
            more = " and no Python file with a state machine" if python is not None else ""
            help = "; `smachac new my_robot` creates a project" if argument == Path() else ""
            raise NothingFoundError(f"there is no script{more} in `{argument}`{help}")
        for path in paths:
            found.setdefault(os.path.realpath(path), path)
    return list(found.values())


def yaml_files(arguments: Sequence[Path], suffixes: tuple[str, ...] = SUFFIXES) -> Iterator[Path]:
    """The YAML files in folders, or those with other suffixes, sorted, without those that their
    project file excludes."""
    for argument in arguments:
        if argument.is_dir():
            project = find_project(argument / "script.yml", [])

            def kept(path: Path, project: Project = project) -> bool:
                hidden = path.name.startswith(".") or path.name in SKIPPED
                return not hidden and not _excluded(path, project)

            for top, folders, names in os.walk(argument):
                folders[:] = [name for name in sorted(folders) if kept(Path(top, name))]
                paths = (Path(top, name) for name in sorted(names) if name.endswith(suffixes))
                yield from filter(kept, paths)


def _excluded(path: Path, project: Project) -> bool:
    if not project.exclude:
        return False
    name = Path(os.path.relpath(path, project.folder)).as_posix()
    return any(fnmatchcase(name, pattern.rstrip("/")) for pattern in project.exclude)


def _is_script(path: Path, folder: Path, disk: Disk) -> bool:
    """Whether a YAML file in a folder looks like a script or sub-script, even if it has syntax
    errors.

    A file that cannot be read counts as a script, so that it is reported; so does a link that leads
    out of the folder.
    """
    if _refuse_link(path, folder, disk):
        return True
    report: Report = []
    source = disk.read(path, report)
    return source is None or looks_like_a_script(source.text)


def _refuse_link(path: Path, folder: Path, disk: Disk) -> bool:
    """Whether a file is a link that leads out of a folder; the disk refuses it from then on."""
    if lies_inside(path, folder):
        return False
    disk.refused[str(path)] = leads_out(path, folder)
    return True


def looks_like_a_script(text: str) -> bool:
    """Whether the outermost mapping has `states` and another field of scripts, or the text is a
    list of states; in block style or in flow style (`{name: main, states: [...]}`)."""
    first = next(
        (line for line in text.splitlines() if not re.fullmatch(_ITEM, line, re.M)), ""
    ).lstrip()
    flow = first.startswith("{")
    keys = _flow_keys(text) if flow else {found[2] for found in re.finditer(_KEY, text, re.M)}
    if keys & {"states", "s"}:
        return bool(keys & _NAMED)
    return first.startswith(("- ", "[")) and re.search(_CALLABLE, text, re.M) is not None


def _flow_keys(text: str) -> set[str]:
    """The keys of the outermost mapping of a text in flow style."""
    keys = set()
    depth = 0
    for part in re.finditer(_FLOW_PART, text, re.DOTALL):
        if part[0] in "{[":
            depth += 1
        elif part[0] in "}]":
            depth -= 1
        elif part[4] and depth == 1:
            keys.add(part[1] or part[2] or part[3])
    return keys
