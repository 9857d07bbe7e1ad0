"""Findings about the code of a state: the owner of the code in a message, the faults of its
expressions with the origins of the values."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from smachac.analysis.code_slots import CodeSlot
from smachac.analysis.context import Context
from smachac.analysis.expression_errors import Fault, FaultKind
from smachac.analysis.expression_sites import ExpressionSite
from smachac.checks.findings.help_text import calls, did_you_mean, in_quotes_for, other_place
from smachac.checks.findings.type_origins import written
from smachac.checks.findings.value_places import place_of_fault
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.source import Word
from smachac.diagnostics.spelling import guesser, respelt
from smachac.ir.expressions import print_expression
from smachac.ir.nodes import Node

MOST_SOURCES = 3
"""Limit on the origins of values that a finding shows."""


def readable_slots(context: Context) -> Iterator[tuple[str, Node, CodeSlot, ast.expr]]:
    """The code slots of a machine whose code Python can read."""
    for path, node, slot in context.code_slots:
        tree = slot.tree
        if tree is not None:
            yield path, node, slot, tree


def slot_owner(slot: CodeSlot, node: Node) -> str:
    """The place of a slot, as part of a message."""
    match slot.role:
        case "callbacks":
            return f"the callback `{slot.name}` of `{node.name}`"
        case "conditions":
            return f"the condition `{slot.name}` of `{node.name}`"
    return f"`{slot.name}` of `{node.name}`"


def faults_of(context: Context, kind: FaultKind) -> Iterator[tuple[ExpressionSite, Fault]]:
    """The faults of one kind in the expressions of a machine, each with its expression."""
    return ((site, fault) for site, fault in context.expression_faults if fault.kind == kind)


def code_owner(site: ExpressionSite) -> str:
    """The state whose code an expression is, in a message."""
    return f"the code of `{site.node.name}`"


def fault_finding(
    site: ExpressionSite, fault: Fault, message: str, severity: Severity | None = None
) -> Finding:
    """The finding on a fault, with its place, its help and the origins of the values."""
    guess = did_you_mean(guesser(fault.choices)(fault.word)) if fault.choices else None
    choices = f"use one of {', '.join(f'`{choice}`' for choice in fault.choices)}"
    span = site.expression.span
    if fault.entry:
        guess = f"write `{in_quotes_for(fault.entry, span)}` for the entry of the mapping"
    place = place_of_fault(site.expression, fault)
    return Finding(
        span=place,
        message=message,
        arguments=(print_expression(fault.expr),),
        help=guess or (choices if fault.choices else fault.help),
        related=(*_sources(site, fault), *calls(site.node, span)),
        node=site.path,
        severity=severity,
        effect=fault.effect,
        edits=respelt(Word(fault.word, place), guesser(fault.choices).unique_match(fault.word)),
    )


def _sources(site: ExpressionSite, fault: Fault) -> Iterator[Related]:
    """The origins of the values of the keys."""
    shown = {site.expression.span}
    for key in fault.keys:
        cell = site.cells.get(key)
        for alike in cell.flows.values() if cell is not None else ():
            origin = alike[0].origin
            if not alike[0].judged and origin.span not in shown and len(shown) <= MOST_SOURCES:
                shown.add(origin.span)
                yield from other_place(origin.span, written(origin))
