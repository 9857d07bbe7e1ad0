"""The command `completion`: the completion of commands, options and files for a shell."""

from __future__ import annotations

import argparse
from argparse import Namespace

from smachac.commands.arguments import as_path
from smachac.commands.output import OK

EXAMPLES = """\
examples:
  smachac completion bash > ~/.local/share/bash-completion/completions/smachac
  smachac completion zsh > ~/.zfunc/_smachac        (with `fpath+=~/.zfunc` in ~/.zshrc)
  smachac completion fish > ~/.config/fish/completions/smachac.fish

exit codes: 0 success, 2 wrong usage, 70 a bug in smachac
"""

SHELLS = ("bash", "zsh", "fish")


def completion_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EXAMPLES
    parser.add_argument("shell", choices=SHELLS, help="the shell that reads the output")


def completion_command(arguments: Namespace) -> int:
    """Print the completion of a shell; the exit code."""
    import shtab

    from smachac.commands.cli import COMMANDS, command_line

    parser = command_line(*COMMANDS)
    for inner in (parser, *_commands(parser)):
        for action in inner._actions:
            if action.type is as_path:
                action.complete = shtab.FILE  # type: ignore[attr-defined]
    print(shtab.complete(parser, arguments.shell))
    return OK


def _commands(parser: argparse.ArgumentParser) -> list[argparse.ArgumentParser]:
    """The parsers of all commands."""
    (actions,) = (
        action for action in parser._actions if isinstance(action, argparse._SubParsersAction)
    )
    return list(actions.choices.values())
