"""The command `build`: generate the files of a target; print them, write them, or compare them."""

from __future__ import annotations

import argparse
import os
import sys
from argparse import Namespace

from smachac.commands.arguments import (
    SCRIPT,
    as_path,
    colour,
    machine_name,
    memory_limit,
    quiet,
    search_folders,
    time_limit,
)
from smachac.commands.output import (
    FINDINGS,
    OK,
    print_report,
    shown,
    target_options,
    usage,
    without_notes,
)
from smachac.commands.python_files import MachineError, is_python, named_analyses

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from smachac.targets import Files, Target

EXAMPLES = """\
examples:
  smachac build main.yml --target python             write the Python program here
  smachac build main.yml --target cpp -o generated   write the C++ code into a folder
  smachac build main.yml --target dot -o -           print the picture for Graphviz
  smachac build main.yml --target html -o out        write a page for a browser
  smachac build main.yml --target dot --option depth=1    set an option of the target
  smachac build main.yml --target python --check     fail if the file is not up to date (CI)
  smachac build machine.py --target html -o out      the pages of the machines in a Python file

exit codes: 0 success, 1 the script has errors or a file is in the way or not up to date,
2 wrong usage, 70 a bug in smachac
"""


def build_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EXAMPLES
    parser.add_argument("script", type=as_path, help=SCRIPT)
    parser.add_argument("--target", "-t", required=True, help="the target (see `smachac targets`)")
    parser.add_argument("-o", "--output", type=as_path, default=".", metavar="DIR",
                        help="folder to write to (default: the current one); `-` prints the main"
                        " file")  # fmt: skip
    parser.add_argument("--option", action="append", default=[], metavar="NAME=VALUE",
                        help="an option of the target (repeatable)")  # fmt: skip
    parser.add_argument("--check", action="store_true",
                        help="write nothing; exit with 1 if a file is not up to date")  # fmt: skip
    parser.add_argument("--force", action="store_true",
                        help="overwrite files that smachac did not generate")  # fmt: skip
    quiet(parser)
    machine_name(parser)
    search_folders(parser)
    memory_limit(parser)
    time_limit(parser)
    colour(parser)


def build_command(arguments: Namespace) -> int:
    """Generate code; the exit code."""
    from smachac.commands.cpu_time import CpuTimeError, limited_time
    from smachac.commands.memory import limited_memory
    from smachac.driver import analyse_script, compile_files
    from smachac.targets import OptionError, load_target, target_names

    target = load_target(arguments.target)
    if target is None:
        return usage(f"there is no target `{arguments.target}`", arguments.target, target_names())
    if is_python(arguments.script) and not target.is_picture:
        return usage(f"target `{target.name}` makes a program, and {arguments.script} is one: the"
                     " targets of Python files are pictures, such as dot, mermaid and html"
                     )  # fmt: skip
    if arguments.machine is not None and not is_python(arguments.script):
        return usage("--machine is for Python files")
    options = target_options(arguments.option, target)
    if isinstance(options, int):
        return options
    for name in target.file_options & options.keys():
        text = _text_of(options[name])
        if text is None:
            return usage(f"--option {name}: the file {options[name]} cannot be read")
        options[name] = text
    try:
        with limited_memory(arguments.memory_limit), limited_time(arguments.time_limit):
            if is_python(arguments.script):
                return _put_pictures(target, options, arguments)
            analysis = analyse_script(arguments.script, arguments.scripts, arguments.templates)
            levels = _levels(arguments.script, arguments.output)
            files, report = compile_files(analysis, target, options, levels)
    except MachineError as error:
        return usage(str(error), error.word, error.known)
    except OptionError as error:
        return usage(f"--option {error}")
    except CpuTimeError as error:
        print(error, file=sys.stderr)
        return FINDINGS
    print_report(without_notes(report), arguments, sys.stderr)
    return _put(files, arguments) if files else FINDINGS


def _put_pictures(target: Target, options: Mapping[str, str], arguments: Namespace) -> int:
    """Put the pictures of the machines in a Python file, also of those with errors; the exit code.
    Raises MachineError and OptionError."""
    from smachac.diagnostics.diagnostic import has_errors, in_order
    from smachac.driver import CODES, draw, without_class_errors
    from smachac.frontend.files import Disk, disk_library

    disk = Disk()
    analyses = named_analyses(arguments.script, disk, arguments.machine)
    printed = str(arguments.output) == "-"
    if printed and len(analyses) > 1:
        raise MachineError("-o - prints one machine: use --machine NAME", "", tuple(analyses))
    library = disk_library(arguments.script, [], disk=disk, codes=CODES)
    files: Files = {}
    for analysis in analyses.values():
        if analysis.machine is not None:
            files |= draw(analysis.machine, target, library, options, analysis.report)
    every = in_order(item for analysis in analyses.values() for item in analysis.report)
    report = without_class_errors(every)
    print_report(without_notes(report), arguments, sys.stderr)
    code = _put(files, arguments) if files else FINDINGS
    return FINDINGS if has_errors(report) else code


def _text_of(name: str) -> str | None:
    """The text of a file; None if it cannot be read."""
    from smachac.frontend.files import read_source

    source = read_source(as_path(name), [])
    return None if source is None else source.text


def _levels(script: Path, output: Path) -> int:
    """The number of folders from that of the script down to the output; 0 if it is elsewhere."""
    from pathlib import Path

    folder, target = Path(os.path.realpath(script.parent)), Path(os.path.realpath(output))
    if str(output) == "-" or not target.is_relative_to(folder):
        return 0
    return len(target.relative_to(folder).parts)


def _put(files: Files, arguments: Namespace) -> int:
    """Print files, compare them with those on disk, or write them; the exit code."""
    from smachac.commands.files import changed_files, foreign_files, write_files
    from smachac.commands.writing import PartlyWrittenError

    folder: Path = arguments.output
    if str(folder) == "-":
        sys.stdout.write(next(iter(files.values())))
        return OK
    if arguments.check:
        changed = changed_files(folder, files)
        for path in changed:
            print(f"{shown(path)} is not up to date: run `smachac build` again")
        return FINDINGS if changed else OK
    foreign = [] if arguments.force else foreign_files(folder, files)
    if foreign:
        for path in foreign:
            what = "is a link" if path.is_symlink() else "was not generated by smachac"
            print(f"{shown(path)} {what}; --force overwrites it", file=sys.stderr)
        return FINDINGS
    try:
        written = write_files(folder, files)
    except (OSError, PartlyWrittenError) as error:
        words = getattr(error, "strerror", None) or error
        print(f"cannot write to {shown(folder)}: {words}", file=sys.stderr)
        return FINDINGS
    for path in written if not arguments.quiet else ():
        print(f"wrote {shown(path)}")
    return OK
