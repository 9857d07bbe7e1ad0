"""The command `states`: list the state types, or describe one."""

from __future__ import annotations

import argparse
import sys
from argparse import Namespace

from smachac.commands.arguments import folder, report_output
from smachac.commands.output import OK, usage

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from pathlib import Path

    from smachac.diagnostics.diagnostic import Report
    from smachac.ir.nodes import StateType
    from smachac.report.state_types import Known

EXAMPLES = """\
examples:
  smachac states                               all state types for scripts in the current folder
  smachac states MoveToJointPositionsState     the variables, keys and outcomes of one
  smachac states --format md > states.md       all of them as a document

exit codes: 0 success, 2 wrong usage or unknown state type, 70 a bug in smachac
"""


def states_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EXAMPLES
    parser.add_argument("name", nargs="?", metavar="NAME", help="the state type to describe")
    report_output(parser, "text", "json", "md")
    folder(parser, "templates", "templates and interfaces")


def states_command(arguments: Namespace) -> int:
    """Print state types; the exit code."""
    from smachac.report import state_types as shown_types
    from smachac.report.json import json_text
    from smachac.report.terminal import visible

    known = _known_types(arguments.templates)
    names = [other.type.name for other in known]
    if arguments.name is not None and arguments.name not in names:
        return usage(f"there is no state type `{arguments.name}`", arguments.name, names)
    some = [other for other in known if arguments.name in (None, other.type.name)]
    match arguments.format:
        case "json":
            rows = [shown_types.type_json(known) for known in some]
            text = json_text(rows if arguments.name is None else rows[0])
        case "md":
            text = "\n".join(map(shown_types.type_markdown, some))
        case _ if arguments.name is None:
            text = shown_types.list_text(some)
        case _:
            text = shown_types.type_text(some[0])
    sys.stdout.write(visible(text))
    return OK


def _known_types(templates: list[Path]) -> list[Known]:
    """The state types for scripts in the current folder: the user's, then the built-in ones."""
    from pathlib import Path

    from smachac.frontend.files import disk_library
    from smachac.frontend.schema import CONTAINERS
    from smachac.pysource.modules.user_code import languages
    from smachac.report.state_types import Known, container_type, usable_types
    from smachac.targets import load_target, target_names

    found: Report = []
    library = disk_library(Path("main.yml"), found, templates=templates)
    targets = [target for name in target_names() if (target := load_target(name)) is not None]

    def row(type_: StateType, place: str) -> Known:
        able = [target.name for target in targets if target.has_code(type_, library)]
        others = set(languages(type_)) - {target.name for target in targets}
        return Known(type_, place, tuple(sorted({*able, *others})))

    known = []
    for type_, own in usable_types(library):
        known.append(row(type_, "of this project" if own else "built-in"))
    known += [row(container_type(name), "built-in") for name in CONTAINERS.values()]
    return sorted(known, key=lambda known: (known.place == "built-in", known.type.name))
