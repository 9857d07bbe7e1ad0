"""Rules on the code in a script."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from smachac.analysis.context import Context
from smachac.analysis.expression_errors import Fault
from smachac.analysis.expression_sites import ExpressionSite
from smachac.checks.code.null_keys import null_keys
from smachac.checks.findings.class_value_types import (
    missing_choices,
    wrong_comparisons,
    wrong_operations,
    wrong_parts,
)
from smachac.checks.findings.code_findings import code_owner, fault_finding, faults_of
from smachac.checks.findings.help_text import calls
from smachac.checks.findings.value_places import place_of_part
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.diagnostics.repair import Edit
from smachac.diagnostics.spelling import in_quotes
from smachac.ir.code_places import node_range, place_in
from smachac.ir.code_slips import Slip, corrected, slips
from smachac.ir.leaf import functions
from smachac.ir.nodes import Data, Expression, Leaf, Node, Struct
from smachac.ir.script_code import script_code
from smachac.ir.traversal import expressions, values
from smachac.records import replace


@rule(
    "SM016",
    "bad-expression",
    Severity.ERROR,
    unsuppressible=True,
    effect="Python cannot start a program with this code, so no program is generated",
)
def bad_expression(context: Context) -> Iterator[Finding]:
    """Code in the script is not a valid expression, or there is no code where code is required.

    The generated program would not start, or would stop at the first visit of the state, with the
    robot in the middle of its task.

    Exactly: a list or mapping of YAML that Python reads as a comprehension, such as
    `[2 * n for n in range(3)]`, is a text in a list, and no code. It is reported if its element
    uses the variable of the loop, or if its items are the result of a call.

    Wrong:
        name: sm
        template: Base
        outcomes: [succeeded]
        userdata: {n: 0}
        states:
          - COUNT:
              template: CallbacksState
              input_keys: [n]
              output_keys: [n]
              callbacks: {n: 'lambda ud: ud.n +'}
              transitions: {succeeded: succeeded}

    Right:
        name: sm
        template: Base
        outcomes: [succeeded]
        userdata: {n: 0}
        states:
          - COUNT:
              template: CallbacksState
              input_keys: [n]
              output_keys: [n]
              callbacks: {n: 'lambda ud: ud.n + 1'}
              transitions: {succeeded: succeeded}
    """
    yield from context.at_states(_bad_expressions)


def _bad_expressions(path: str, node: Node) -> Iterator[Finding]:
    conditions = functions(node, "conditions") if isinstance(node, Leaf) else None
    compared = {code.span for code in (conditions or {}).values()}
    for expression in expressions(node):
        found = _slips(expression.text, expression.span in compared)
        for slip in found[:1]:
            yield Finding(
                span=place_in(expression, slip.start, slip.end),
                message=f"`{expression.text}` is not a valid expression: {slip.what}",
                arguments=(expression.text,),
                help=slip.help,
                related=calls(node, expression.span),
                node=path,
                edits=_cures(expression, found),
            )
    yield from _bare_comprehensions(path, node)
    if isinstance(node, Leaf):
        yield from _missing_code(node, path)


def _bare_comprehensions(path: str, node: Node) -> Iterator[Finding]:
    """The lists and mappings of YAML that are comprehensions in Python."""
    for value in values(node):
        data = value.data
        if isinstance(data, tuple | Struct) and _has_loop(data):
            text = " ".join(value.span.text.split())
            if _is_comprehension(script_code(text).tree):
                what = "a list" if isinstance(data, tuple) else "a mapping"
                yield Finding(
                    span=value.span,
                    message=f"`{text}` is {what} with a text for YAML, and no code",
                    arguments=(text,),
                    help=f"write it in quotes and backticks: {in_quotes(f'`{text}`')}",
                    effect="the text is used as it is: nothing computes the values",
                    related=calls(node, value.span),
                    node=path,
                    edits=(Edit(span=value.span, text=in_quotes(f"`{text}`")),),
                )


def _has_loop(data: tuple[Data, ...] | Struct) -> bool:
    """Whether a text in a list or mapping may have the loop of a comprehension."""
    parts = data if isinstance(data, tuple) else [part for _, part in data.entries]
    return any(isinstance(part, str) and " for " in part for part in parts)


def _is_comprehension(tree: ast.expr | None) -> bool:
    """Whether code is certainly a comprehension: `[look for cup in kitchen]` is prose."""
    match tree:
        case (
            ast.ListComp(elt=element, generators=loops) | ast.SetComp(elt=element, generators=loops)
        ):
            elements = [element]
        case ast.DictComp(key=key, value=element, generators=loops):
            elements = [key, element]
        case _:
            return False
    used = {node.id for part in elements for node in ast.walk(part) if isinstance(node, ast.Name)}
    targets = (node for loop in loops for node in ast.walk(loop.target))
    bound = {target.id for target in targets if isinstance(target, ast.Name)}
    return bool(used & bound) or any(isinstance(loop.iter, ast.Call) for loop in loops)


def _slips(text: str, compares: bool) -> list[Slip]:
    """The reasons why code cannot be an expression of a script; none if it can."""
    tree = script_code(text).tree
    if tree is None:
        return slips(text, compares=compares)
    if "yield" in text or "await" in text:
        for node in ast.walk(tree):
            if isinstance(node, ast.Yield | ast.YieldFrom | ast.Await):
                what = "`yield` and `await` are allowed only in functions of a module"
                return [Slip(*node_range(text, node), what)]
    return []


def _cures(code: Expression, found: list[Slip]) -> tuple[Edit, ...]:
    """The edits that correct the slips in code, if they are certain."""
    if corrected(code.text, found) is None:
        return ()
    places = [(place_in(code, slip.start, slip.end), slip.cure) for slip in found]
    return tuple(
        Edit(span=span, text=cure)
        for span, cure in places
        if span != code.span and cure is not None
    )


def _missing_code(leaf: Leaf, path: str) -> Iterator[Finding]:
    """Entries of `callbacks` that are not code, such as a number or a list."""
    for held in leaf.variables:
        if held.role not in ("callbacks", "conditions") and held.name != "callbacks":
            continue
        if not isinstance(held.value.data, Struct):
            continue
        for key, value in held.value.data.entries:
            if not isinstance(value, Expression):
                yield Finding(
                    span=place_of_part(held.value.span, (key,)),
                    message=f"the callback `{key}` of `{leaf.name}` is not a function",
                    arguments=(key,),
                    help=f"write a function, such as `{key}: 'lambda ud: {_example(leaf)}'`,"
                    " or the name of one",
                    effect="the state would fail when it calls it, so no program is generated",
                    node=path,
                )


def _example(leaf: Leaf) -> str:
    """The result of an example of a function: the first input key, or a number."""
    return f"ud.{leaf.inputs[0].name}" if leaf.inputs else "1"


@rule(
    "SM311",
    "impossible-operation",
    Severity.ERROR,
    effect="Python raises an exception there: the state fails, or the machine stops",
)
def impossible_operation(context: Context) -> Iterator[Finding]:
    """Code in the script contains an operation that the type of a value does not support.

    The code fails in every run that evaluates it, with the robot in the middle of its task: for
    example, it adds a number to text, or calls a function with too many arguments.

    Exactly: a warning if only some runs evaluate that part of the code. Values of the type `any` or
    of a type `T?` are not checked, except a key that begins as null and that no state sets, if a
    state sets another one with a word of its name, which nothing reads. An index is too large if a
    declaration fixes the length of the list, or if the list is an initial value and only built-in
    states whose code reads items of it can reach it: others can make it longer. The same holds for
    an entry that a mapping of the script lacks, which a class that was read can reach too. In the
    Python class of a state type, the types are those of its interface; an index, the fields of
    records (`pad["at"]`) and those of messages (`.x`, `.position`) are checked, and the keys of a
    dictionary in which it looks up a word that a variable can have. In code that runs for each item
    of a list, such as `[p["at"] for p in ud.pads]` or `key=lambda p: p["at"]`, every finding is a
    warning.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        userdata: {limb: left}
        states:
          - NEXT:
              template: CallbacksState
              input_keys: [limb]
              output_keys: [limb]
              callbacks: {limb: 'lambda ud: ud.limb + 1'}
              transitions: {succeeded: done}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        userdata: {limb: left}
        states:
          - NEXT:
              template: CallbacksState
              input_keys: [limb]
              output_keys: [limb]
              callbacks: {limb: 'lambda ud: ud.limb + "_2"'}
              transitions: {succeeded: done}
    """
    for site, fault in faults_of(context, "operation"):
        does = "fails" if fault.always else "can fail"
        severity = None if fault.always else Severity.WARNING
        finding = fault_finding(site, fault, f"{code_owner(site)} {does}: {fault.what}", severity)
        help = _number_in_quotes(site, fault)
        yield replace(finding, help=help) if help else finding
    yield from null_keys(context)
    yield from wrong_parts(context)
    yield from wrong_operations(context, "operation")
    yield from missing_choices(context)


@rule(
    "SM312",
    "constant-comparison",
    Severity.WARNING,
    effect="the comparison always has the same result, so it decides nothing",
)
def constant_comparison(context: Context) -> Iterator[Finding]:
    """Code in the script, or in a class, compares values that, by their types, can never be equal.

    Python reports no error: the condition is always false, or always true, and the machine takes a
    wrong transition.

    Wrong:
        name: sm
        template: Base
        outcomes: [shut, other]
        userdata: {gripper: {type: 'one_of[open, closed]', value: open}}
        states:
          - IS_SHUT:
              template: ConditionalOutcomeState
              input_keys: [gripper]
              outcomes: [shut]
              callbacks: {shut: 'lambda ud: ud.gripper == "shut"'}
              default_outcome: other
              transitions: {shut: shut, other: other}

    Right:
        name: sm
        template: Base
        outcomes: [shut, other]
        userdata: {gripper: {type: 'one_of[open, closed]', value: open}}
        states:
          - IS_SHUT:
              template: ConditionalOutcomeState
              input_keys: [gripper]
              outcomes: [shut]
              callbacks: {shut: 'lambda ud: ud.gripper == "closed"'}
              default_outcome: other
              transitions: {shut: shut, other: other}
    """
    for site, fault in faults_of(context, "comparison"):
        yield fault_finding(site, fault, f"in {code_owner(site)}, {fault.what}")
    yield from wrong_comparisons(context)


_NUMBER = re.compile(r"-?\d+(\.\d+)?")


def _number_in_quotes(site: ExpressionSite, fault: Fault) -> str | None:
    """The help for a number of the script in quotes, which is a text: `limit: '3'`."""
    for key in fault.keys:
        cell = site.cells.get(key)
        for alike in cell.flows.values() if cell is not None else ():
            for flow in alike:
                text = flow.value if flow.origin.how == "value" else None
                if isinstance(text, str) and _NUMBER.fullmatch(text):
                    line = flow.origin.span.line
                    return f"write `{key}: {text}` without quotes in line {line}"
    return None
