"""Rules over the code in a script."""

from __future__ import annotations

import ast
import warnings
from collections.abc import Iterator

from smachac.analysis.accesses import callbacks
from smachac.analysis.context import Context
from smachac.analysis.expression_errors import Fault, FaultKind
from smachac.analysis.expression_sites import ExpressionSite
from smachac.checks.messages import calls, did_you_mean, other_place
from smachac.checks.rule import rule
from smachac.checks.types import written
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.source import Word
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import listed
from smachac.ir.nodes import Expression, Leaf, Struct
from smachac.ir.traversal import expressions, outcome_names

MAX_LEVELS = 500
"""The most levels of an expression; Python compiles no more than about 1,000 frames deep."""


@rule("SM016", "bad-expression", Severity.ERROR, firm=True)
def bad_expression(context: Context) -> Iterator[Finding]:
    """Code of the script is no expression, or something else stands where code is due.

    The generated program would not even start, or would fail at the first visit of the state,
    with the robot in the middle of its task.

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
    for path, node in context.states:
        for expression in expressions(node):
            fault = _fault(expression.text)
            if fault:
                yield Finding(
                    span=expression.span,
                    message=f"`{expression.text}` is no expression: {fault}",
                    help="write a value, or a function such as `lambda ud: ud.n + 1`",
                    node=path,
                )
        if isinstance(node, Leaf):
            yield from _missing_code(node, path)


def _fault(text: str) -> str:
    """What Python says against an expression; nothing when it is one."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SyntaxWarning)
            tree = ast.parse(text, mode="eval")
    except SyntaxError as error:
        return (error.msg or "invalid syntax").lower()
    except (ValueError, RecursionError, MemoryError):
        return "it is too deep, or holds a character that code may not have"
    # Every level takes a character or more.
    if len(text) > MAX_LEVELS and _is_deeper(tree):
        return f"it is nested deeper than {MAX_LEVELS} levels"
    return ""


def _is_deeper(tree: ast.AST) -> bool:
    level = [tree]
    for _ in range(MAX_LEVELS):
        level = [child for node in level for child in ast.iter_child_nodes(node)]
        if not level:
            return False
    return True


def _missing_code(leaf: Leaf, path: str) -> Iterator[Finding]:
    """Entries of `callbacks` that are no code: a number, a list, nothing."""
    for variable in leaf.variables:
        if variable.name != "callbacks" or not isinstance(variable.value.data, Struct):
            continue
        for key, value in variable.value.data.entries:
            if not isinstance(value, Expression):
                yield Finding(
                    span=variable.value.span,
                    message=f"the callback `{key}` of `{leaf.name}` is no function",
                    help=f"write it as `{key}: 'lambda ud: ud.n + 1'`, or name a function",
                    node=path,
                )


def unknown_endings(path: str, leaf: Leaf) -> Iterator[Finding]:
    """What the script makes a leaf end with that is none of its outcomes; SM102 says it."""
    outcomes = outcome_names(leaf)
    guess = guesser(outcomes)
    known = f"its outcomes are {listed(outcomes)}"
    for word, what in _endings(leaf) if outcomes and not leaf.open else ():
        if word.text not in outcomes:
            yield Finding(
                span=word.span,
                message=f"{what} of `{leaf.name}` is for `{word.text}`,"
                " which is none of its outcomes",
                help=did_you_mean(guess(word.text)) or known,
                related=calls(leaf, word.span),
                node=path,
            )


def _endings(leaf: Leaf) -> Iterator[tuple[Word, str]]:
    """The outcomes that conditions and steps of a leaf speak of."""
    if leaf.type == "ConditionalOutcomeState":
        for outcome, site in (callbacks(leaf) or {}).items():
            yield Word(outcome, site.span), "a condition"
    elif leaf.type == "ScriptedState":
        for held in leaf.variables:
            steps = held.value.data if held.name == "steps" else ()
            for step in steps if isinstance(steps, tuple) else ():
                told = dict(step.entries).get("outcome") if isinstance(step, Struct) else None
                if isinstance(told, str) and told:
                    yield Word(told, held.value.span), "a step"


MOST_SOURCES = 3
"""So many of the places a value comes from one finding shows."""


@rule("SM311", "impossible-operation", Severity.ERROR)
def impossible_operation(context: Context) -> Iterator[Finding]:
    """Code of the script does with a value what its type cannot do.

    It fails in every run that comes to it, with the robot in the middle of its task: a number is
    added to text, a word is asked for an item, a function gets too many arguments. A warning where
    only some runs evaluate that part of the code. Of `any`, and of a `T?`, nothing is said.

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
        yield _finding(site, fault, f"{_owner(site)} {does}: {fault.what}", severity)


@rule("SM312", "constant-comparison", Severity.WARNING)
def constant_comparison(context: Context) -> Iterator[Finding]:
    """Code of the script compares values of which it is known that they are never equal.

    Python does not complain of it: the condition is never true, or always, and the machine goes on
    the wrong way.

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


def mixed_units(context: Context) -> Iterator[Finding]:
    """The operations over numbers of different units; SM504 says them."""
    for site, fault in _faults(context, "unit"):
        yield _finding(site, fault, f"in {_owner(site)}, {fault.what}")


def _faults(context: Context, kind: FaultKind) -> Iterator[tuple[ExpressionSite, Fault]]:
    return ((site, fault) for site, fault in context.expression_faults if fault.kind == kind)


def _owner(site: ExpressionSite) -> str:
    return f"the {'code' if isinstance(site.node, Leaf) else 'data'} of `{site.node.name}`"


def _finding(
    site: ExpressionSite, fault: Fault, message: str, severity: Severity | None = None
) -> Finding:
    guess = did_you_mean(guesser(fault.choices)(fault.word)) if fault.choices else None
    choices = f"it is one of {', '.join(f'`{each}`' for each in fault.choices)}"
    span = site.expression.span
    return Finding(
        span=span,
        message=message,
        help=guess or (choices if fault.choices else fault.help),
        related=(*_sources(site, fault), *calls(site.node, span)),
        node=site.path,
        severity=severity,
    )


def _sources(site: ExpressionSite, fault: Fault) -> Iterator[Related]:
    """Where the types of the keys come from."""
    shown = {site.expression.span}
    for key in fault.keys:
        cell = site.cells.get(key)
        for alike in cell.flows.values() if cell is not None else ():
            origin = alike[0].origin
            if not alike[0].judged and origin.span not in shown and len(shown) <= MOST_SOURCES:
                shown.add(origin.span)
                yield from other_place(origin.span, written(origin))
