"""The command `import`: scripts from a machine in Python, SCXML or YASMIN XML, with a proof."""

from __future__ import annotations

import argparse
import sys
from argparse import Namespace

from smachac.commands.arguments import (
    as_path,
    colour,
    machine_name,
    memory_limit,
    quiet,
    time_limit,
)
from smachac.commands.output import FINDINGS, OK, print_report, shown, usage, without_notes
from smachac.commands.python_files import is_python

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from smachac.diagnostics.source import Span
    from smachac.refactor.imports.project import Imported

EXAMPLES = """\
examples:
  smachac import machine.py -o project                write the scripts of all machines in the file
  smachac import machine.py -o project --machine Tour    only those of one machine
  smachac import machine.py -o project --assume "'--fast' in sys.argv=false"
                                                      the branch of an `if` that is not known
  smachac import machine.scxml -o project             a document of W3C SCXML
  smachac import demo.xml -o project                  a file of YASMIN's factory or editor
  smachac check project/main.yml                      then: find the errors in the script
  smachac build project/main.yml --target python      and generate its program

The code of your states stays where it is: the scripts name your classes, for SMACH, YASMIN or
FlexBE. States of SCXML and XML get classes whose code is to be written. The command prints what it
could not take over, and proves that each script has the same graph as the machine in the file.
Your code is not run. Files that were edited since an import are never overwritten.

exit codes: 0 all machines were imported and proven, 1 a machine was not, or a file is in the way,
2 wrong usage, 70 a bug in smachac
"""


KNOWN = (
    "`--assume 'CONDITION=true'` selects a branch; `smachac docs existing` shows how to make the"
    " rest known"
)
"""The help for a machine that is not known as a whole."""


def import_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EXAMPLES
    parser.add_argument(
        "file",
        type=as_path,
        help="a Python file that builds machines or a behavior of FlexBE, an SCXML document, or an"
        " XML file of YASMIN",
    )
    parser.add_argument("-o", "--output", type=as_path, default=".", metavar="DIR",
                        help="the folder of the project (default: the current one)")  # fmt: skip
    machine_name(parser)
    parser.add_argument("--assume", type=_assumption, action="append", default=[],
                        metavar="CONDITION=VALUE",
                        help="the value, `true` or `false`, of a condition in the code that is not"
                        " known (repeatable)")  # fmt: skip
    quiet(parser)
    memory_limit(parser)
    time_limit(parser)
    colour(parser)


def _assumption(text: str) -> tuple[str, bool]:
    """A condition, as `ast.unparse` writes it, and its value."""
    import ast

    from smachac.ir.python_code import parse_code

    code, _, value = text.rpartition("=")
    if value not in ("true", "false"):
        raise argparse.ArgumentTypeError(f"`{text}` does not end with `=true` or `=false`")
    try:
        return ast.unparse(parse_code(code)), value == "true"
    except SyntaxError:
        raise argparse.ArgumentTypeError(f"`{code}` is no condition of Python") from None


def import_command(arguments: Namespace) -> int:
    """Import a file; the exit code."""
    from smachac.commands.cpu_time import CpuTimeError, limited_time
    from smachac.commands.memory import limited_memory
    from smachac.frontend.files import Disk
    from smachac.refactor.imports.python_project import import_python
    from smachac.refactor.imports.xml_project import import_xml

    path: Path = arguments.file
    is_xml = path.suffix.lower() in (".scxml", ".xml")
    if not is_python(path) and not is_xml:
        return usage(f"{path} is no Python, SCXML or XML file")
    if is_xml and arguments.assume:
        return usage("--assume is for Python files")
    try:
        with limited_memory(arguments.memory_limit), limited_time(arguments.time_limit):
            made = (import_xml(path, arguments.output, Disk(), arguments.machine) if is_xml
                    else import_python(path, arguments.output, Disk(), arguments.machine,
                                       dict(arguments.assume)))  # fmt: skip
    except CpuTimeError as error:
        print(error, file=sys.stderr)
        return FINDINGS
    if not made.is_read:
        print_report(without_notes(made.report), arguments, sys.stderr)
        return FINDINGS
    for code in made.vain:
        return usage(f"--assume: {path} has no condition `{code}` that is not known")
    if not made.names and arguments.machine is not None and made.all_names:
        message = f"{path} has no machine `{arguments.machine}`"
        return usage(message, arguments.machine, made.all_names)
    if not made.names:
        print(f"no state machine found in {shown(path)}\nhelp: name the file that builds"
              " `smach.StateMachine`, or one of YASMIN or FlexBE", file=sys.stderr)  # fmt: skip
        return FINDINGS
    for machine in made.incomplete:
        why = "parts of it are not known"
        help = "add states to it" if is_xml else KNOWN
        if machine.framework:
            why = "it cannot become a script"
            help = "`smachac check` and `smachac view` read it; a script has to be written by hand"
        print(f"error: `{machine.name}` was not imported: {why}", file=sys.stderr)
        for span, reason in machine.unknown:
            print(f"  --> {_place(span)}: {reason}", file=sys.stderr)
        print(f"help: {help}", file=sys.stderr)
    return _put(made, arguments) if made.texts else FINDINGS


