"""The command `new`: create a project, a state type or scenarios; no file is overwritten."""

from __future__ import annotations

import argparse
import os
import re
import sys
from argparse import Namespace

from smachac.commands.arguments import colour, quiet
from smachac.commands.output import (
    FINDINGS,
    OK,
    print_report,
    shown,
    target_options,
    usage,
    without_notes,
)

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from pathlib import Path

    from smachac.commands.scaffold import Files
    from smachac.diagnostics.diagnostic import Report
    from smachac.diagnostics.source import Source
    from smachac.frontend.loader import Library

EXAMPLES = """\
examples:
  smachac new my_robot               a folder with a machine that runs
  smachac new state Grasp            templates/Grasp.yml and robot_states/grasp.py
  smachac new state Grasp --input target=Pose --output "width=float<m>" --outcome held
  smachac new state Grasp --target cpp     include/robot_states/grasp.hpp
  smachac new state Grasp --target cpp --option mode=step    for a stepped machine
  smachac new scenario main.yml      scenarios/OUTCOME.yml for each outcome, for `run --mock`

Existing files are never overwritten.
exit codes: 0 success, 1 a file exists, has errors or cannot be written, 2 wrong usage,
70 a bug in smachac
"""


def new_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EXAMPLES
    parser.add_argument("words", nargs="+", metavar="FOLDER | state NAME | scenario SCRIPT",
                        help="the folder of a new project; `state` and the name of a new state"
                        " type; or `scenario` and a script")  # fmt: skip
    parser.add_argument("--target", choices=("python", "cpp"), default="python",
                        help="language of the generated code (default: python)")  # fmt: skip
    for name in ("input", "output"):
        parser.add_argument(f"--{name}", action="append", default=[], metavar="KEY[=TYPE]",
                            help=f"an {name} key of the state type (repeatable)")  # fmt: skip
    parser.add_argument("--outcome", action="append", default=[], metavar="NAME",
                        help="an outcome of the state type, or one that a scenario ends with"
                        " (repeatable)")  # fmt: skip
    parser.add_argument("--option", action="append", default=[], metavar="NAME=VALUE",
                        help="an option of the target cpp, as for `build`: mode=step")  # fmt: skip
    quiet(parser)
    colour(parser)


def new_command(arguments: Namespace) -> int:
    """Create a project or a state type; the exit code."""
    from pathlib import Path

    from smachac.commands.scaffold import project
    from smachac.commands.schema import schema_text

    words: list[str] = arguments.words
    if words[:1] == ["state"] and len(words) == 2:
        return _state(words[1], arguments)
    if words[:1] == ["scenario"] and len(words) == 2:
        return _scenarios(Path(words[1]), arguments)
    if len(words) != 1 or words[0] in ("state", "scenario"):
        return usage("name a folder, as in `new my_robot`, a state type, as in `new state Grasp`,"
                     " or a script, as in `new scenario main.yml`")  # fmt: skip
    folder = Path(words[0])
    if not words[0].strip() or not words[0].isprintable():
        return usage(f"`{words[0]}` is not a name for a folder")
    schemas = {name: schema_text(name) for name in ("script", "interface", "project")}
    return _put(folder, project(Path(os.path.realpath(folder)).name, schemas), arguments)


def _put(folder: Path, files: Files, arguments: Namespace) -> int:
    """Write files, unless one of them exists; the exit code."""
    from smachac.commands.files import present_files, write_files
    from smachac.commands.writing import PartlyWrittenError

    try:
        there = present_files(folder, files)
    except OSError as error:
        print(f"cannot write to {shown(folder)}: {error.strerror}", file=sys.stderr)
        return FINDINGS
    for path in there:
        print(f"{shown(path)} exists already: nothing was written", file=sys.stderr)
    if there:
        return FINDINGS
    try:
        written = write_files(folder, files)
    except (OSError, PartlyWrittenError) as error:
        words = getattr(error, "strerror", None) or error
        print(f"cannot write to {shown(folder)}: {words}", file=sys.stderr)
        return FINDINGS
    for path in written if not arguments.quiet else ():
        print(f"created {shown(path)}")
    return OK


