"""Rules over the code in a script."""

from __future__ import annotations

import ast
import warnings
from collections.abc import Iterator

from smachac.checks.hints import calls, did_you_mean, guesser
from smachac.checks.once import states
from smachac.diagnostics import Finding, Severity, rule
from smachac.ir.accesses import callbacks
from smachac.ir.nodes import Expression, Leaf, Machine, Struct
from smachac.ir.walk import expressions, outcome_names
from smachac.problems import listed
from smachac.source import Word

MAX_LEVELS = 500
"""The most levels of an expression; Python compiles no more than about 1,000 frames deep."""


@rule("SM016", "bad-expression", Severity.ERROR, firm=True)
def bad_expression(machine: Machine) -> Iterator[Finding]:
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
    for path, node in states(machine):
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
        for outcome, code in (callbacks(leaf) or {}).items():
            yield Word(outcome, code.span), "a condition"
    elif leaf.type == "ScriptedState":
        for held in leaf.variables:
            steps = held.value.data if held.name == "steps" else ()
            for step in steps if isinstance(steps, tuple) else ():
                told = dict(step.entries).get("outcome") if isinstance(step, Struct) else None
                if isinstance(told, str) and told:
                    yield Word(told, held.value.span), "a step"
