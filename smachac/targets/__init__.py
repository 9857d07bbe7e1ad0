"""Targets: each prints a checked machine as files.

A target is one folder with a `TARGET` value, registered under the entry-point group
`smachac.targets`; ours and anybody's come in through the same door.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from keyword import iskeyword

from smachac.diagnostics.diagnostic import Report
from smachac.frontend.loader import Library
from smachac.frontend.state_types import StateType
from smachac.ir.nodes import Checked, Machine
from smachac.targets.interface_check import Declared
from smachac.version import __version__

GROUP = "smachac.targets"

Files = dict[str, str]
"""What a target makes: relative file name to text. Somebody else writes it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Context:
    """What a target gets beside the machine.

    `library` finds templates and interfaces. `options` are the `--option NAME=VALUE` of the
    command line.
    """

    library: Library
    options: Mapping[str, str] = field(default_factory=dict)


class OptionError(ValueError):
    """An option has a value that makes no sense."""


Emit = Callable[[Checked, Context, Report], Files]


def _nothing(_: Files) -> Mapping[str, str]:
    return {}


def _no_code(_type: StateType, _library: Library) -> bool:
    return False


def _unread(_type: StateType, _library: Library) -> Declared | None:
    return None


@dataclass(frozen=True, slots=True, kw_only=True)
class Target:
    """A target: its name, a line about it, and the function that prints.

    `options` names the options it knows, each with a line of help. An emitter reports what is
    wrong in templates of the user and what its language cannot say; then it returns no files. It
    raises OptionError; the first file it returns is the main one. `runtime` tells what such files
    stand on: file names beside them, with their paths under smachac/runtime. `has_code` tells
    whether states of a type can be printed, `declared` what a class of the user says of itself.
    """

    name: str
    description: str
    emit: Emit
    options: Mapping[str, str] = field(default_factory=dict)
    runtime: Callable[[Files], Mapping[str, str]] = _nothing
    has_code: Callable[[StateType, Library], bool] = _no_code
    declared: Callable[[StateType, Library], Declared | None] = _unread


def made_by(machine: Machine) -> str:
    """The line by which files of ours are known: who made them, from what."""
    return f"Made by smachac {__version__} from {machine.source} (sha256 {machine.digest[:16]})."


def stem(machine: Machine) -> str:
    """The machine's name as a file name without suffix; also a name that Python can import."""
    word = re.sub(r"\W+", "_", machine.root.name).strip("_") or "machine"
    return f"_{word}" if word[0].isdigit() or iskeyword(word) else word


def target_names() -> list[str]:
    """The names of all installed targets."""
    from importlib.metadata import entry_points

    return sorted({entry.name for entry in entry_points(group=GROUP)})


def load_target(name: str) -> Target | None:
    """The target of that name, imported now, or None."""
    from importlib.metadata import entry_points

    for entry in entry_points(group=GROUP, name=name):
        target: Target = entry.load()
        return target
    return None
