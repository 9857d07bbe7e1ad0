"""The manual page smachac(1), made of the parsers of the commands: docs/smachac.1, in roff.

`make golden` writes it; the wheel installs it as share/man/man1/smachac.1.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator

from smachac.commands.cli import COMMANDS, EPILOG, command_line
from smachac.version import __version__

ENVIRONMENT = (
    ("NO_COLOR", "No colours in reports."),
    ("FORCE_COLOR", "Colours in reports also where the output is no terminal."),
    ("FORCE_HYPERLINK", "1: places of findings are links on any terminal. 0: on none."),
    ("COLUMNS", "The width of the terminal."),
)


def render_manual() -> str:
    """The page in roff; the same for every version of Python and width of the terminal."""
    return "".join(f"{line}\n" for line in _page(command_line(*COMMANDS)))


def _page(parser: argparse.ArgumentParser) -> Iterator[str]:
    (commands,) = (item for item in parser._actions if isinstance(item, argparse._SubParsersAction))
    yield f'.TH SMACHAC 1 "" "smachac {_escaped(__version__)}" "User Commands"'
    yield ".SH NAME"
    yield r"smachac \- compiler and checker for task state machines of robots"
    yield ".SH SYNOPSIS"
    yield r"\fBsmachac\fR \fICOMMAND\fR [\fIarguments\fR]"
    yield ".SH DESCRIPTION"
    yield _escaped(parser.description or "")
    for name, (_, text) in COMMANDS.items():
        yield from (".TP", rf"\fB{_escaped(name)}\fR", _escaped(f"{text[0].upper()}{text[1:]}."))
    yield ".SH COMMANDS"
    for name, inner in commands.choices.items():
        yield f".SS smachac {_escaped(name)}"
        yield _escaped(inner.description or "")
        for action in inner._actions:
            if not isinstance(action, argparse._HelpAction):
                yield from _argument(action, inner)
        yield from _examples(inner.epilog or "")
    yield ".SH ENVIRONMENT"
    for variable, effect in ENVIRONMENT:
        yield from (".TP", rf"\fB{_escaped(variable)}\fR", _escaped(effect))
    yield ".SH EXIT STATUS"
    yield _escaped(" ".join(EPILOG.partition("exit codes: ")[2].split()))
    yield ".SH SEE ALSO"
    yield r"The tutorial and the reference: the folder docs of the repository, or \fBmake docs\fR."


def _argument(action: argparse.Action, parser: argparse.ArgumentParser) -> Iterator[str]:
    """An option or a positional argument, and its help."""
    metavar = action.metavar or (action.option_strings and action.dest.upper()) or action.dest
    value = metavar if isinstance(metavar, str) else " ".join(metavar)
    if action.choices and action.metavar is None:
        value = ", ".join(map(str, action.choices)) if action.option_strings else value
    names = ", ".join(rf"\fB{_escaped(name)}\fR" for name in action.option_strings)
    takes = action.nargs != 0
    yield ".TP"
    yield " ".join(filter(None, [names, rf"\fI{_escaped(value)}\fR" if takes else ""]))
    values = {**vars(action), "prog": parser.prog}
    yield _escaped((action.help or "") % values)


def _examples(text: str) -> Iterator[str]:
    """The examples of a command as they are; its exit codes are those of all commands."""
    lines = text.partition("\nexit codes:")[0].strip("\n").split("\n")
    yield from (".PP", ".nf", *map(_escaped, lines), ".fi")


def _escaped(text: str) -> str:
    """A text in roff: no character of it is a request, a font or a typographic hyphen."""
    text = text.replace("\\", r"\e").replace("-", r"\-")
    return rf"\&{text}" if text.startswith((".", "'")) else text
