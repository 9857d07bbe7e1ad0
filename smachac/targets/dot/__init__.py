"""DOT: the graph of a machine for Graphviz."""

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
from smachac.targets.dot.graph import picture


def emit(machine: Checked, context: BuildContext, report: Report) -> Files:
    """One DOT file, named after the machine.

    Raises OptionError for an invalid value of an option.
    """
    view = view_of(machine, context.options)
    depth = levels_open(context.options, view)
    rankdir = direction_of(context.options, "rankdir")
    lines = picture(machine, view, depth=depth, rankdir=rankdir)
    return {f"{stem(machine)}.dot": "\n".join([f"// {made_by(machine)}", *lines, ""])}


TARGET = Target(
    name="dot",
    description="a picture for Graphviz",
    emit=emit,
    is_picture=True,
    options={
        "depth": DEPTH,
        "generated": GENERATED,
        "rankdir": DIRECTION,
    },
)
