"""Findings about literals: their place, also in the call of a sub-script, and their reader."""

from __future__ import annotations

from smachac.analysis.type_inference import TypeFlow
from smachac.checks.help_text import calls, other_place
from smachac.checks.types.value_places import place_of_part
from smachac.diagnostics.diagnostic import Finding, Related, Severity


def at(
    flow: TypeFlow,
    message: str,
    help: str | None,
    names: tuple[str, ...] = (),
    more: tuple[Related, ...] = (),
    severity: Severity | None = None,
    part: tuple[int | str, ...] = (),
    key: bool = False,
    effect: str | None = None,
) -> Finding:
    """A finding at a literal, with the place where it is read; its arguments are the key of the
    literal and `names`. `part` are the steps to a part of the literal, `key` means its key."""
    origin, cell = flow.origin, flow.cell
    span = place_of_part(origin.span, part, key=key)
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
        severity=severity,
        node=origin.cell.path,
        effect=effect,
    )


def reader(flow: TypeFlow) -> str:
    """The state that reads a literal, in a message."""
    return f"`{flow.cell.node.name}`" if flow.cell.node is not None else "the base"
