"""The command line: finds the module of a command, runs it, and turns exceptions into exit codes.

The module of a command has two functions, `NAME_arguments(parser)` and `NAME_command(arguments)`.
Only the module of the named command is imported, and its functions import what they use, so that
`--version` and every `--help` are fast.
"""

from __future__ import annotations

import argparse
import errno
import gc
import os
import sys

from smachac.version import __version__

TYPE_CHECKING = False  # typing costs more than the rest of `smachac --help`
if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Any

BUG, INTERRUPTED = 70, 130
"""Exit codes beside those of output.py: an exception that is a bug of smachac; Ctrl-C."""

COMMANDS = {
    "check": ("check", "find the errors in scripts"),
    "build": ("build", "generate code from a script"),
    "run": ("run", "run a script on the simulated arm or with mock states"),
    "verify": ("verify", "compare the generated code with the script, path by path"),
    "explain": ("explain", "explain a code, or a state, a key or the failures of a script"),
    "new": ("new", "create a project or a state type"),
    "states": ("states", "list the state types, or describe one"),
    "fmt": ("fmt", "format scripts"),
    "contain": ("refactor", "move states into a new container"),
    "extract": ("refactor", "move a container into a new sub-script"),
    "inline": ("refactor", "replace the call of a sub-script by its content"),
    "rename": ("refactor", "rename a state, an outcome or a key everywhere"),
    "migrate": ("migrate", "report what to change in SMACHA scripts and templates"),
    "targets": ("targets", "list the targets and their options"),
}
"""Command to its module and to what it does."""

EPILOG = """\
examples:
  smachac check main.yml                     find the errors in a script
  smachac build main.yml --target python     generate Python for SMACH
  smachac run main.yml --record film.gif     run it on the simulated arm, make a film
  smachac run main.yml --mock scenario.yml   run it without a robot or a simulation
  smachac verify main.yml                    compare the generated code with the script
  smachac explain SM201                      explain a code, with examples
  smachac explain main.yml --failures        list where every failure leads
  smachac fmt                                format all scripts below the current folder

`smachac COMMAND --help` shows the options of a command.

exit codes: 0 success, 1 findings or failure, 2 wrong usage, 70 a bug in smachac,
130 interrupted
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; the exit code. An exception that gets here is a bug of smachac."""
    _never_fail_to_print()
    gc.disable()  # the objects of a compiler live to its end; collection costs a third of the time
    try:
        words = sys.argv[1:] if arguments is None else arguments
        command = next((word for word in words if word in COMMANDS), "")
        given, unknown = _parser(command).parse_known_args(words)
        if unknown:
            given.parser.error(f"unrecognized arguments: {' '.join(unknown)}")
        code: int = _function(given.command, "command")(given)
        sys.stdout.flush()
        return code
    except BrokenPipeError:  # the reader, such as `head`, needs no more
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr, flush=True)
        return INTERRUPTED
    except Exception as error:
        if (reason := _why_not_printed(error)) is not None:
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            print(f"cannot print: {reason}", file=sys.stderr)
            return 1
        import traceback

        traceback.print_exc()
        print(f"\nsmachac {__version__}: this is a bug in smachac, please report it with the"
              " lines above and the script", file=sys.stderr)  # fmt: skip
        return BUG


def _parser(command: str) -> argparse.ArgumentParser:
    """The parser of all commands; only `command` has its arguments."""
    parser = argparse.ArgumentParser(
        prog="smachac",
        description="Checks robot task state machines in YAML and generates code from them.",
        epilog=EPILOG,
        formatter_class=_formatter,
    )
    parser.add_argument("--version", action="version", version=f"smachac {__version__}")
    parsers = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name, (_, text) in COMMANDS.items():
        about = f"{text[0].upper()}{text[1:]}."
        inner = parsers.add_parser(name, help=text, description=about, formatter_class=_formatter)
        inner.set_defaults(parser=inner)
        if name == command:
            _function(name, "arguments")(inner)
    return parser


def _function(command: str, part: str) -> Any:
    """The function `COMMAND_arguments` or `COMMAND_command` of the module of a command."""
    from importlib import import_module

    module = import_module(f"smachac.commands.{COMMANDS[command][0]}")
    return getattr(module, f"{command}_{part}")


def _formatter(prog: str) -> argparse.HelpFormatter:
    """Argparse's formatter with a given width: to find the width, argparse would import shutil."""
    try:
        columns = int(os.environ.get("COLUMNS", "")) or 80
    except ValueError:
        try:
            columns = os.get_terminal_size().columns or 80
        except (OSError, ValueError):
            columns = 80
    return argparse.RawDescriptionHelpFormatter(prog, width=max(columns - 2, 40))


def _why_not_printed(error: Exception) -> str | None:
    """The reason why standard output accepts no more, such as a full disk; None for other errors.
    Such an error names no file, and the commands handle those of the files that they write."""
    if not isinstance(error, OSError) or error.filename is not None:
        return None
    full = error.errno in (errno.ENOSPC, errno.EIO, errno.EBADF, errno.EFBIG)
    return error.strerror if full else None


def _never_fail_to_print() -> None:
    """Streams that cannot show a character show an escape instead; closed ones drop the text."""
    if sys.stdout is None:
        sys.stdout = open(os.devnull, "w", encoding="utf-8")  # noqa: PTH123, SIM115
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: PTH123, SIM115
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)
        if reconfigure is not None:
            reconfigure(errors="backslashreplace")
