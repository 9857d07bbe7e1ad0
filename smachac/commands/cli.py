"""The command line: arguments, and what becomes of exceptions."""

from __future__ import annotations

import argparse
import gc
import os
import sys

from smachac.commands import arguments
from smachac.commands.arguments import colour, path, search_folders
from smachac.version import __version__

TYPE_CHECKING = False  # typing and pathlib cost more than all the rest of `smachac --help`
if TYPE_CHECKING:
    from collections.abc import Sequence

BUG, INTERRUPTED = 70, 130
"""Exit codes beside those of verbs.py: our fault; Ctrl-C."""

CHECK_EXAMPLES = """\
examples:
  smachac check                                  every script below this folder
  smachac check main.yml --format sarif          for code scanning
  smachac check . --select SM3,SM4 --strict      data and concurrences alone; warnings fail
  smachac check . --changed-since origin/main    what a pull request touches
  smachac check . --baseline known.json --write-baseline   begin in an old code base
  smachac check . --fix --diff                   what --fix would write, as a patch
  smachac check main.yml --sim                   ask the simulated arm what it can reach
  smachac check main.yml --watch                 again at every change

exit codes: 0 clean, 1 findings, 2 wrong usage, 70 a bug in smachac
"""

EXPLAIN_EXAMPLES = """\
examples:
  smachac explain SM201                          what a code means
  smachac explain main.yml grasp_pose            a key: who sets, reads, passes it on; where unset
  smachac explain main.yml PICK/GRASP            a state, by its path or the end of it
  smachac explain main.yml --failures            what becomes of every failure
  smachac explain main.yml --failures --format csv > failures.csv

exit codes: 0 explained, 1 unreadable script, 2 wrong usage or no such name, 70 a bug in smachac
"""

VERIFY_EXAMPLES = """\
examples:
  smachac verify main.yml                        does the generated Python do what the script says?
  smachac verify main.yml --targets python,cpp   and the generated C++ (wants a compiler)
  smachac verify main.yml --paths 2000           on more paths
  smachac verify main.yml --seed 7               on other random paths
  smachac verify main.yml --format json          for programs, with every transition not taken

exit codes: 0 the same, 1 something differs, the script has an error or a target cannot be played,
2 wrong usage, 70 a bug in smachac, 130 interrupted
"""

FORMATS = ("text", "json", "sarif", "github", "junit")

EPILOG = """\
examples:
  smachac check main.yml                     what is wrong with a script
  smachac build main.yml --target python     print it as Python for SMACH
  smachac run main.yml --record film.gif     run it on the simulated arm
  smachac run main.yml --mock scenario.yml   run it without robot or simulation
  smachac verify main.yml                    does the program do what the script says?
  smachac explain SM201                      what a code means, with examples
  smachac explain main.yml --failures        what becomes of every failure
  smachac fmt                                lay out every script here

exit codes: 0 clean, 1 findings, 2 wrong usage, 70 a bug in smachac
"""


def _names(text: str) -> list[str]:
    return [name.strip() for name in text.split(",") if name.strip()]


def _count(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"wants a number from 1, not `{text}`")
    return int(text)


def _formatter(prog: str) -> argparse.HelpFormatter:
    """Argparse's own, told the width: by itself it imports a quarter of its time to ask for it."""
    try:
        columns = int(os.environ.get("COLUMNS", "")) or 80
    except ValueError:
        try:
            columns = os.get_terminal_size().columns or 80
        except (OSError, ValueError):
            columns = 80
    return argparse.RawDescriptionHelpFormatter(prog, width=max(columns - 2, 40))


def _parser(given: Sequence[str]) -> argparse.ArgumentParser:
    """The parser for these words: only the command among them gets its arguments."""
    parser = argparse.ArgumentParser(
        prog="smachac",
        description="Compiles robot task state machines from YAML, and checks them.",
        epilog=EPILOG,
        formatter_class=_formatter,
    )
    parser.add_argument("--version", action="version", version=f"smachac {__version__}")
    verbs = parser.add_subparsers(dest="verb", metavar="COMMAND", required=True)
    for name, (text, add_arguments) in COMMANDS.items():
        about = f"{text[0].upper()}{text[1:]}."
        verb = verbs.add_parser(name, help=text, description=about, formatter_class=_formatter)
        if name in given:
            add_arguments(verb)
    return parser


def _check(verb: argparse.ArgumentParser) -> None:
    verb.epilog = CHECK_EXAMPLES
    verb.add_argument("script", nargs="*", type=path, default=None,
                      help="scripts, folders, patterns (default: this folder)")  # fmt: skip
    search_folders(verb)
    verb.add_argument("--format", choices=FORMATS, default="text", help="of the report")
    verb.add_argument("--strict", action="store_true", help="warnings fail as errors do")
    for name, what in (("select", "report these alone"), ("ignore", "leave these out")):
        verb.add_argument(f"--{name}", action="append", default=[], metavar="CODE[,CODE]",
                          help=f"{what}: codes, or beginnings such as SM2")  # fmt: skip
    verb.add_argument("--baseline", type=path, metavar="FILE", help="leave out what it knows")
    verb.add_argument("--write-baseline", action="store_true", help="make --baseline know all")
    verb.add_argument("--changed-since", metavar="REV",
                      help="only scripts made of files that changed since then (git)")  # fmt: skip
    verb.add_argument("--fix", action="store_true", help="mend what has one sure cure")
    verb.add_argument("--diff", action="store_true", help="show what --fix would do, write nothing")
    verb.add_argument("--sim", action="store_true", help="ask the simulated arm what it can reach")
    verb.add_argument("--watch", action="store_true", help="check again when a file changes")
    colour(verb)


