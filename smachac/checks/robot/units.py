"""Units in the code of states: operands, comparisons and results in another unit than is meant."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from smachac.analysis.context import Context
from smachac.analysis.expression_errors import Fault
from smachac.analysis.expression_sites import ExpressionSite
from smachac.analysis.expression_types import type_of_call
from smachac.analysis.type_lattice import unit_of
from smachac.analysis.units import conversion
from smachac.checks.findings.code_findings import (
    code_owner,
    fault_finding,
    faults_of,
    readable_slots,
    slot_owner,
)
from smachac.checks.findings.help_text import calls
from smachac.diagnostics.diagnostic import Finding
from smachac.ir.code_places import node_place
from smachac.ir.nodes import Leaf, is_number
from smachac.records import replace


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


def wrong_units(context: Context) -> Iterator[Finding]:
    """The functions of a state whose result has another unit than the variable (SM504)."""
    types = context.machine.state_types
    for path, node, slot, tree in readable_slots(context):
        fact = types[node.type].variables.get(slot.name) if node.type in types else None
        wanted = unit_of(fact.type) if fact is not None else ""
        if not wanted or not isinstance(node, Leaf) or not isinstance(tree, ast.Lambda):
            continue
        given = unit_of(type_of_call(slot.code, context.types.names(path, node)))
        factor = conversion(given, wanted)
        if not given or given == wanted:
            continue
        body = ast.unparse(tree.body)
        simple = isinstance(tree.body, ast.Attribute | ast.Call | ast.Name | ast.Subscript)
        product = f"{body if simple else f'({body})'} * {factor:.6g}" if factor else ""
        yield Finding(
            span=node_place(slot.code, tree.body),
            message=f"{slot_owner(slot, node)} is in `{wanted}`, but its function returns a number"
            f" in `{given}`",
            arguments=(slot.name, given, wanted),
            help=f"write `{product}`" if product else f"return a number in `{wanted}`",
            related=calls(node, slot.code.span),
            node=path,
        )
