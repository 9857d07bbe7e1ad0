"""Findings about the operands of an expression: units, comparisons, origins of the values."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.analysis.context import Context
from smachac.analysis.expression_errors import Fault, FaultKind
from smachac.analysis.expression_sites import ExpressionSite
from smachac.analysis.units import conversion
from smachac.checks.findings.help_text import calls, did_you_mean, in_quotes_for, other_place
from smachac.checks.findings.type_origins import written
from smachac.checks.findings.value_places import place_of_fault
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.source import Word
from smachac.diagnostics.spelling import guesser, respelt
from smachac.ir.expressions import print_expression
from smachac.ir.nodes import Leaf, is_number
from smachac.records import replace

MOST_SOURCES = 3
"""Limit on the origins of values that a finding shows."""


def mixed_units(context: Context) -> Iterator[Finding]:
    """The operations on numbers with different units (SM504)."""
    for site, fault in faults_of(context, "unit"):
        finding = fault_finding(site, fault, f"in {code_owner(site)}, {fault.what}")
        value = _in_other_unit(site, fault)
        yield replace(finding, help=f"{finding.help}, {value}") if value else finding


def doubtful_comparisons(context: Context) -> Iterator[Finding]:
    """The comparisons of values in radians with numbers that seem to be in degrees (SM522)."""
    for site, fault in faults_of(context, "doubt"):
        yield fault_finding(site, fault, f"in {code_owner(site)}, {fault.what}")


def _in_other_unit(site: ExpressionSite, fault: Fault) -> str:
    """The end of the help for a number in another unit: the initial value of its key in the right
    one; empty if it has not one value in the script."""
    text, given, wanted = fault.units or ("", "", "")
    factor = conversion(given, wanted)
    for key in fault.keys:
        cell = site.cells.get(key)
        flows = cell.flows.values() if cell is not None else ()
        origins = list(dict.fromkeys(alike[0].origin.cell for alike in flows))
        factor = conversion(given, wanted)
        if factor is None or text != f"ud.{key}" or len(origins) != 1:
            continue
        node, name = origins[0].node, origins[0].key
        if node is None or isinstance(node, Leaf):
            continue
        for preset in node.userdata:
            if preset.key == name and is_number(preset.value.data) and preset.type.args == (given,):
                number = f"{preset.value.data * factor:.6g}"
                new = f"{{type: {preset.type.name}<{wanted}>, value: {number}}}"
                return f"or write `{name}: {new}` in the `userdata` of `{node.name}`"
    return ""


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
