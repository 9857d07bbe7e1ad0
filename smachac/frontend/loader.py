"""The library of a script: functions that find sub-scripts, templates and code of the user."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from smachac.diagnostics.diagnostic import (
    Report,
)
from smachac.diagnostics.severities import Policy
from smachac.diagnostics.source import Source
from smachac.frontend.yaml_tree import Tree, parse


@dataclass(frozen=True, slots=True, kw_only=True)
class Library:
    """How the compiler reaches files: by functions, so that it never touches a disk itself.

    `script(name, caller)` is the text of a sub-script named in the source `caller`;
    `template(file)` that of an interface or template by file name (`MoveTo.yml`,
    `MoveTo.tpl.py`), `own_template` the same where it is the user's, not one of ours; `code(file)`
    that of a module or header of the user's by path (`my_robot/grasp.hpp`). The folders and names
    serve messages. `policy` is that of the project; `parse` may remember the trees of
    texts that several scripts share.
    """

    script: Callable[[str, str], Source | None]
    template: Callable[[str], Source | None]
    own_template: Callable[[str], Source | None] = lambda file: None
    code: Callable[[str], Source | None] = lambda file: None
    script_folders: Callable[[str], Sequence[str]] = lambda caller: ()
    template_folders: Callable[[], Sequence[str]] = lambda: ()
    script_names: Callable[[str], Sequence[str]] = lambda caller: ()
    template_names: Callable[[], Sequence[str]] = lambda: ()
    parse: Callable[[Source, Report], Tree | None] = parse
    policy: Policy = field(default_factory=Policy)


def memory_library(files: Mapping[str, str], builtin_behaviour: Library) -> Library:
    """A library over texts in memory; templates not among them come from `builtin_behaviour`."""
    sources = {name: Source(name, text) for name, text in files.items()}

    def script(name: str, caller: str) -> Source | None:
        names = (name, f"{name}.yml", f"{name}.yaml")
        return next((sources[name] for name in names if name in sources), None)

    def own_template(name: str) -> Source | None:
        return sources.get(f"templates/{name}") or builtin_behaviour.own_template(name)

    return Library(
        script=script,
        template=lambda name: own_template(name) or builtin_behaviour.template(name),
        own_template=own_template,
        code=lambda name: sources.get(name) or builtin_behaviour.code(name),
        script_folders=lambda caller: ["."],
        template_folders=lambda: ["templates", *builtin_behaviour.template_folders()],
        script_names=lambda caller: [name.removesuffix(".yml") for name in sources],
        template_names=lambda: [
            *(name.removeprefix("templates/").split(".")[0] for name in sources),
            *builtin_behaviour.template_names(),
        ],
    )
