"""The command line: finds the module of a command, runs it, and turns exceptions into exit codes.

The module of a command has two functions, `NAME_arguments(parser)` and `NAME_command(arguments)`.
Only the module of the named command is imported, and its functions import what they use, so that
`--version` and every `--help` are fast. This module itself imports only what the interpreter has
already loaded: all else is imported inside `main`, where Ctrl-C is handled.
"""

from __future__ import annotations

import gc
import sys

from smachac.version import __version__

TYPE_CHECKING = False  # typing costs more than the rest of `smachac --help`
if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterable, Sequence
    from typing import Any, NoReturn

FAILED, BUG, INTERRUPTED, UNREAD = 1, 70, 130, 141
"""Exit codes: a failure; an exception that is a bug of smachac; Ctrl-C; the reader of standard
output ended before all was printed (128 + SIGPIPE, as of programs that this signal ends)."""

COMMANDS = {
    "check": ("check", "find the errors in scripts"),
    "build": ("build", "generate code from a script"),
    "run": ("run", "run a script on the simulated arm or with mock states"),
    "sweep": ("sweep", "run a script many times: success rates, failures, coverage"),
    "view": ("view", "show a script, a run or a trace in a browser"),
    "verify": ("verify", "compare the generated code with the script, path by path"),
    "trace": ("trace", "compare recorded traces with a script"),
    "stats": ("trace", "predict outcomes and costly failures from recorded traces"),
    "diff": ("diff", "compare two scripts, or two git revisions"),
    "explain": ("explain", "explain a code, or a state, a key or the failures of a script"),
    "new": ("new", "create a project or a state type"),
    "states": ("states", "list the state types, or describe one"),
    "fmt": ("fmt", "format scripts"),
    "contain": ("refactor", "move states into a new container"),
    "extract": ("refactor", "move a container into a new sub-script"),
    "inline": ("refactor", "replace the call of a sub-script by its content"),
    "rename": ("refactor", "rename a state, an outcome or a key everywhere"),
    "edit": ("refactor", "change a transition, add or remove a state"),
    "import": ("import_python", "make scripts of machines in Python, SCXML or YASMIN XML"),
    "migrate": ("migrate", "report what to change in SMACHA scripts and templates"),
    "targets": ("targets", "list the targets and their options"),
    "completion": ("completion", "print the completion of commands for a shell"),
    "doctor": ("doctor", "list what is installed and what is missing"),
    "docs": ("docs", "print a page of the documentation"),
    "schema": ("schema", "print the JSON Schema of a kind of file"),
    "lsp": ("lsp", "serve an editor (language server)"),
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

`smachac COMMAND --help` shows the options of a command, `man smachac` those of all.
`smachac docs tutorial` prints the tutorial, `smachac docs` lists the pages of the reference.

exit codes: 0 success, 1 findings or failure, 2 wrong usage, 70 a bug in smachac,
130 interrupted, 141 the reader of the output ended early
"""


FIRST_STEPS = """\
There is no script in this folder or below.

smachac new my_robot       create a project with a script that can be checked and run
smachac check machine.py   find the errors in a machine in Python for SMACH, YASMIN or FlexBE
smachac --help             all commands, with examples"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; the exit code. Without `arguments` this is the whole program, whose
    arguments are in sys.argv."""
    collecting = gc.isenabled()
    try:
        return _whole_program() if arguments is None else _guarded(arguments)
    except KeyboardInterrupt:
        from smachac.runtime.signals import exit_code

        print("interrupted", file=sys.stderr, flush=True)
        return exit_code(INTERRUPTED)
    finally:
        if collecting and arguments is not None:  # the process of the caller goes on
            gc.enable()


def _whole_program() -> int:
    """Run the command in sys.argv; the exit code, also if standard output did not accept all."""
    from smachac.commands.interrupts import end_at_interrupts
    from smachac.commands.streams import open_streams, print_failure

    end_at_interrupts()
    open_streams()
    try:
        code = _guarded(sys.argv[1:])
    except SystemExit as ended:  # argparse ends so after --help and after wrong usage
        code = int(ended.code or 0)
    if not gc.isenabled():
        gc.freeze()  # the process ends: nothing is collected once more, which takes 0.1 s
    sys.stdout.flush()
    error = print_failure()
    if error is None:
        return code
    if isinstance(error, BrokenPipeError):  # the reader, such as `head`, needs no more
        return code or UNREAD
    print(f"cannot print: {error.strerror}", file=sys.stderr)
    return code or FAILED


def _guarded(words: Sequence[str]) -> int:
    """Run a command; the exit code. An exception that gets here is a bug of smachac."""
    from smachac.commands.streams import escape_unknown_characters

    escape_unknown_characters()
    gc.disable()  # the objects of a compiler live to its end; collection costs a third of the time
    try:
        return _run(words)
    except MemoryError:
        print("there is not enough memory", file=sys.stderr, flush=True)
        return FAILED
    except Exception as error:
        if isinstance(error, ImportError) and _is_required(error.name or ""):
            print(f"a package that smachac requires is missing or broken: {error};"
                  " `smachac doctor` lists them", file=sys.stderr)  # fmt: skip
            return FAILED
        import traceback

        traceback.print_exc()
        print(f"\nsmachac {__version__}: this is a bug in smachac, please report it with the"
              " lines above and the script", file=sys.stderr)  # fmt: skip
        return BUG


def _first_step() -> int:
    """Print what to do first in the current folder; the exit code."""
    from pathlib import Path

    from smachac.commands.output import USAGE
    from smachac.frontend.discovery import NothingFoundError, scripts_of
    from smachac.frontend.files import Disk

    try:
        scripts_of([Path()], Disk())
    except NothingFoundError:
        print(FIRST_STEPS, file=sys.stderr)
    else:
        print("smachac check     find the errors in the scripts below this folder\n"
              "smachac --help    all commands, with examples", file=sys.stderr)  # fmt: skip
    return USAGE


def _is_required(module: str) -> bool:
    """Whether a module belongs to a package that smachac requires."""
    from smachac.commands.doctor import MODULES

    package = module.partition(".")[0]
    return any(name.partition(".")[0] == package for name, *_, required in MODULES if required)


def _run(words: Sequence[str]) -> int:
    if not words:
        return _first_step()
    given, unknown = _command_line_for(words).parse_known_args(words)
    if unknown:
        given.parser.error(f"unrecognized arguments: {' '.join(unknown)}")
    command = _function(given.command, "command")
    path = getattr(given, "report_file", None)
    if path is not None and str(path) != "-":
        from smachac.commands.report_file import to_file

        return to_file(path, lambda: command(given))
    code: int = command(given)
    return code


def _parser_class() -> type[argparse.ArgumentParser]:
    """The class of the parsers. argparse is imported late."""
    import argparse

    class Parser(argparse.ArgumentParser):
        """A parser whose messages name the known word that is nearest to an unknown one, and quote
        words that shells make of file names."""

        given: Sequence[str] = ()
        """The words that the parser reads."""

        @property
        def positionals(self) -> list[argparse.Action]:
            """The arguments that are no options, in their order."""
            return self._get_positional_actions()

        def error(self, message: str) -> NoReturn:
            from smachac.report.terminal import on_one_line

            super().error(on_one_line(message))

        def parse_known_args(  # pyright: ignore[reportIncompatibleMethodOverride]
            self, args: Any = None, namespace: Any = None
        ) -> Any:
            """Reports an unknown option before the arguments that are then missing."""
            self.given = args
            for word in args:
                name = word.partition("=")[0]
                action = self._option_string_actions.get(name)
                is_last = word == "--" or (
                    action is not None and action.nargs == argparse.REMAINDER
                )
                if is_last or (self.prog == "smachac" and word in COMMANDS):
                    break
                known = any(option.startswith(name) for option in self._option_string_actions)
                if word.startswith("--") and not known:
                    near = _near(name, self._option_string_actions)
                    self.error(f"unrecognized arguments: {name}{near}")
            return super().parse_known_args(args, namespace)

        def _check_value(self, action: argparse.Action, value: Any) -> None:
            if action.choices is not None and value not in action.choices:
                near = _near(str(value), map(str, action.choices)) or self._right_order()
                if near:
                    raise argparse.ArgumentError(action, f"invalid choice: {value!r}{near}")
            super()._check_value(action, value)

        def _right_order(self) -> str:
            """The end of a message that shows the words in another order; empty without one."""
            from smachac.commands.swapped import command_text, in_right_order

            options = any(word.startswith("-") for word in self.given)
            words = None if options else in_right_order(self.positionals, self.given)
            command = self.prog.split()[1:]
            return f"; write `{command_text([*command, *words])}`" if words is not None else ""

    return Parser


def _command_line_for(words: Sequence[str]) -> argparse.ArgumentParser:
    """The parser of these words. Where a command is first, no other one can be named in an answer:
    the parsers of all commands take 5 ms."""
    if words[0] in COMMANDS:
        return command_line(words[0], among=words[:1])
    return command_line(next((word for word in words if word in COMMANDS), ""))


def command_line(*complete: str, among: Iterable[str] = COMMANDS) -> argparse.ArgumentParser:
    """The parser of the commands `among`; only those of `complete` have their arguments."""
    parser = _parser_class()(
        prog="smachac",
        description="Checks robot task state machines in YAML and generates code from them.",
        epilog=EPILOG,
        formatter_class=_formatter,
    )
    parser.add_argument("--version", action="version", version=f"smachac {__version__}")
    parsers = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name in among:
        _, text = COMMANDS[name]
        about = f"{text[0].upper()}{text[1:]}."
        inner = parsers.add_parser(name, help=text, description=about, formatter_class=_formatter)
        inner.set_defaults(parser=inner)
        if name in complete:
            _function(name, "arguments")(inner)
    return parser


def _near(word: str, known: Iterable[str]) -> str:
    """The end of a message that names the known word nearest to an unknown one; empty if none is
    near."""
    from smachac.diagnostics.diagnostic import did_you_mean

    help = did_you_mean(word, known)
    return f"; {help}" if help is not None else ""


def _function(command: str, part: str) -> Any:
    """The function `COMMAND_arguments` or `COMMAND_command` of the module of a command."""
    from importlib import import_module

    module = import_module(f"smachac.commands.{COMMANDS[command][0]}")
    return getattr(module, f"{command}_{part}")


def _formatter(prog: str) -> argparse.HelpFormatter:
    """Argparse's formatter with a given width: to find the width, argparse would import shutil."""
    import argparse

    from smachac.commands.terminal import terminal_width

    columns = terminal_width(sys.stdout)
    return argparse.RawDescriptionHelpFormatter(prog, width=max(columns - 2, 40))
