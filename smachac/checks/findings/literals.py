"""Findings about literals, for the rules on types, robots and messages: the place of a literal or
its part, also in the call of a sub-script, and the state that reads it."""

from __future__ import annotations

from smachac.analysis.type_inference import TypeFlow
from smachac.checks.findings.help_text import calls, other_place
from smachac.checks.findings.value_places import WHOLE, Part, place_of_part
from smachac.diagnostics.diagnostic import Finding, Related


def literal_finding(
    flow: TypeFlow,
    message: str,
    help: str | None,
    names: tuple[str, ...] = (),
    *,
    part: Part = WHOLE,
    more: tuple[Related, ...] = (),
) -> Finding:
    """A finding at a literal or its part, with the place where it is read, and `more` places; its
    arguments are the key of the literal and `names`."""
    origin, cell = flow.origin, flow.cell
    span = place_of_part(origin.span, part.steps, key=part.key)
    related: tuple[Related, ...] = ()
    if cell.span != origin.span and cell is not origin.cell:
        related = other_place(cell.span, f"{reader(flow)} reads it here as `{cell.key}`")
    node = origin.cell.node
    return Finding(
        span=span,
        message=message,
        arguments=(origin.cell.key, *names),
        help=help,
        related=(*related, *more, *(calls(node, span) if node is not None else ())),
        node=origin.cell.path,
    )


def reader(flow: TypeFlow) -> str:
    """The state that reads a literal, in a message."""
    return f"`{flow.cell.node.name}`" if flow.cell.node is not None else "the base"
