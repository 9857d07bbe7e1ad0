"""The simulated world: whether a program runs in it, and when its bodies and frames are loaded."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from smachac.analysis.context import Context
from smachac.analysis.type_inference import Cell, TypeFlow
from smachac.checks.findings.help_text import other_place
from smachac.checks.findings.literals import literal_finding, reader
from smachac.checks.findings.value_places import Part
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.records import replace


def loaded_too_late(
    context: Context,
    flow: TypeFlow,
    name: str,
    what: Literal["frame", "body"],
    otherwise: str,
    *,
    part: Part,
) -> Iterator[Finding]:
    """The finding for a body, or its frame, that is loaded only after the state of a literal that
    names it. `otherwise` is the help if that state itself loads the body; `part`: that of the
    literal with the name."""
    path = context.loading_order.loaded_later(flow.cell.path, name)
    if path is None:
        return
    later = context.routes.nodes[path]
    when, help = f"{reader(flow)} itself loads it", otherwise
    if later is not flow.cell.node:
        when = f"{reader(flow)}: `{later.name}` loads it later"
        help = f"run `{later.name}` before {reader(flow)}: the {what} exists only after it"
    missing = "the simulation has no frame" if what == "frame" else "there is no body"
    finding = literal_finding(
        flow,
        f"{missing} `{name}` before {when}",
        help,
        (name,),
        part=part,
        more=other_place(later.span, f"`{name}` is loaded here"),
    )
    yield replace(finding, severity=Severity.ERROR)


def uses_simulation(context: Context, cell: Cell) -> bool:
    """Whether the state of a cell uses the simulated world."""
    known = context.machine.state_types.get(cell.node.type) if cell.node is not None else None
    return known is not None and known.simulation


def is_simulated(context: Context) -> bool:
    """Whether the program runs in the simulated world."""
    base = context.machine.state_types.get(context.machine.base)
    return base is not None and base.simulation