def _scenarios(script: Path, arguments: Namespace) -> int:
    """Create a scenario for each outcome of a script, or each that `--outcome` names, beside the
    script; the exit code."""
    from smachac.commands.files import present_files
    from smachac.driver import analyse_script
    from smachac.ir.traversal import outcome_names
    from smachac.verify.scenarios import outcome_scenarios

    analysis = analyse_script(script, [], [])
    machine = analysis.checked
    print_report(without_notes(analysis.report), arguments, sys.stderr)
    if machine is None:
        return FINDINGS
    known = outcome_names(machine.root)
    for name in arguments.outcome:
        if name not in known:
            return usage(f"the script has no outcome `{name}`", name, known)
    wanted = tuple(arguments.outcome) or known
    names = {name: "scenarios/" + re.sub(r"[^\w-]", "_", name) + ".yml" for name in wanted}
    there = present_files(script.parent, names.values()) if not arguments.outcome else []
    wanted = tuple(name for name in wanted if script.parent / names[name] not in there)
    found = outcome_scenarios(machine, str(script), wanted)
    for path in there:
        print(f"{shown(path)} exists already: it was not changed", file=sys.stderr)
    for name in wanted:
        if name not in found:
            print(f"no path was found that ends with `{name}`", file=sys.stderr)
    files = {names[name]: text for name, text in found.items()}
    return _put(script.parent, files, arguments) if files else FINDINGS


def _state(name: str, arguments: Namespace) -> int:
    """Create a state type, or the code of an existing one in another language; the exit code."""
    from pathlib import Path

    from smachac.commands.files import present_files
    from smachac.commands.scaffold import (
        INTERFACE_SCHEMA,
        BadNameError,
        NewStateType,
        code_file,
        code_line,
        interface,
        is_type_name,
        key_and_type,
        stub,
    )
    from smachac.diagnostics.diagnostic import has_errors
    from smachac.frontend.files import disk_library
    from smachac.frontend.types.state_types import find_state_type

    language: str = arguments.target
    stepped = _is_stepped(arguments)
    if not isinstance(stepped, bool):
        return stepped
    if not is_type_name(name):
        return usage(f"`{name}` is not a name for a state type: write it as `GraspPart`")
    folder = Path()
    report: Report = []
    library = disk_library(folder / "main.yml", report)
    try:
        wanted = NewStateType(
            name=name,
            inputs=[key_and_type(text, library.types) for text in arguments.input],
            outputs=[key_and_type(text, library.types) for text in arguments.output],
            outcomes=arguments.outcome or ["succeeded", "aborted"],
        )
        for outcome in wanted.outcomes:
            if not outcome.isidentifier():
                raise BadNameError(f"`{outcome}` is not a name for an outcome")
    except BadNameError as error:
        return usage(str(error))
    files: Files = {}
    there = library.own_template(f"{name}.yml")
    if there is None:
        with_schema = bool(present_files(folder, {INTERFACE_SCHEMA: ""}))
        text = interface(wanted, language, with_schema=with_schema)
        files[f"templates/{name}.yml"] = text
        library = _with(library, f"{name}.yml", files[f"templates/{name}.yml"])
    type_ = find_state_type(name, library, report)
    if has_errors(report):
        print_report(report, arguments, sys.stderr)
        return FINDINGS
    assert type_ is not None
    from smachac.targets.cpp.types import UnportableError

    try:
        files[code_file(name, language)] = stub(type_, language, library, stepped=stepped)
    except UnportableError as error:
        help = f"\n{error.help}" if error.help else ""
        return usage(f"C++ cannot express the interface: {error}{help}")
    package = code_file(name, language).rpartition("/")[0] + "/__init__.py"
    if language == "python" and not present_files(folder, {package: ""}):
        files[package] = ""
    code = _put(folder, files, arguments)
    if code == OK and there is not None and language not in (*type_.code, *type_.classes):
        print(f"add to the `code` of {there.name}: {code_line(name, language)}")
    return code


def _is_stepped(arguments: Namespace) -> bool | int:
    """Whether the code is for a stepped machine; the exit code after an error of usage."""
    if not arguments.option:
        return False
    from smachac.targets import OptionError
    from smachac.targets.cpp import TARGET
    from smachac.targets.cpp.project import project

    options = target_options(arguments.option, TARGET)
    if isinstance(options, int):
        return options
    if arguments.target != "cpp":
        return usage("--option is for `--target cpp`")
    try:
        return project(options).bounds is not None
    except OptionError as error:
        return usage(f"--option {error}")


def _with(library: Library, name: str, text: str) -> Library:
    """A library with one more interface."""
    from smachac.diagnostics.source import Source
    from smachac.records import replace

    source = Source(name, text)

    def template(wanted: str) -> Source | None:
        return source if wanted == name else library.own_template(wanted)

    return replace(library, own_template=template)
