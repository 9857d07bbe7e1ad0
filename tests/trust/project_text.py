"""Projects as plain data, and their text, in which every entry has a line of its own.

A project is file names to data; data of a file are dicts, lists, scalars and `Quoted` strings. What
is printed is block style throughout, but for numbers: so the line of a finding says exactly which
entry it blames.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, TypeAlias

from smachac.diagnostics.source import Source
from smachac.driver import Analysis, analyse
from smachac.frontend.files import disk_library
from smachac.frontend.loader import memory_library
from smachac.frontend.text.recovering_parser import parse_with_recovery
from smachac.frontend.text.yaml_tree import Map, Scalar, Seq, Tree, parse

ROOT = Path(__file__).parents[2]
BUILT_IN = disk_library(ROOT / "main.yml", [])
MAIN = "main.yml"

Data: TypeAlias = Any
Project: TypeAlias = dict[str, Data]
Steps: TypeAlias = tuple[str | int, ...]
"""The way to a part of a file: keys and numbers of items."""


class Quoted(str):
    """A string that stands in quotes, and so is never code, a look-up or a number."""

    __slots__ = ()


def read(text: str) -> Data:
    """The data of a text of YAML. Of duplicate keys the first counts."""
    tree = parse(Source(MAIN, text), [])
    assert tree is not None
    return _plain(tree)


def _plain(tree: Tree) -> Data:
    match tree:
        case Scalar(value=value, plain=plain):
            return Quoted(value) if isinstance(value, str) and not plain else value
        case Seq(items=items):
            return [_plain(item) for item in items]
        case Map(entries=entries):
            found: dict[Data, Data] = {}
            for entry in entries:
                found.setdefault(_plain(entry.key), _plain(entry.value))
            return found


@dataclass(frozen=True, slots=True)
class Written:
    """A text, and the first and last line of each part of its data."""

    text: str
    lines: Mapping[Steps, tuple[int, int]] = field(default_factory=dict)


def written(data: Data) -> Written:
    """The text of a file. A string is a file that is no YAML, and stays as it is."""
    if isinstance(data, str):
        return Written(data)
    rows: list[str] = []
    lines: dict[Steps, tuple[int, int]] = {}
    _put(data, 0, (), rows, lines)
    lines[()] = (1, len(rows))
    return Written("\n".join(rows) + "\n", lines)


def _put(
    data: Data, indent: int, steps: Steps, rows: list[str], lines: dict[Steps, tuple[int, int]]
) -> None:
    entries = data.items() if isinstance(data, dict) else enumerate(data)
    margin = " " * indent
    for key, value in entries:
        first = len(rows) + 1
        head = f"{_scalar(key)}:" if isinstance(data, dict) else "-"
        short = _inline(value)
        if short is not None:
            rows.append(f"{margin}{head} {short}".rstrip())
        elif isinstance(data, dict):
            rows.append(margin + head)
            _put(value, indent + 2, (*steps, key), rows, lines)
        else:
            _put(value, indent + 2, (*steps, key), rows, lines)
            rows[first - 1] = f"{margin}- {rows[first - 1][indent + 2 :]}"
        lines[(*steps, key)] = (first, len(rows))


def _inline(value: Data) -> str | None:
    """A value on the line of its key: a scalar, nothing at all, or numbers."""
    if isinstance(value, dict):
        return None if value else "{}"
    if isinstance(value, list):
        parts = [_inline(item) for item in value if not isinstance(item, str)]
        whole = len(parts) == len(value) and all(parts)
        return f"[{', '.join(map(str, parts))}]" if whole else None
    return _scalar(value)


def _scalar(value: Data) -> str:
    match value:
        case None:
            return "null"
        case bool():
            return str(value).lower()
        case float() if math.isinf(value) or math.isnan(value):
            return {"inf": ".inf", "-inf": "-.inf"}.get(repr(value), ".nan")
        case Quoted() | "":
            return json.dumps(value, ensure_ascii=False)
    return str(value)


def texts(project: Project) -> dict[str, Written]:
    return {name: written(data) for name, data in project.items()}


def analysed(files: Mapping[str, str]) -> Analysis:
    """What smachac says of a project, with nothing on a disk but the built-in state types. As for
    files on a disk, lost signs and wrong indentations are repaired."""
    library = replace(memory_library(files, BUILT_IN), parse=parse_with_recovery)
    return analyse(Source(MAIN, files[MAIN]), library, [])


def judged(project: Project) -> Analysis:
    return analysed({name: each.text for name, each in texts(project).items()})


@dataclass(frozen=True, slots=True, eq=False)
class Site:
    """A state in a file: its body, which a mutation may change, and what is around it.

    `path` leads to the body, `at` to the name. The machine itself is a site without a name, and so
    is what a list of a sub-script stands in for.
    """

    file: str
    path: Steps
    name: str
    body: dict[str, Data]
    around: Site | None = None

    def states(self) -> list[Site]:
        """The states in it that are written in the nested layout."""
        items = self.body.get("states")
        return [
            _site(self.file, (*self.path, "states", at), item, self)
            for at, item in enumerate(items if isinstance(items, list) else ())
            if isinstance(item, dict) and len(item) == 1
            if isinstance(next(iter(item.values())), dict)
        ]

    def siblings(self) -> list[Site]:
        return self.around.states() if self.around is not None else []

    def pairs(self, variable: str) -> dict[str, Data]:
        """A variable that is a mapping; empty where it is not there, or something else."""
        value = self.body.get(variable)
        return value if isinstance(value, dict) else {}

    def keys(self, variable: str) -> list[str]:
        """The names in a list of names or in a mapping."""
        value = self.body.get(variable)
        return [name for name in value or () if isinstance(name, str)]

    @property
    def template(self) -> str:
        return str(self.body.get("template", ""))

    @property
    def target(self) -> str:
        """The state type, `StateMachine` for the machine itself."""
        return self.template if self.path else "StateMachine"


def _site(file: str, steps: Steps, item: dict[str, Data], around: Site | None = None) -> Site:
    """The state that an item of a list describes."""
    ((name, body),) = item.items()
    return Site(file, (*steps, name), name, body, around)


def sites(project: Project) -> Iterator[Site]:
    """The machine, the states of its sub-scripts, and all states in them, files in order."""
    for name, data in project.items():
        if "/" in name or isinstance(data, str):
            continue
        if isinstance(data, dict):
            todo = [Site(name, (), "", data)]
        else:
            todo = [_site(name, (at,), item) for at, item in enumerate(data)]
        while todo:
            here = todo.pop(0)
            yield here
            todo[:0] = here.states()