def _place(span: Span) -> str:
    return shown(f"{span.source.name}:{span.line}:{span.column}")


def _put(made: Imported, arguments: Namespace) -> int:
    """Write the project and print what is known of it; the exit code."""
    from smachac.commands.files import not_written, write_files
    from smachac.commands.writing import PartlyWrittenError

    folder: Path = arguments.output
    try:
        edited, changed = _on_disk(folder, made.texts)
    except OSError as error:
        print(not_written(error), file=sys.stderr)
        return FINDINGS
    for name in edited:
        print(f"error: {shown(folder / name)} was edited, or is no file of an import of this"
              " file: nothing was written", file=sys.stderr)  # fmt: skip
    if edited:
        print("help: import into an empty folder with `-o`, and compare the two", file=sys.stderr)
        return FINDINGS
    try:
        written = write_files(folder, changed)
    except (OSError, PartlyWrittenError) as error:
        print(not_written(error), file=sys.stderr)
        return FINDINGS
    if not arguments.quiet:
        for path in written:
            print(f"wrote {shown(path)}")
        if not written:
            print(f"{shown(folder)} is up to date")
        for name in _unused(folder, made.texts):
            print(f"no longer used: {shown(folder / name)}")
    for lost in made.lost:
        print(f"not taken over: {_place(lost.span)}: {shown(lost.text)}")
        print(f"  help: {shown(lost.help)}")
    return _print_proofs(made, arguments)


def _on_disk(folder: Path, texts: Mapping[str, str]) -> tuple[list[str], dict[str, str]]:
    """The files that are in the way, as they were edited or are of someone else; and the texts
    that differ from those on disk. Raises OSError."""
    import os

    from smachac.refactor.imports.project import imported_from

    in_the_way: list[str] = []
    changed: dict[str, str] = {}
    for name, text in texts.items():
        path = folder / name
        before = _text(path)
        if before != text:
            changed[name] = text
            own = before is not None and imported_from(before) == imported_from(text)
            if os.path.lexists(path) and not own:
                in_the_way.append(name)
    return in_the_way, changed


def _text(path: Path) -> str | None:
    """The text of a file; None if there is none, or a link."""
    from smachac.frontend.files import TooBigError, read_bytes

    if path.is_symlink() or not path.is_file():
        return None
    try:
        return read_bytes(path).decode("utf-8")
    except (ValueError, TooBigError):
        return None


def _unused(folder: Path, texts: Mapping[str, str]) -> list[str]:
    """The files of an earlier import of the same file that this one does not have."""
    from smachac.refactor.imports.project import imported_from

    (source, *_) = {imported_from(text) for text in texts.values()}
    paths = sorted([*folder.glob("*.*"), *folder.glob("templates/*.*")])
    names = [path.relative_to(folder).as_posix() for path in paths]
    return [name for name in names if name not in texts
            and (text := _text(folder / name)) is not None
            and imported_from(text) == source]  # fmt: skip


def _print_proofs(made: Imported, arguments: Namespace) -> int:
    """Print the proofs; the exit code."""
    proven = True
    for proof in made.proofs:
        names = f"{shown(proof.script)} is the graph of {shown(arguments.file)}"
        counts = f"{_count(proof.states, 'state')}, {_count(proof.transitions, 'transition')}"
        if proof.differences:
            proven = False
            print(f"no proof: the graph of {shown(proof.script)} differs from that of"
                  f" {shown(arguments.file)}:")  # fmt: skip
            for difference in proof.differences:
                print(f"  {shown(difference)}")
        else:
            print(f"proof: the graph of {names}: {counts}")
        if proof.report:
            errors = _count(len(proof.report), "error")
            script = shown(arguments.output / proof.script)
            print(f"{shown(proof.script)} has {errors}: `smachac check {script}` shows them")
    known = {item.code for item in made.report}
    report = [item for proof in made.proofs for item in proof.report if item.code not in known]
    print_report(report, arguments, sys.stderr)
    return OK if proven and not made.incomplete else FINDINGS


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
