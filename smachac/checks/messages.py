"""Parts of findings that many rules share: help lines, and the calls of sub-scripts."""

from __future__ import annotations

from itertools import takewhile

from smachac.diagnostics.diagnostic import Related
from smachac.diagnostics.source import NOWHERE, Span
from smachac.ir.nodes import Node

CALLED_HERE = "in the sub-script called here"


def did_you_mean(name: str | None) -> str | None:
    """The help line for a guess."""
    return f"did you mean `{name}`?" if name else None


def calls(node: Node, span: Span) -> tuple[Related, ...]:
    """The calls of sub-scripts that lead to the file of `span`, outermost first."""
    outside = takewhile(lambda call: call.source is not span.source, node.via)
    return tuple(Related(span=call, message=CALLED_HERE) for call in outside)


def other_place(span: Span, message: str) -> tuple[Related, ...]:
    """A related place, if there is one."""
    return () if span.source is NOWHERE.source else (Related(span=span, message=message),)


def own_name(node: Node, span: Span) -> str:
    """The name of a state as an argument of a finding at `span`; empty where a call of a sub-script
    in another file gives the name."""
    return node.name if node.span.source is span.source else ""
