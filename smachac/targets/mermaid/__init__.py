"""Mermaid: the state diagram of a machine for Markdown pages, such as READMEs and pull requests."""

from __future__ import annotations

from smachac.diagnostics.diagnostic import Report
from smachac.ir.nodes import Checked
from smachac.targets import (
    DEPTH,
    GENERATED,
    BuildContext,
    Files,
    OptionError,
    Target,
    levels_open,
    made_by,
    stem,
    view_of,
)
from smachac.targets.mermaid.diagram import diagram

DIRECTIONS = ("TB", "LR", "BT", "RL")


def emit(machine: Checked, context: BuildContext, report: Report) -> Files:
    """One Mermaid file, named after the machine.

    Raises OptionError for an invalid value of an option.
    """
    view = view_of(machine, context.options)
    depth = levels_open(context.options, view)
    direction = context.options.get("direction", "TB")
    if direction not in DIRECTIONS:
        raise OptionError(f"`direction` must be one of {', '.join(DIRECTIONS)}, not `{direction}`")
    lines = diagram(machine, view, depth=depth, direction=direction)
    return {f"{stem(machine)}.mmd": "\n".join([f"%% {made_by(machine)}", *lines, ""])}


TARGET = Target(
    name="mermaid",
    description="a picture for Markdown pages",
    emit=emit,
    is_picture=True,
    options={
        "depth": DEPTH,
        "generated": GENERATED,
        "direction": "where the picture runs to: TB (down, the default), LR, BT or RL",
    },
)
