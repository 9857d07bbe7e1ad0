"""The command `targets`: the targets and their options."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from smachac.commands.output import OK

if TYPE_CHECKING:
    pass


def targets(arguments: argparse.Namespace) -> int:
    from smachac.targets import load_target, target_names

    for name in target_names():
        target = load_target(name)
        assert target is not None
        print(f"{name:<10} {target.description}")
        for option, text in target.options.items():
            print(f"{'':<10}   --option {option}=...  {text}")
    return OK
