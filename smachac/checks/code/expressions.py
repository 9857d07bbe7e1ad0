"""Rules on the code in a script."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import replace

from smachac.analysis.context import Context
from smachac.analysis.expression_errors import Fault, FaultKind
from smachac.analysis.expression_sites import ExpressionSite
from smachac.analysis.units import conversion
from smachac.checks.classes.class_values import (
    missing_choices,
    wrong_comparisons,
    wrong_operations,
    wrong_parts,
)
from smachac.checks.edits import adding_outcome
from smachac.checks.help_text import calls, did_you_mean, in_quotes_for, other_place
from smachac.checks.rule import rule
from smachac.checks.types.type_origins import written
from smachac.checks.types.value_places import place_of_fault, place_of_part
from smachac.checks.userdata.null_keys import null_keys
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.negation import is_negation
from smachac.diagnostics.repair import Edit
from smachac.diagnostics.source import Word
from smachac.diagnostics.spelling import guesser, in_quotes, respelt
from smachac.diagnostics.wording import listed
from smachac.ir.code_places import node_range, place_in, python_tree
from smachac.ir.code_slips import Slip, corrected, slips
from smachac.ir.expressions import print_expression
from smachac.ir.leaf import functions, variable, variable_of
from smachac.ir.nodes import Data, Expression, Leaf, Node, Struct, is_number
from smachac.ir.traversal import expressions, outcome_names, values


@rule(
    "SM016",
    "bad-expression",
    Severity.ERROR,
    firm=True,
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
            if _is_comprehension(python_tree(text)):
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
    used = {each.id for part in elements for each in ast.walk(part) if isinstance(each, ast.Name)}
    targets = (each for loop in loops for each in ast.walk(loop.target))
    bound = {each.id for each in targets if isinstance(each, ast.Name)}
    return bool(used & bound) or any(isinstance(loop.iter, ast.Call) for loop in loops)


def _slips(text: str, compares: bool) -> list[Slip]:
    """The reasons why code cannot be an expression of a script; none if it can."""
    tree = python_tree(text)
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


def unknown_endings(path: str, leaf: Leaf) -> Iterator[Finding]:
    """The unknown outcomes in the conditions and steps of a leaf (SM102)."""
    outcomes = outcome_names(leaf) if leaf.variables and not leaf.open else []
    if not outcomes:
        return
    for word, what, effect in _endings(leaf):
        if word.text not in outcomes:
            meant = did_you_mean(guesser(outcomes)(word.text)) or _only_left(leaf, word.text)
            is_used = any(step.outcome == word.text for step in leaf.transitions)
            yield Finding(
                span=word.span,
                message=f"{what} `{word.text}`, which is not one of its outcomes",
                arguments=(word.text,),
                help=meant
                or f"add `{word.text}` to the `outcomes` of `{leaf.name}` and to its transitions,"
                f" or use one of its outcomes: {listed(outcomes)}",
                effect=effect,
                related=calls(leaf, word.span),
                node=path,
                repairs=adding_outcome(leaf, word.text) if is_used else (),
            )


def _only_left(leaf: Leaf, word: str) -> str | None:
    """The help that names the only outcome of a leaf to which no condition leads, if one condition
    leads to an unknown one."""
    conditions = functions(leaf, "conditions") or {}
    default = variable(leaf, "default_outcome")
    names = outcome_names(leaf)
    left = [name for name in names if name not in {*conditions, default, leaf.catches}]
    unknown = [name for name in conditions if name not in names]
    if unknown != [word] or len(left) != 1 or is_negation(word, left[0]):
        return None
    return f"write `{left[0]}` in place of `{word}`: no condition leads to `{left[0]}`"


def _endings(leaf: Leaf) -> Iterator[tuple[Word, str, str]]:
    """The outcomes in the conditions and steps of a leaf, each with the start of its message, and
    with the effect of an unknown one."""
    conditions = variable_of(leaf, "conditions")
    for outcome, site in (functions(leaf, "conditions") or {}).items():
        span = site.span
        if conditions is not None and outcome not in outcome_names(leaf):
            place = place_of_part(conditions.value.span, (outcome,), key=True)
            span = place if place != conditions.value.span else span
        what = f"a condition of `{leaf.name}` leads to"
        yield Word(outcome, span), what, f"`{leaf.name}` never uses the condition"
    held = variable_of(leaf, "steps")
    if held is None or not isinstance(held.value.data, tuple):
        return
    for at, step in enumerate(held.value.data):
        end = dict(step.entries).get("outcome") if isinstance(step, Struct) else None
        if isinstance(end, str) and end and end not in outcome_names(leaf):
            place = place_of_part(held.value.span, (at, "outcome"))
            what = f"a step of `{leaf.name}` ends with"
            effect = (
                "SMACH raises InvalidTransitionError for an undeclared outcome: the machine stops"
            )
            yield Word(end, place), what, effect


MOST_SOURCES = 3
"""Limit on the origins of values that a finding shows."""


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
    for site, fault in _faults(context, "operation"):
        does = "fails" if fault.always else "can fail"
        severity = None if fault.always else Severity.WARNING
        finding = _finding(site, fault, f"{_owner(site)} {does}: {fault.what}", severity)
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
    for site, fault in _faults(context, "comparison"):
        yield _finding(site, fault, f"in {_owner(site)}, {fault.what}")
    yield from wrong_comparisons(context)


def mixed_units(context: Context) -> Iterator[Finding]:
    """The operations on numbers with different units (SM504)."""
    for site, fault in _faults(context, "unit"):
        finding = _finding(site, fault, f"in {_owner(site)}, {fault.what}")
        value = _in_other_unit(site, fault)
        yield replace(finding, help=f"{finding.help}, {value}") if value else finding


def doubtful_comparisons(context: Context) -> Iterator[Finding]:
    """The comparisons of values in radians with numbers that seem to be in degrees (SM522)."""
    for site, fault in _faults(context, "doubt"):
        yield _finding(site, fault, f"in {_owner(site)}, {fault.what}")


_NUMBER = re.compile(r"-?\d+(\.\d+)?")


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
        for each in node.userdata:
            if each.key == name and is_number(each.value.data) and each.type.args == (given,):
                number = f"{each.value.data * factor:.6g}"
                new = f"{{type: {each.type.name}<{wanted}>, value: {number}}}"
                return f"or write `{name}: {new}` in the `userdata` of `{node.name}`"
    return ""


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


def _faults(context: Context, kind: FaultKind) -> Iterator[tuple[ExpressionSite, Fault]]:
    return ((site, fault) for site, fault in context.expression_faults if fault.kind == kind)


def _owner(site: ExpressionSite) -> str:
    return f"the code of `{site.node.name}`"


def _finding(
    site: ExpressionSite, fault: Fault, message: str, severity: Severity | None = None
) -> Finding:
    guess = did_you_mean(guesser(fault.choices)(fault.word)) if fault.choices else None
    choices = f"use one of {', '.join(f'`{each}`' for each in fault.choices)}"
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
        edits=respelt(Word(fault.word, place), guesser(fault.choices).sure(fault.word)),
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