def _build(verb: argparse.ArgumentParser) -> None:
    verb.add_argument("script", type=path, help="a script (.yml, .yaml)")
    verb.add_argument("--target", "-t", required=True, help="see `smachac targets`")
    verb.add_argument(
        "-o",
        "--output",
        type=path,
        default=".",
        metavar="DIR",
        help="where to write (default: here; `-` prints)",
    )
    verb.add_argument(
        "--option", action="append", default=[], metavar="NAME=VALUE", help="of the target"
    )
    verb.add_argument(
        "--check", action="store_true", help="write nothing; fail if a file is not up to date"
    )
    verb.add_argument(
        "--force", action="store_true", help="overwrite files that smachac did not write"
    )
    search_folders(verb)
    colour(verb)


def _run(verb: argparse.ArgumentParser) -> None:
    verb.add_argument("script", type=path, help="a script (.yml, .yaml)")
    verb.add_argument("--gui", action="store_true", help="show the simulation in a window")
    verb.add_argument("--record", type=path, metavar="FILE", help="film it: .gif or .mp4")
    verb.add_argument("--trace", type=path, metavar="FILE", help="write every event, JSON lines")
    verb.add_argument("--seed", type=int, default=0, help="of the simulated world (default 0)")
    verb.add_argument("--mock", type=path, metavar="FILE", help="play a scenario instead")
    verb.add_argument("--schedule", type=_names, metavar="A,B,...",
                      help="with --mock: whose turn it is among concurrent branches")  # fmt: skip
    verb.add_argument("--orders", type=_count, metavar="N",
                      help="with --mock: try N orders of the branches, fail on a race")  # fmt: skip
    verb.add_argument("--expect", metavar="OUTCOME", help="fail unless it ends with this outcome")
    verb.add_argument("--quiet", "-q", action="store_true", help="no progress, only the outcome")
    search_folders(verb)
    colour(verb)


def _explain(verb: argparse.ArgumentParser) -> None:
    verb.epilog = EXPLAIN_EXAMPLES
    verb.add_argument("words", nargs="*", metavar="CODE | SCRIPT [NAME]",
                      help="a code, or a script and a state or key of it")  # fmt: skip
    verb.add_argument("--all", action="store_true", help="every code, as Markdown")
    verb.add_argument("--failures", action="store_true", help="of a script: where failures lead")
    verb.add_argument("--format", choices=("text", "json", "md", "csv"), default="text",
                      help="md and csv for --failures alone")  # fmt: skip
    search_folders(verb)
    colour(verb)


def _verify(verb: argparse.ArgumentParser) -> None:
    verb.epilog = VERIFY_EXAMPLES
    verb.add_argument("script", type=path, help="a script (.yml, .yaml)")
    verb.add_argument("--targets", type=_names, default=["python"], metavar="A,B,...",
                      help="python, cpp: what to compare (default: python)")  # fmt: skip
    verb.add_argument("--paths", type=_count, metavar="N",
                      help="at most (default: 200, or what all transitions take)")  # fmt: skip
    verb.add_argument("--seed", type=int, default=0, help="of the random paths (default 0)")
    verb.add_argument("--format", choices=("text", "json"), default="text", help="of the report")
    search_folders(verb)
    colour(verb)


def _targets(verb: argparse.ArgumentParser) -> None:
    """It has no arguments."""


COMMANDS = {
    "check": ("judge scripts by every rule", _check),
    "build": ("print a script for a target", _build),
    "run": ("run a script: on the simulated arm, or with mock states", _run),
    "verify": ("compare what targets make of a script, path by path", _verify),
    "explain": ("what a code means, or a state, key or failure of a script", _explain),
    "new": ("begin a project, or a state type", arguments.new),
    "states": ("list the state types, or tell of one", arguments.states),
    "fmt": ("lay out scripts, with their comments", arguments.fmt),
    "contain": ("put states into a container of their own", arguments.contain),
    "extract": ("make a sub-script of a container", arguments.extract),
    "inline": ("put a sub-script in the place of its call", arguments.inline),
    "rename": ("give a state, outcome or key another name, everywhere", arguments.rename),
    "migrate": ("what becomes of SMACHA's scripts and templates", arguments.migrate),
    "targets": ("list what can be built", _targets),
}
"""Command to what it does and what adds its arguments."""

FUNCTIONS = {
    "verify": "verify.run_verify",
    **{name: f"refactor.run_{name}" for name in ("contain", "extract", "inline", "rename")},
}
"""Command to the function that runs it, where it is not `NAME.NAME`."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; the exit code. An exception that gets here is a bug of ours."""
    words = sys.argv[1:] if arguments is None else arguments
    given = _parser(words).parse_args(words)
    from importlib import import_module

    _never_fail_to_print()
    gc.disable()  # what a compiler makes lives to its end; collecting costs a third of the time
    try:
        module, _, function = FUNCTIONS.get(given.verb, f"{given.verb}.{given.verb}").partition(".")
        code: int = getattr(import_module(f"smachac.commands.{module}"), function)(given)
        sys.stdout.flush()
        return code
    except BrokenPipeError:  # the reader, such as `head`, has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return INTERRUPTED
    except Exception:
        import traceback

        traceback.print_exc()
        print(f"\nsmachac {__version__}: this is a bug in smachac, please report it with the"
              " lines above and the script", file=sys.stderr)  # fmt: skip
        return BUG


def _never_fail_to_print() -> None:
    """Streams that cannot show a character show an escape instead."""
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)
        if reconfigure is not None:
            reconfigure(errors="backslashreplace")
