"""Mermaid: the state diagram of a machine for Markdown pages, such as READMEs and pull requests."""

from __future__ import annotations

from smachac.diagnostics.diagnostic import Report
from smachac.ir.nodes import Checked
from smachac.targets import (
    DEPTH,
    DIRECTION,
    GENERATED,
    BuildContext,
    Files,
    Target,
    direction_of,
    levels_open,
    made_by,
    stem,
    view_of,
)
from smachac.targets.mermaid.diagram import diagram


def emit(machine: Checked, context: BuildContext, report: Report) -> Files:
    """One Mermaid file, named after the machine.

    Raises OptionError for an invalid value of an option.
    """
    view = view_of(machine, context.options)
    depth = levels_open(context.options, view)
    direction = direction_of(context.options, "direction")
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
        "direction": DIRECTION,
    },
)
