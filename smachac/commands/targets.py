"""The command `targets`: list the targets, their options and what they lack."""

from __future__ import annotations

import argparse
from argparse import Namespace

from smachac.commands.output import OK

EXAMPLES = """\
examples:
  smachac targets                                        the targets, their options, what they lack
  smachac build main.yml --target dot --option depth=1   use a target and one of its options

exit codes: 0 success, 2 wrong usage, 70 a bug in smachac
"""


def targets_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EXAMPLES


def targets_command(arguments: Namespace) -> int:
    """Print the targets; the exit code."""
    from smachac.targets import load_target, target_names

    for name in target_names():
        target = load_target(name)
        assert target is not None
        print(f"{name:<10} {target.description}")
        for option, text in target.options.items():
            print(f"{'':<10}   --option {option}=...  {text}")
        for part in target.lacks:
            print(f"{'':<10}   lacks {part}")
    return OK
