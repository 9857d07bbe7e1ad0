"""Targets: each prints a checked machine as files.

A target is one folder with a `TARGET` value, registered under the entry-point group
`smachac.targets`; ours and anybody's come in through the same door.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib.metadata import entry_points

from smachac.diagnostics import Report
from smachac.ir.nodes import Checked
from smachac.states import Library

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


Emit = Callable[[Checked, Context, Report], Files]


@dataclass(frozen=True, slots=True, kw_only=True)
class Target:
    """A target: its name, a line about it, and the function that prints.

    `options` names the options it knows, each with a line of help. An emitter reports only what
    is wrong in templates of the user; then it returns no files.
    """

    name: str
    description: str
    emit: Emit
    options: Mapping[str, str] = field(default_factory=dict)


def target_names() -> list[str]:
    """The names of all installed targets."""
    return sorted({entry.name for entry in entry_points(group=GROUP)})


def load_target(name: str) -> Target | None:
    """The target of that name, imported now, or None."""
    for entry in entry_points(group=GROUP, name=name):
        target: Target = entry.load()
        return target
    return None
